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
    """The physical state of one vehicle, as others near enough could perceive it."""

    id: str  # Name, unique in the episode, for instance ``CAV1``
    kind: Kind
    x: float  # Position of the centre [m]
    y: float  # Position of the centre [m]
    heading: float  # [rad]
    speed: float  # Speed along the heading [m/s]
    acceleration: float  # Commanded acceleration of the last simulation step [m/s2]
    lane: LaneId
    length: float = 5.0  # [m]
    width: float = 2.0  # [m]


@dataclass(frozen=True, slots=True)
class Intent:
    """What a CAV means to do; known to others only if it shares it (CDA class B)."""

    route: str
    target_speed: float  # Speed that the controller tracks [m/s]
    target_lane: LaneId
