"""How an episode ends."""

from dataclasses import dataclass
from enum import StrEnum


class Ending(StrEnum):
    """The ways in which an episode ends; ``error`` is never counted as driving."""

    SUCCESS = "success"
    COLLISION = "collision"
    TIMEOUT = "timeout"
    OFF_ROAD = "off_road"
    ERROR = "error"


@dataclass(frozen=True, slots=True)
class Collision:
    """A true overlap of two footprints."""

    time: float  # When the footprints first overlapped [s]
    striker: str
    struck: str
    pair: str  # ``CAV-CAV``, ``CAV-HDV``, ``HDV-HDV``, ``CAV-block`` or ``HDV-block``


@dataclass(frozen=True, slots=True)
class Outcome:
    """The one end of an episode."""

    ending: Ending
    time: float  # Simulated time at the end [s]
    arrivals: dict[str, float]  # Arrival time of each CAV that arrived [s], by id
    collision: Collision | None = None
    bystander_collisions: tuple[Collision, ...] = ()
    off_road: tuple[str, ...] = ()
    message: str = ""  # What went wrong, for ``error``

    @property
    def failed(self) -> tuple[str, ...]:
        """The vehicles of the collision, or those that left the road."""
        return self.off_road if self.collision is None else (self.collision.striker, self.collision.struck)
