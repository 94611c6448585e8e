"""A road as data becomes a road network of highway-env."""

import numpy as np
from highway_env.road.lane import AbstractLane, LineType, SineLane
from highway_env.road.road import RoadNetwork

from codriving.datatypes.road import Arc, Lane, Line, Road, Sine
from codriving.environment.lanes import PlainCircularLane, PlainStraightLane
from codriving.errors import ScenarioError

PAINT = {
    Line.NONE: LineType.NONE,
    Line.STRIPED: LineType.STRIPED,
    Line.CONTINUOUS: LineType.CONTINUOUS,
    Line.CONTINUOUS_LINE: LineType.CONTINUOUS_LINE,
}


def build_lane(lane: Lane) -> AbstractLane:
    """Turn one lane into highway-env's class for its shape."""
    painted = [PAINT[line] for line in lane.lines]
    shape = lane.shape
    common = {
        "width": lane.width,
        "line_types": painted,
        "forbidden": lane.forbidden,
        "speed_limit": lane.speed_limit,
        "priority": lane.priority,
    }
    if isinstance(shape, Arc):
        return PlainCircularLane(
            np.array(shape.center),
            shape.radius,
            shape.start_phase,
            shape.end_phase,
            clockwise=shape.clockwise,
            **common,
        )
    start, end = np.array(shape.start), np.array(shape.end)
    if isinstance(shape, Sine):
        return SineLane(start, end, shape.amplitude, shape.pulsation, shape.phase, **common)
    return PlainStraightLane(start, end, **common)


def build_network(road: Road) -> RoadNetwork:
    """Turn a road into highway-env's network, lanes in their order.

    Raises:
        ScenarioError: If parallel lanes are not given from index 0 upwards; highway-env counts them in their order.
    """
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
