"""The ordering problem of one moment: who comes, when at the earliest, and what must lie between two of them."""

from collections.abc import Mapping, Set
from dataclasses import dataclass, field

Pair = tuple[str, str]
"""Two vehicles, the first of which passes first."""


@dataclass(slots=True)
class ApproachingVehicle:
    """What an order has to know of one CAV that still has a conflict ahead.

    Attributes:
        windows: Intervals in which it must not pass the reference point, because of human drivers [s].
        crossing: Time from the reference point until it has left its last conflict zone, at top speed [s].
    """

    id: str
    reference: float  # Arc length of its first conflict zone [m]
    eta: float  # Earliest time at which it can be there [s]; negative if it is past it
    committed: bool = False
    turning: bool = False
    leader: str | None = None
    windows: list[tuple[float, float]] = field(default_factory=list)
    lane: str = ""
    stream: str = ""
    distance: float = 0.0  # Distance to the reference point [m]; 0 past it
    crossing: float = 0.0
    remaining: float = 0.0  # Distance to the end of its route [m]
    speed: float = 0.0  # [m/s]
    priority: int = 0


@dataclass(frozen=True, slots=True)
class Instance:
    """The ordering problem of one moment.

    Attributes:
        separation: Time that must lie between two vehicles at their reference points, by (first, second), for every
            pair that shares a zone or a lane [s].
    """

    time: float  # Simulated time [s]
    vehicles: Mapping[str, ApproachingVehicle]
    separation: Mapping[Pair, float]
    before: Set[Pair]

    def conflict(self, one: str, other: str) -> bool:
        """Whether two vehicles cannot pass at the same time."""
        return (one, other) in self.separation or (other, one) in self.separation
