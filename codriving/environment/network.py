"""A road as data becomes a road network of highway-env, with lanes that compute the same numbers sooner."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from highway_env.road.lane import AbstractLane, CircularLane, LineType, SineLane, StraightLane
from highway_env.road.road import LaneIndex, RoadNetwork
from numpy.typing import NDArray

from codriving.datatypes import Arc, Lane, Line, Road, Sine
from codriving.errors import ScenarioError

PAINT = {
    Line.NONE: LineType.NONE,
    Line.STRIPED: LineType.STRIPED,
    Line.CONTINUOUS: LineType.CONTINUOUS,
    Line.CONTINUOUS_LINE: LineType.CONTINUOUS_LINE,
}


def build_lane(lane: Lane) -> AbstractLane:
    """Turn one lane into highway-env's class for its shape."""
    shape, painted = lane.shape, [PAINT[line] for line in lane.lines]
    common = {
        "width": lane.width,
        "line_types": painted,
        "forbidden": lane.forbidden,
        "speed_limit": lane.speed_limit,
        "priority": lane.priority,
    }
    if isinstance(shape, Arc):
        center, turn = np.array(shape.center), shape.clockwise
        return PlainCircularLane(center, shape.radius, shape.start_phase, shape.end_phase, clockwise=turn, **common)
    start, end = np.array(shape.start), np.array(shape.end)
    if isinstance(shape, Sine):
        return SineLane(start, end, shape.amplitude, shape.pulsation, shape.phase, **common)
    aligned = 0.0 in (end - start)
    return (AlignedLane if aligned else PlainStraightLane)(start, end, **common)


def build_network(road: Road) -> RoadNetwork:
    """Turn a road into highway-env's network, lanes in their order."""
    network = RoadNetwork()
    for lane in road.lanes:
        start, end, index = lane.id
        network.add_lane(start, end, build_lane(lane))
        if len(network.graph[start][end]) != index + 1:
            raise ScenarioError(
                f"lane {lane.id} of road {road.name!r} must follow lanes 0 to {index - 1} between its two nodes and "
                "come before the others; reorder or renumber the lanes"
            )
    return network


class PlainStraightLane(StraightLane):
    """A straight lane."""

    def __init__(self, start: NDArray[np.float64], end: NDArray[np.float64], **settings: Any) -> None:  # noqa: ANN401
        super().__init__(start, end, **settings)
        self.heading: float = float(self.heading)
        self.length: float = float(self.length)

    def local_coordinates(self, position: NDArray[np.float64]) -> tuple[float, float]:
        """Return arc length and lateral offset of a place (2,) [m]."""
        delta = position - self.start
        # The method, since plain products may be rounded differently from numpy's fused ones.
        return float(delta.dot(self.direction)), float(delta.dot(self.direction_lateral))


class AlignedLane(PlainStraightLane):
    """A straight lane along an axis of the map; products with 0, 1 and -1 are exact, so that no rounding can differ."""

    def __init__(self, start: NDArray[np.float64], end: NDArray[np.float64], **settings: Any) -> None:  # noqa: ANN401
        super().__init__(start, end, **settings)
        self._x, self._y = self.start.tolist()
        self._cos, self._sin = self.direction.tolist()

    def local_coordinates(self, position: NDArray[np.float64]) -> tuple[float, float]:
        """Return arc length and lateral offset of a place (2,) [m]."""
        x, y = position.tolist()
        x -= self._x
        y -= self._y
        # No zero of a dot product is negative.
        return x * self._cos + y * self._sin + 0.0, y * self._cos - x * self._sin + 0.0


class PlainCircularLane(CircularLane):
    """An arc."""

    def local_coordinates(self, position: NDArray[np.float64]) -> tuple[float, float]:
        """Return arc length and lateral offset of a place (2,) [m]."""
        delta = position - self.center
        turn = float(np.arctan2(delta[1], delta[0])) - self.start_phase
        # Not simplified: adding the start phase and taking it off again rounds, and highway-env does it.
        phase = self.start_phase + (((turn + math.pi) % (2 * math.pi)) - math.pi)
        radius = math.sqrt(delta.dot(delta))
        return self.direction * (phase - self.start_phase) * self.radius, self.direction * (self.radius - radius)


JOINT = 0.5  # Largest distance between the end of a lane and the start of one that continues it [m]

BEND = 0.3  # Largest difference of their headings [rad]


def continues(lane: AbstractLane, following: AbstractLane) -> bool:
    """Whether one lane begins where another one ends, in the same direction."""
    gap = np.linalg.norm(lane.position(lane.length, 0) - following.position(0, 0))
    turn = lane.heading_at(lane.length) - following.heading_at(0)
    return bool(gap < JOINT and abs((turn + np.pi) % (2 * np.pi) - np.pi) < BEND)


def connected(network: RoadNetwork, index: LaneIndex, planned: Sequence[str]) -> list[tuple[AbstractLane, float]]:
    """Find the lanes that physically precede and follow a lane."""
    start, end, _ = index
    lane = network.get_lane(index)
    found = []
    for to, lanes in network.graph.get(end, {}).items():
        if not planned or to in planned:
            found += [(other, lane.length) for other in lanes if continues(lane, other)]
    for ends in network.graph.values():
        found += [(other, -other.length) for other in ends.get(start, []) if continues(other, lane)]
    return found
