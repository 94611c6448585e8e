"""What would have been right: the port through which mistakes are corrected, and the rule behind it."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from codriving.datatypes.action import Action
from codriving.datatypes.situation import Decision
from codriving.methods.dilu.told import Told
from codriving.reasoning.safety.safety_input import SIDES


@dataclass(frozen=True, slots=True)
class Mistake:
    """The last decision before a collision that was not to slow down.

    Attributes:
        later: How much later that was [s].
    """

    told: Told
    decision: Decision
    step: int
    other: str
    later: float
    struck: bool


@dataclass(frozen=True, slots=True)
class Correction:
    """What a mistake was, and what would have been right."""

    action: Action
    mistake: str
    lesson: str


class Reflector(Protocol):
    """Corrects all mistakes of an episode in one call."""

    def correct(self, mistakes: Sequence[Mistake]) -> list[Correction]:
        """Return one correction a mistake, in the same order."""
        ...


class RuleReflector:
    """Whoever collided should have slowed down; whoever changed lanes should have stayed."""

    def correct(self, mistakes: Sequence[Mistake]) -> list[Correction]:
        """Return one correction a mistake, in the same order."""
        return [correct_one(mistake) for mistake in mistakes]


def correct_one(mistake: Mistake) -> Correction:
    """Correct one mistake by rule."""
    action = mistake.decision.action
    how = "you ran into another vehicle" if mistake.struck else "another vehicle ran into you"
    wrong = f"{action}, and {mistake.later:.1f} s later {how}."
    if action in SIDES:
        return Correction(Action.IDLE, wrong, "Stay on the lane in a situation like this.")
    return Correction(Action.SLOWER, wrong, "Slow down in time in a situation like this.")
