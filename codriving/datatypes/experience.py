"""What a CAV remembers: a scene, a conflict, an action and what became of it (paper Section III-D)."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum

from codriving.datatypes.world import Action


class Verdict(StrEnum):
    """What an action did to the conflict, judged by what came of it."""

    INTENSIFIED = "intensified"
    EASED = "eased"
    TOO_CAUTIOUS = "too cautious"
    NEUTRAL = "neutral"


@dataclass(frozen=True, slots=True)
class Description:
    """A situation as it is stored and searched for: in words, and the numbers and kinds that the words are made of.

    Nothing in it names a vehicle, a place or a route, so that situations of the same kind read alike.
    """

    scene: str
    conflict: str
    order: str
    numbers: Mapping[str, float]
    kinds: Mapping[str, str]  # Words of a fixed set by name, for instance ``relation``

    @property
    def text(self) -> str:
        """Scene, conflict and order as one text."""
        return " ".join(part for part in (self.scene, self.conflict, self.order) if part)


@dataclass(frozen=True, slots=True)
class Effect:
    """What came of one action, in numbers."""

    # Difference of the times to the conflict point when the CAV decided [s]; None without a conflict.
    dttcp_before: float | None = None
    dttcp_after: float | None = None  # The same after the step [s]; None if the conflict was over or there was none
    # By how much the action itself widened (positive) or narrowed that difference, against keeping the speed [s].
    own_change: float = 0.0
    own_braking: float = 0.0  # Hardest mean deceleration of the CAV over one of the next decision steps [m/s2]
    # Hardest mean deceleration of another vehicle in its way over this or the next step [m/s2].
    forced_braking: float = 0.0
    # Time until the CAV was in a collision [s]; None if it was in none within the horizon.
    collision: float | None = None
    to_blame: bool = False
    needless: bool = False


@dataclass(frozen=True, slots=True)
class Interaction:
    """One episode that was learnt from."""

    scenario: str
    seed: int
    method: str
    variant: str
    reasoner: str


@dataclass(frozen=True, slots=True)
class Experience:
    """One decision worth remembering."""

    description: Description
    action: Action
    verdict: Verdict
    effect: Effect
    lesson: str
    step: int
    ego: str


@dataclass(frozen=True, slots=True)
class Memory:
    """An experience that was found for a situation."""

    id: int
    text: str
    action: Action
    verdict: Verdict
    similarity: float
    count: int
