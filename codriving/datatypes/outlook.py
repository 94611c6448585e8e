"""What a language model is told of a situation beyond what the rules compute with: facts, from the same moment."""

from collections.abc import Mapping
from dataclasses import dataclass

from codriving.datatypes.world import Action


@dataclass(frozen=True, slots=True)
class ActionOutlook:
    """What follows from one action if the CAV then keeps the speed that it sets."""

    action: Action
    arrivals: tuple[float, ...]  # When it is at each conflict zone [s]; inf if never
    stops: tuple[bool, ...]  # Whether it can still stop before each conflict zone one decision later
    follower: str  # The vehicle behind on the lane that it then drives on; empty if there is none
    braking: float  # How hard that one would have to brake [m/s2]


@dataclass(frozen=True, slots=True)
class ExpectedPassage:
    """When the other vehicle of a conflict is expected to enter the zone, and to have left it [s]."""

    enters: float
    leaves: float


@dataclass(frozen=True, slots=True)
class HumanOutlook:
    """What is known of a human driver who may get in the way of the CAV."""

    id: str
    speed: float  # [m/s]
    speed_before: float | None  # Its speed a second ago [m/s]; None if it was not known then
    acceleration: float | None  # [m/s2]
    standing: float  # How long it has been standing [s]
    turns: tuple[str, ...]  # What it may do at the junction, one entry a way
    first_by_rule: str  # Whom the rules of the road let go first: ``you``, ``it``, or empty where they say nothing
    gives_way: str  # Why it is expected to let the CAV pass first; empty if it is not
    braking: float  # How hard it would have to brake to stop before the zone [m/s2]; inf if it cannot
    behind: str  # The vehicle that it follows; empty if there is none
    gap: float  # Free distance to that one [m]


@dataclass(frozen=True, slots=True)
class Outlook:
    """All of that for one CAV."""

    actions: tuple[ActionOutlook, ...]
    passages: tuple[ExpectedPassage, ...]  # One a conflict
    humans: tuple[HumanOutlook, ...]
    norms: tuple[str, ...]  # Rules of the road that apply here and now


@dataclass(frozen=True, slots=True)
class PastDecision:
    """The last decision of a CAV that was asked for, and what has changed since."""

    action: Action
    reason: str
    plan: str  # What it meant to do next; empty if it did not say
    ago: int  # Decisions since
    changes: tuple[str, ...]
    speeds: Mapping[str, float]  # Speeds of the vehicles in conflict then, by id [m/s]
