"""What a prompt is made of: facts in plain numbers and words, which the templates turn into sentences."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class VehicleView:
    """A vehicle beside or on the lane of the CAV.

    Attributes:
        driver: ``CAV``, ``human`` or ``unknown driver``.
        gap: Free distance along the road [m].
        speed: Speed [m/s].
    """

    id: str
    driver: str
    gap: float
    speed: float


@dataclass(frozen=True, slots=True)
class LaneView:
    """A lane that runs the CAV's way.

    Attributes:
        name: ``ego lane``, ``left lane`` or ``right lane``.
        leading: The next vehicle ahead there, or None.
        rear: The next vehicle behind there, or None.
    """

    name: str
    leading: VehicleView | None
    rear: VehicleView | None


@dataclass(frozen=True, slots=True)
class OtherView:
    """A vehicle of which the CAV does not know the lane.

    Attributes:
        driver: ``CAV``, ``human`` or ``unknown driver``.
        ahead: Distance ahead, negative behind [m].
        right: Distance to the right, negative to the left [m].
        speed: Speed [m/s].
    """

    id: str
    driver: str
    ahead: float
    right: float
    speed: float


@dataclass(frozen=True, slots=True)
class ConflictView:
    """Everything that one other vehicle may get in the CAV's way; of several zones the most urgent one.

    Attributes:
        driver: ``CAV``, ``human`` or ``unknown driver``.
        speed: Its speed [m/s].
        mine: The CAV's distance to the zone [m].
        its: The other's distance to the zone [m].
        my_ttcp: The CAV's time to the conflict zone [s].
        its_ttcp: The other's time to the conflict zone [s].
        dttcp: Difference of the two [s].
        free: When the CAV's way through all of them is expected to be free [s]; 0 if the CAV goes first.
    """

    id: str
    driver: str
    lane: str
    speed: float
    relation: str
    mine: float
    its: float
    my_ttcp: float
    its_ttcp: float
    dttcp: float
    severity: str
    zones: int
    free: float


@dataclass(frozen=True, slots=True)
class IntentView:
    """What another CAV means to do.

    Attributes:
        target_speed: The speed that it aims at [m/s].
    """

    id: str
    route: str
    target_speed: float


@dataclass(frozen=True, slots=True)
class OrderView:
    """One pair of the passing order."""

    id: str
    reason: str


@dataclass(frozen=True, slots=True)
class ActionView:
    """Actions of which the safety check says the same.

    Attributes:
        progress: How far the CAV gets within 10 s if it then keeps the order [m]; None if it cannot keep it.
        arrivals: Earliest arrival at the zones of each conflict, in the order of the conflicts [s].
    """

    names: tuple[str, ...]
    safe: bool
    reasons: tuple[str, ...]
    progress: float | None
    arrivals: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class EntrantView:
    """A CAV that is to be ordered.

    Attributes:
        speed: Speed [m/s].
        target_speed: The speed that it aims at [m/s].
        distance: Distance to its first conflict zone [m].
        earliest: Earliest time at which it can be there [s].
        blocked: Intervals in which human drivers may be in its way there [s].
    """

    id: str
    speed: float
    route: str
    turns: bool
    target_speed: float
    distance: float
    earliest: float
    can_stop: bool
    behind: str
    blocked: tuple[tuple[float, float], ...]


@dataclass(frozen=True, slots=True)
class PairView:
    """Two CAVs of which the order is open.

    Attributes:
        name: ``p1``, ``p2``, ..., most urgent first.
        distances: Distance of each to the zone [m].
        ttcp: Time of each to the conflict zone [s].
        dttcp: Difference of the two [s].
    """

    name: str
    one: str
    other: str
    relation: str
    distances: tuple[float, float]
    ttcp: tuple[float, float]
    dttcp: float
    severity: str
    agreed: str


@dataclass(frozen=True, slots=True)
class FixedView:
    """Two CAVs of which the order cannot be changed any more."""

    first: str
    second: str


@dataclass(frozen=True, slots=True)
class WayView:
    """One way that a vehicle may take, where it meets that of the CAV.

    Attributes:
        mine: The CAV's distance to the place where they meet [m].
        its: The other's distance to it [m].
        my_ttcp: The CAV's time to it at its present speed [s].
        its_ttcp: The other's time to it [s].
        dttcp: Difference of the two [s].
    """

    relation: str
    mine: float
    its: float
    my_ttcp: float
    its_ttcp: float
    dttcp: float
    severity: str


@dataclass(frozen=True, slots=True)
class SeenView:
    """A vehicle as the CAV sees it; who drives it and where it goes is not known.

    Attributes:
        where: Where it is seen from the CAV, for instance ``ahead left``.
        distance: Distance of the centres [m].
        speed: Its speed [m/s].
        standing: How long it has been standing [s].
    """

    id: str
    where: str
    distance: float
    speed: float
    standing: float
    ways: tuple[WayView, ...]
    elsewhere: int


@dataclass(frozen=True, slots=True)
class MeaningView:
    """An action that the road allows.

    Attributes:
        target: Target speed after it [m/s]; None for a lane change.
    """

    name: str
    target: float | None
