"""What a vehicle is and does at one moment."""

from dataclasses import dataclass
from enum import StrEnum

from codriving.datatypes.road import LaneId


class Kind(StrEnum):
    """Who drives: a connected automated vehicle or a human."""

    CAV = "CAV"
    HDV = "HDV"


@dataclass(frozen=True, slots=True)
class VehicleState:
    """The physical state of one vehicle, as anyone near enough could perceive it.

    Attributes:
        id: Name, unique in the episode, for instance ``CAV1``.
        x: Position of the centre [m].
        y: Position of the centre [m].
        heading: Heading [rad].
        speed: Speed along the heading [m/s].
        acceleration: Commanded acceleration of the last simulation step [m/s2].
        length: Vehicle length [m].
        width: Vehicle width [m].
    """

    id: str
    kind: Kind
    x: float
    y: float
    heading: float
    speed: float
    acceleration: float
    lane: LaneId
    length: float = 5.0
    width: float = 2.0


@dataclass(frozen=True, slots=True)
class Intent:
    """What a CAV means to do; known to others only if it shares it (CDA class B).

    Attributes:
        target_speed: Speed that the controller tracks [m/s].
    """

    route: str
    target_speed: float
    target_lane: LaneId
