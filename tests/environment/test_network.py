"""The intersection's network is highway-env's, lane by lane, and so are places on its lanes."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from highway_env.envs.intersection_env import IntersectionEnv
from highway_env.road.lane import AbstractLane, CircularLane, SineLane, StraightLane
from highway_env.road.road import RoadNetwork

from codriving.datatypes.road import Arc, Lane, LaneShape, Line, Road, Route, Sine, Straight, Turn
from codriving.environment.environment import Environment
from codriving.environment.network import build_lane, build_network
from codriving.errors import ScenarioError


def stock_network() -> RoadNetwork:
    # Its constructor would also put vehicles on the road and write into the classes of drivers.
    env = object.__new__(IntersectionEnv)
    env.config = IntersectionEnv.default_config()
    env._make_road()
    return env.road.network


def test_network_equals_that_of_highway_env_lane_by_lane(intersection: Callable[..., Environment]) -> None:
    ours, theirs = build_network(intersection().scenario.road), stock_network()
    assert list(ours.graph) == list(theirs.graph)
    for index, lane in theirs.lanes_dict().items():
        mine = ours.lanes_dict()[index]
        assert isinstance(mine, type(lane))
        for name, value in vars(lane).items():
            assert np.array_equal(getattr(mine, name), value), (index, name)
    assert ours.lanes_dict().keys() == theirs.lanes_dict().keys()
    assert [list(ends) for ends in ours.graph.values()] == [list(ends) for ends in theirs.graph.values()]


SHAPES: list[tuple[LaneShape, AbstractLane]] = [
    (Straight((1.0, 2.0), (40.0, -7.0)), StraightLane([1.0, 2.0], [40.0, -7.0])),
    (Straight((1.1, 2.3), (40.7, 2.3)), StraightLane([1.1, 2.3], [40.7, 2.3])),
    (Straight((1.1, 2.3), (-40.7, 2.3)), StraightLane([1.1, 2.3], [-40.7, 2.3])),
    (Straight((1.1, 2.3), (1.1, 40.7)), StraightLane([1.1, 2.3], [1.1, 40.7])),
    (Straight((1.1, 2.3), (1.1, -40.7)), StraightLane([1.1, 2.3], [1.1, -40.7])),
    (Arc((3.0, -2.0), 9.0, 0.3, 1.9), CircularLane([3.0, -2.0], 9.0, 0.3, 1.9)),
    (Arc((3.0, -2.0), 13.0, 1.9, 0.3, clockwise=False), CircularLane([3.0, -2.0], 13.0, 1.9, 0.3, clockwise=False)),
    (Sine((0.0, 0.0), (80.0, 0.0), 2.0, 0.1, 0.5), SineLane([0.0, 0.0], [80.0, 0.0], 2.0, 0.1, 0.5)),
]


@pytest.mark.parametrize(("shape", "stock"), SHAPES)
def test_places_on_a_lane_are_the_same_bits(shape: LaneShape, stock: AbstractLane) -> None:
    lane = build_lane(Lane(("a", "b", 0), shape))
    for point in np.random.default_rng(0).uniform(-50, 50, size=(300, 2)):
        assert lane.local_coordinates(point) == stock.local_coordinates(point)
    assert math.isclose(lane.length, stock.length)


def test_lane_takes_over_what_it_is_told() -> None:
    told = Lane(("a", "b", 0), Straight((0, 0), (9, 0)), 3.5, 17.0, 2, (Line.NONE, Line.CONTINUOUS_LINE), True)
    lane = build_lane(told)
    assert (lane.width, lane.speed_limit, lane.priority, lane.forbidden) == (3.5, 17.0, 2, True)
    assert list(lane.line_types) == [0, 3]


def test_parallel_lanes_out_of_order_are_refused() -> None:
    lanes = tuple(Lane(("a", "b", k), Straight((0, 4.0 * k), (90, 4.0 * k))) for k in (1, 0))
    road = Road("upside down", lanes, (Route("r", (("a", "b", 0),), Turn.STRAIGHT, 0, 50),))
    with pytest.raises(ScenarioError, match=r"lane \('a', 'b', 1\) of road 'upside down' must follow lanes 0 to 0"):
        build_network(road)
