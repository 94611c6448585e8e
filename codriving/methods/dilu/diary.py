"""Reflect: which moments of an episode are worth remembering, and what is noted of them."""

import re
from collections.abc import Sequence
from dataclasses import dataclass

from codriving.datatypes.action import Action
from codriving.datatypes.experience import Effect, Experience, Verdict
from codriving.datatypes.outcome import Collision, Ending, Outcome
from codriving.datatypes.situation import Decision
from codriving.llm.prompts.free_text import one_line, seen_names
from codriving.memory.describe import describe
from codriving.methods.dilu.reflection import Correction, Mistake, Reflector
from codriving.methods.dilu.told import Told

EVERY = 5
"""Of a drive that ends well every fifth decision is kept."""

LONGEST = 100
"""Characters of a mistake, and of a lesson: a memory is told in a few lines."""


@dataclass(frozen=True, slots=True)
class Frame:
    """One decision of one CAV.

    Attributes:
        time: Simulated time [s].
    """

    time: float
    step: int
    told: Told
    decision: Decision


class Diary:
    """What every CAV was told and decided in one episode."""

    def __init__(self) -> None:
        self._frames: dict[str, list[Frame]] = {}

    def note(self, time: float, step: int, told: Sequence[Told], decisions: Sequence[Decision]) -> None:
        """Note the decisions of one moment.

        Args:
            time: Simulated time [s].
        """
        for one, decision in zip(told, decisions, strict=True):
            self._frames.setdefault(decision.ego, []).append(Frame(time, step, one, decision))

    def conclude(self, outcome: Outcome, reflector: Reflector) -> list[Experience]:
        """Return what is worth keeping: of a success every fifth decision, of a collision what led to it.

        Returns:
            Experiences by step and id of the CAV; none of an episode that ended otherwise.
        """
        if outcome.ending is Ending.SUCCESS:
            found = [_kept(frame) for frames in self._frames.values() for frame in frames[EVERY - 1 :: EVERY]]
        elif outcome.collision is not None:
            mistakes = self.mistakes(outcome.collision)
            corrections = reflector.correct(mistakes) if mistakes else []
            found = [_corrected(m, c) for m, c in zip(mistakes, corrections, strict=True)]
        else:
            found = []
        return sorted(found, key=lambda e: (e.step, e.ego))

    def mistakes(self, collision: Collision) -> list[Mistake]:
        """Return for each CAV in a collision the last decision before it that was not to slow down."""
        found = []
        for ego, other in ((collision.striker, collision.struck), (collision.struck, collision.striker)):
            before = [f for f in self._frames.get(ego, []) if f.time <= collision.time]
            frame = next((f for f in reversed(before) if f.decision.action is not Action.SLOWER), None)
            if frame is not None:
                later = collision.time - frame.time
                found.append(Mistake(frame.told, frame.decision, frame.step, other, later, ego == collision.striker))
        return found


def _kept(frame: Frame) -> Experience:
    reason = seen_names(frame.told.situation.scene).sentence(frame.decision.reason)
    lesson = f"No mistake, the drive ended well. Why: {_nameless(reason)}"
    return _experience(frame.told, frame.decision, frame.step, Verdict.EASED, Effect(), lesson)


def _corrected(mistake: Mistake, correction: Correction) -> Experience:
    parts = (_nameless(correction.mistake), _nameless(correction.lesson), str(correction.action))
    lesson = "Mistake: {} Lesson: {} Right: {}.".format(*parts)
    effect = Effect(collision=round(mistake.later, 3))
    return _experience(mistake.told, mistake.decision, mistake.step, Verdict.INTENSIFIED, effect, lesson)


def _nameless(text: str) -> str:
    """Put a sentence on one line; what vehicles were called means nothing in another drive."""
    return one_line(re.sub(r"\bV\d+\b", "another vehicle", text), LONGEST)


def _experience(told: Told, decision: Decision, step: int, verdict: Verdict, effect: Effect, lesson: str) -> Experience:
    return Experience(describe(told.situation), decision.action, verdict, effect, lesson, step, decision.ego)
