"""Who meets whom, where and how badly (paper Section III-C, Eq. 3), and who goes first, and why."""

from collections.abc import Mapping, Set
from dataclasses import dataclass, field
from enum import StrEnum
from typing import NoReturn


class Relation(StrEnum):
    """How two routes meet."""

    CROSSING = "crossing"
    CONVERGING = "converging"
    DIVERGING = "diverging"
    FOLLOWING = "following"
    WEAVING = "weaving"


class Severity(StrEnum):
    """The paper's four bands of the time difference to the conflict point."""

    SERIOUS = "serious danger"
    GENERAL = "general danger"
    SLIGHT = "slight danger"
    NONE = "no danger"


@dataclass(frozen=True, slots=True)
class Conflict:
    """Two vehicles whose ways ahead share a zone, seen from one of them."""

    ego: str
    other: str
    relation: Relation
    routes: tuple[str, str]
    zone: int
    places: tuple[float, float]  # Arc length of each along its route [m]
    distances: tuple[float, float]  # Distance of each to the zone [m]; 0 inside it
    exits: tuple[float, float]  # Distance of each to the end of the zone [m]
    ttcp: tuple[float, float]  # Time of each to the conflict zone at its present speed [s]
    dttcp: float  # Difference of the two times [s]
    severity: Severity  # The paper's band of ``dttcp``
    certain: bool


@dataclass(frozen=True, slots=True)
class Precedence:
    """One vehicle passes a conflict zone before another."""

    first: str
    second: str
    reason: str


@dataclass(frozen=True, slots=True)
class PassingOrder:
    """The answer of a coordinator: an order without cycles."""

    sequence: tuple[str, ...]
    precedences: tuple[Precedence, ...]
    binding: bool = False

    def first_of(self, one: str, other: str) -> str | None:
        """Return which of two vehicles goes first, or None if they were not asked about."""
        for p in self.precedences:
            if (p.first == one and p.second == other) or (p.first == other and p.second == one):
                return p.first
        return None


Pair = tuple[str, str]  # Two vehicles, the first of which passes first


@dataclass(slots=True)
class ApproachingVehicle:
    """What an order has to know of one CAV that still has a conflict ahead."""

    id: str
    reference: float  # Arc length of its first conflict zone [m]
    eta: float  # Earliest time at which it can be there [s]; negative if it is past it
    committed: bool = False
    turning: bool = False
    leader: str | None = None
    # Intervals in which it must not pass the reference point, because of human drivers [s].
    windows: list[tuple[float, float]] = field(default_factory=list)
    lane: str = ""
    stream: str = ""
    distance: float = 0.0  # Distance to the reference point [m]; 0 past it
    crossing: float = 0.0  # Time from the reference point until it has left its last conflict zone, at top speed [s]
    remaining: float = 0.0  # Distance to the end of its route [m]
    speed: float = 0.0  # [m/s]
    priority: int = 0


@dataclass(frozen=True, slots=True)
class Approach:
    """How one vehicle comes to the zone that it shares with another one, the most urgent of several."""

    distance: float  # Distance to that zone [m]; 0 past its beginning
    earliest: float  # Earliest time at which it can be there [s]; negative if it is past that
    can_stop: bool  # Whether it can still stop before that zone


@dataclass(frozen=True, slots=True)
class Instance:
    """The ordering problem of one moment."""

    time: float  # Simulated time [s]
    vehicles: Mapping[str, ApproachingVehicle]
    # Time that must lie between two vehicles at their reference points, by (first, second), for every pair that shares
    # a zone or a lane [s].
    separation: Mapping[Pair, float]
    before: Set[Pair]
    approaches: Mapping[Pair, Approach] = field(default_factory=dict)  # Of the first of each pair to their zone
    # Of pairs of which either may be first, zone by zone, by (one, other): for how long before and after the one passes
    # its reference point the other one must not pass its own, a pair of times for each zone [s].
    zones: Mapping[Pair, tuple[tuple[float, float], ...]] = field(default_factory=dict)

    def approach(self, one: str, other: str) -> Approach:
        """Return how a vehicle comes to the zone that it shares with another one; its first one if they share none."""
        vehicle = self.vehicles[one]
        first = Approach(vehicle.distance, vehicle.eta, not vehicle.committed)
        return self.approaches.get((one, other), first)

    @property
    def entrants(self) -> NoReturn:
        """Say where it is, to rules that were written for release 0.1."""
        raise AttributeError("instance.entrants of release 0.1 is instance.vehicles now")

    def conflict(self, one: str, other: str) -> bool:
        """Whether two vehicles cannot pass at the same time."""
        return (one, other) in self.separation or (other, one) in self.separation
