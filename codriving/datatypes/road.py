"""A road as data: lanes, the routes along them, and nothing that moves."""

from dataclasses import dataclass
from enum import StrEnum

LaneId = tuple[str, str, int]
"""Start node, end node and index from the left of a lane."""

Point = tuple[float, float]
"""x and y [m]; y grows to the right of an observer who looks along x, as in highway-env."""


class Turn(StrEnum):
    """What a route does at the junction; drives the rule that turning yields to straight."""

    LEFT = "left"
    STRAIGHT = "straight"
    RIGHT = "right"


@dataclass(frozen=True, slots=True)
class Straight:
    """A straight centre line.

    Attributes:
        start: First point of the centre line [m].
        end: Last point of the centre line [m].
    """

    start: Point
    end: Point


@dataclass(frozen=True, slots=True)
class Arc:
    """A circular centre line.

    Attributes:
        center: Centre of the circle [m].
        radius: Radius of the centre line [m].
        start_phase: Angle of the first point seen from the centre [rad].
        end_phase: Angle of the last point seen from the centre [rad].
    """

    center: Point
    radius: float
    start_phase: float
    end_phase: float
    clockwise: bool = True


@dataclass(frozen=True, slots=True)
class Sine:
    """A straight line plus a sinusoidal lateral offset, for tapers.

    Attributes:
        start: First point of the base line [m].
        end: Last point of the base line [m].
        amplitude: Lateral amplitude [m].
        pulsation: Spatial frequency [rad/m].
        phase: Phase at the start [rad].
    """

    start: Point
    end: Point
    amplitude: float
    pulsation: float
    phase: float


LaneShape = Straight | Arc | Sine


class Line(StrEnum):
    """How one side of a lane is painted."""

    NONE = "none"
    STRIPED = "striped"
    CONTINUOUS = "continuous"
    CONTINUOUS_LINE = "continuous_line"


@dataclass(frozen=True, slots=True)
class Lane:
    """One directed lane between two nodes of the road network.

    Attributes:
        width: Lane width [m].
        speed_limit: Highest legal speed [m/s].
    """

    id: LaneId
    shape: LaneShape
    width: float = 4.0
    speed_limit: float = 10.0
    priority: int = 0
    lines: tuple[Line, Line] = (Line.STRIPED, Line.STRIPED)
    forbidden: bool = False


@dataclass(frozen=True, slots=True)
class Block:
    """Something solid that stands on the road, for instance where a lane ends.

    Attributes:
        position: Its centre [m].
        length: Length along the heading [m].
        width: Width across it [m].
        heading: Heading [rad].
    """

    position: Point
    length: float = 2.0
    width: float = 2.0
    heading: float = 0.0


@dataclass(frozen=True, slots=True)
class Route:
    """A way through the road from a source to a destination.

    Attributes:
        id: Name that is unique on the road, for instance ``south-north``.
        entry: Arc length at which the shared part of the road (junction, ring, merge) begins [m].
        goal: Arc length at which a vehicle has arrived [m].
        taper: Length of the way from one lane to the one beside it, which ends where the lane that is left does [m].
    """

    id: str
    lanes: tuple[LaneId, ...]
    turn: Turn
    entry: float
    goal: float
    taper: float = 40.0


@dataclass(frozen=True, slots=True)
class Road:
    """All lanes and routes of one scenario."""

    name: str
    lanes: tuple[Lane, ...]
    routes: tuple[Route, ...]
    regulated: bool = False
    blocks: tuple[Block, ...] = ()


def beside(lane: LaneId, other: LaneId) -> bool:
    """Whether two different lanes run side by side, between the same nodes."""
    return lane[:2] == other[:2] and lane[2] != other[2]
