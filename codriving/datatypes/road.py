"""A road as data: lanes, the routes along them, and nothing that moves."""

from dataclasses import dataclass
from enum import StrEnum

LaneId = tuple[str, str, int]  # Start node, end node and index from the left of a lane

Point = tuple[float, float]  # x and y [m]; y grows to the right of an observer who looks along x, as in highway-env


class Turn(StrEnum):
    """What a route does at the junction; drives the rule that turning yields to straight."""

    LEFT = "left"
    STRAIGHT = "straight"
    RIGHT = "right"


@dataclass(frozen=True, slots=True)
class Straight:
    """A straight centre line."""

    start: Point  # First point of the centre line [m]
    end: Point  # Last point of the centre line [m]


@dataclass(frozen=True, slots=True)
class Arc:
    """A circular centre line."""

    center: Point  # Centre of the circle [m]
    radius: float  # Radius of the centre line [m]
    start_phase: float  # Angle of the first point seen from the centre [rad]
    end_phase: float  # Angle of the last point seen from the centre [rad]
    clockwise: bool = True


@dataclass(frozen=True, slots=True)
class Sine:
    """A straight line plus a sinusoidal lateral offset, for tapers."""

    start: Point  # First point of the base line [m]
    end: Point  # Last point of the base line [m]
    amplitude: float  # Lateral amplitude [m]
    pulsation: float  # Spatial frequency [rad/m]
    phase: float  # Phase at the start [rad]


LaneShape = Straight | Arc | Sine


class Line(StrEnum):
    """How one side of a lane is painted."""

    NONE = "none"
    STRIPED = "striped"
    CONTINUOUS = "continuous"
    CONTINUOUS_LINE = "continuous_line"


@dataclass(frozen=True, slots=True)
class Lane:
    """One directed lane between two nodes of the road network."""

    id: LaneId
    shape: LaneShape
    width: float = 4.0  # Lane width [m]
    speed_limit: float = 10.0  # Highest legal speed [m/s]
    priority: int = 0
    lines: tuple[Line, Line] = (Line.STRIPED, Line.STRIPED)
    forbidden: bool = False


@dataclass(frozen=True, slots=True)
class Block:
    """Something solid that stands on the road, for instance where a lane ends, or a building beside it."""

    position: Point  # Its centre [m]
    length: float = 2.0  # Length along the heading [m]
    width: float = 2.0  # Width across it [m]
    heading: float = 0.0  # [rad]


@dataclass(frozen=True, slots=True)
class Route:
    """A way through the road from a source to a destination."""

    id: str  # Name that is unique on the road, for instance ``south-north``
    lanes: tuple[LaneId, ...]
    turn: Turn
    entry: float  # Arc length at which the shared part of the road (junction, ring, merge) begins [m]
    goal: float  # Arc length at which a vehicle has arrived [m]
    # Length of the way from one lane to the one beside it, which ends where the lane that is left does [m].
    taper: float = 40.0


@dataclass(frozen=True, slots=True)
class Road:
    """All lanes and routes of one scenario."""

    name: str
    lanes: tuple[Lane, ...]
    routes: tuple[Route, ...]
    regulated: bool = False
    blocks: tuple[Block, ...] = ()
    buildings: tuple[Block, ...] = ()  # What stands beside the road and hides vehicles from one another


def beside(lane: LaneId, other: LaneId) -> bool:
    """Whether two different lanes run side by side, between the same nodes."""
    return lane[:2] == other[:2] and lane[2] != other[2]
