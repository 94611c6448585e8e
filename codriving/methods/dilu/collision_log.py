"""Reflect: which decisions of an episode DiLu remembers, and what is noted of them."""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from codriving.datatypes import (
    Action,
    Collision,
    Decision,
    Effect,
    Ending,
    Experience,
    Outcome,
    Situation,
    Verdict,
    WorldState,
)
from codriving.llm import one_line, seen_names
from codriving.memory import describe
from codriving.methods.experience_log import ExperienceLog, LoggedDecision

EVERY = 5  # Of a drive that ends well every fifth decision is kept

LONGEST = 100  # Characters of a mistake, and of a lesson: a memory is told in a few lines


@dataclass(frozen=True, slots=True)
class Mistake:
    """The last decision before a collision that was not to slow down."""

    situation: Situation
    decision: Decision
    step: int
    other: str  # The vehicle of the collision
    later: float  # How much later that was [s]
    struck: bool  # Whether the CAV ran into the other vehicle, rather than the other way round


@dataclass(frozen=True, slots=True)
class Correction:
    """What a mistake was, and what would have been right."""

    action: Action
    mistake: str
    lesson: str


class CollisionLog(ExperienceLog):
    """DiLu's: of a success every fifth decision is kept, of a collision what led to it, of other endings nothing."""

    def __init__(self, correct: Callable[[Sequence[Mistake]], list[Correction]]) -> None:
        super().__init__()
        self._correct = correct

    def experiences(self, world: WorldState, outcome: Outcome) -> list[Experience]:
        if outcome.ending is Ending.SUCCESS:
            return [_good(one) for logged in self.decisions.values() for one in logged[EVERY - 1 :: EVERY]]
        mistakes = self.mistakes(outcome.collision) if outcome.collision is not None else []
        corrections = self._correct(mistakes) if mistakes else []
        return [_bad(mistake, correction) for mistake, correction in zip(mistakes, corrections, strict=True)]

    def mistakes(self, collision: Collision) -> list[Mistake]:
        """Return for each CAV in a collision the last decision before it that was not to slow down."""
        found = []
        for ego, other in ((collision.striker, collision.struck), (collision.struck, collision.striker)):
            before = [one for one in self.decisions.get(ego, []) if one.time <= collision.time]
            last = next((one for one in reversed(before) if one.decision.action is not Action.SLOWER), None)
            if last is not None:
                later, strikes = collision.time - last.time, ego == collision.striker
                found.append(Mistake(last.situation, last.decision, last.step, other, later, strikes))
        return found


def _good(logged: LoggedDecision) -> Experience:
    reason = seen_names(logged.situation.scene).sentence(logged.decision.reason)
    lesson = f"No mistake, the drive ended well. Why: {_nameless(reason)}"
    return _experience(logged.situation, logged.decision, logged.step, Verdict.EASED, Effect(), lesson)


def _bad(mistake: Mistake, correction: Correction) -> Experience:
    wrong, right = _nameless(correction.mistake), _nameless(correction.lesson)
    lesson = f"Mistake: {wrong} Lesson: {right} Right: {correction.action}."
    effect = Effect(collision=round(mistake.later, 3))
    return _experience(mistake.situation, mistake.decision, mistake.step, Verdict.INTENSIFIED, effect, lesson)


def _nameless(text: str) -> str:
    """Put a sentence on one line; what vehicles were called means nothing in another drive."""
    return one_line(re.sub(r"\bV\d+\b", "another vehicle", text), LONGEST)


def _experience(
    situation: Situation, decision: Decision, step: int, verdict: Verdict, effect: Effect, lesson: str
) -> Experience:
    return Experience(describe(situation), decision.action, verdict, effect, lesson, step, decision.ego)
