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
    """A true overlap of two footprints.

    Attributes:
        time: When the footprints first overlapped [s].
        pair: ``CAV-CAV``, ``CAV-HDV``, ``HDV-HDV``, ``CAV-block`` or ``HDV-block``.
    """

    time: float
    striker: str
    struck: str
    pair: str


@dataclass(frozen=True, slots=True)
class Outcome:
    """The one end of an episode.

    Attributes:
        time: Simulated time at the end [s].
        arrivals: Arrival time of each CAV that arrived [s], by id.
        message: What went wrong, for ``error``.
    """

    ending: Ending
    time: float
    arrivals: dict[str, float]
    collision: Collision | None = None
    bystander_collisions: tuple[Collision, ...] = ()
    off_road: tuple[str, ...] = ()
    message: str = ""
