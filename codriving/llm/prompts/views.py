"""What a prompt is made of: facts in plain numbers and words, which the templates turn into sentences.

Distances are in metres, times in seconds, speeds in m/s; ``driver`` is ``CAV``, ``human`` or ``unknown driver``.
"""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class VehicleView:
    """A vehicle beside or on the lane of the CAV; ``gap`` is the free distance along the road."""

    id: str
    driver: str
    gap: float
    speed: float


@dataclass(frozen=True, slots=True)
class LaneView:
    """A lane that runs the CAV's way, with the next vehicles ahead and behind there."""

    name: str  # ``ego lane``, ``left lane`` or ``right lane``
    leading: VehicleView | None
    rear: VehicleView | None


@dataclass(frozen=True, slots=True)
class OtherView:
    """A vehicle of which the CAV does not know the lane; ``ahead`` is negative behind, ``right`` to the left."""

    id: str
    driver: str
    ahead: float
    right: float
    speed: float


@dataclass(frozen=True, slots=True)
class WayView:
    """One way that a vehicle may take, and where it meets that of the CAV."""

    relation: str
    mine: float  # The CAV's distance to the zone
    its: float  # The other's distance to the zone
    my_ttcp: float
    its_ttcp: float
    dttcp: float
    severity: str


@dataclass(frozen=True, slots=True)
class ConflictView(WayView):
    """Everything that one other vehicle may get in the CAV's way; of several zones the most urgent one."""

    id: str
    driver: str
    lane: str
    speed: float
    zones: int
    free: float  # When the CAV's way through all of them is expected to be free; 0 if the CAV goes first
    certain: bool = True  # Whether it is known which way the other one takes; if not, progress is a mean


@dataclass(frozen=True, slots=True)
class IntentView:
    """What another CAV means to do."""

    id: str
    route: str
    target_speed: float


@dataclass(frozen=True, slots=True)
class OrderView:
    """One pair of the passing order."""

    id: str
    reason: str
    told: str = ""  # The reason as it holds later, too, and of several the one that held


@dataclass(frozen=True, slots=True)
class ActionView:
    """Actions of which the safety check says the same."""

    names: tuple[str, ...]
    safe: bool
    reasons: tuple[str, ...]
    progress: float | None  # How far the CAV gets within 10 s if it then keeps the order; None if it cannot keep it
    arrivals: tuple[float, ...]  # Earliest arrival at the zones of each conflict, in the order of the conflicts
    target: float | None = None  # The target speed that they set; None for a lane change


@dataclass(frozen=True, slots=True)
class EntrantView:
    """A CAV that is to be ordered."""

    id: str
    speed: float
    route: str
    turns: bool
    target_speed: float
    distance: float  # Distance to its first conflict zone; to that of a pair see there
    earliest: float  # Earliest time at which it can be there
    can_stop: bool
    behind: str
    blocked: tuple[tuple[float, float], ...]  # Intervals in which human drivers may be in its way there


@dataclass(frozen=True, slots=True)
class PairView:
    """Two CAVs of which the order is open; ``name`` is ``p1``, ``p2``, ..., most urgent first, or made of theirs."""

    name: str
    one: str
    other: str
    relation: str
    distances: tuple[float, float]
    ttcp: tuple[float, float]
    dttcp: float
    severity: str
    agreed: str
    earliest: tuple[float, float]  # Earliest times at which they can be at the zone
    can_stop: tuple[bool, bool]  # Whether they can still stop before it
    waits: tuple[float, float]  # How long the other one waits if the one goes first, and the other way round


@dataclass(frozen=True, slots=True)
class FixedView:
    """Two CAVs of which the order cannot be changed any more."""

    first: str
    second: str


@dataclass(frozen=True, slots=True)
class SeenView:
    """A vehicle as the CAV sees it; who drives it and where it goes is not known."""

    id: str
    where: str  # Where it is seen from the CAV, for instance ``ahead left``
    distance: float  # Distance of the centres
    speed: float
    standing: float  # How long it has been standing
    ways: tuple[WayView, ...]
    elsewhere: int


@dataclass(frozen=True, slots=True)
class MeaningView:
    """An action that the road allows, and the target speed after it; None for a lane change."""

    name: str
    target: float | None
