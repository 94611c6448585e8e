"""Lines of sight past buildings: by hand, and against walking along each line in small steps."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from codriving.datatypes.road import Block, Lane, Road, Route, Straight, Turn
from codriving.errors import ScenarioError
from codriving.geometry.road_map import RoadMap
from codriving.geometry.sight import Sight

HOUSE = Block((20.0, 10.0), 20.0, 10.0)
"""From 10 to 30 m along x, and from 5 to 15 m along y."""


@pytest.mark.parametrize(
    ("one", "other", "hidden"),
    [
        ((0, 0), (40, 20), True),  # right through
        ((0, 0), (40, 4), False),  # past it
        ((0, 0), (30, 60), False),  # at y = 20 where it begins
        ((0, 0), (9, 9), False),  # it begins behind the other one
        ((0, 5), (40, 5), False),  # along a side
        ((0, 5.1), (40, 5.1), True),
        ((10, 0), (10, 20), False),  # along the other side
        ((0, 2.5), (10, 5), False),  # up to the corner
        ((0, 0), (20, 10), True),  # into it
        ((3, 3), (3, 3), False),  # no way at all
    ],
)
def test_a_building_hides_what_is_behind_it(one: tuple[float, float], other: tuple[float, float], hidden: bool) -> None:
    seen = Sight((HOUSE,)).hidden(*zip(one, other, strict=True))
    assert (bool(seen[0, 1]), bool(seen[1, 0])) == (hidden, hidden)


def test_a_turned_building_is_turned() -> None:
    turned = Block((0.0, 0.0), 20.0, 2.0, math.pi / 4)
    x, y = [-8.0, 8.0, 4.0, 12.0], [8.0, -8.0, 5.5, 14.0]
    hidden = Sight((turned,)).hidden(x, y)
    assert hidden[0, 1]
    assert not hidden[2, 3]
    assert not Sight(()).hidden(x, y).any()


places = st.tuples(st.floats(-30, 30), st.floats(-30, 30))
houses = st.builds(Block, places, st.floats(1, 30), st.floats(1, 30), st.floats(-4, 4))


@given(st.lists(houses, min_size=1, max_size=4), st.lists(places, min_size=2, max_size=6))
def test_it_is_what_a_walk_along_each_line_finds(buildings: list[Block], where: list[tuple[float, float]]) -> None:
    x, y = np.array(where).T
    hidden = Sight(buildings).hidden(x, y)
    share = np.linspace(0, 1, 2001)

    def deep(i: int, j: int, building: Block) -> float:
        """How deep the line runs into a building at most [m]; negative if it stays outside."""
        dx, dy = (v[i] + share * (v[j] - v[i]) - c for v, c in zip((x, y), building.position, strict=True))
        cos, sin = math.cos(building.heading), math.sin(building.heading)
        along, across = np.abs(dx * cos + dy * sin), np.abs(dy * cos - dx * sin)
        return float(np.minimum(building.length / 2 - along, building.width / 2 - across).max())

    for i in range(len(where)):
        for j in range(len(where)):
            deepest = max(deep(i, j, building) for building in buildings)
            # Steps are at most 4.3 cm, so that a corner which is cut by less may be stepped over.
            if i != j and abs(deepest) > 0.05:
                assert hidden[i, j] == (deepest > 0), (i, j, deepest)
    assert (hidden == hidden.T).all()


def test_a_building_on_a_lane_is_refused() -> None:
    lane = Lane(("a", "b", 0), Straight((0, 0), (60, 0)))
    routes = (Route("all", (lane.id,), Turn.STRAIGHT, 20, 50),)
    beside = Road("street", (lane,), routes, buildings=(Block((30.0, 8.0), 20.0, 11.9),))
    assert RoadMap(beside).sight is not None
    assert RoadMap(Road("street", (lane,), routes)).sight is None
    message = r"the building at \(30.0, 8.0\) of road 'street' reaches over lane \('a', 'b', 0\); move it, or make it"
    with pytest.raises(ScenarioError, match=message):
        RoadMap(Road("street", (lane,), routes, buildings=(Block((30.0, 8.0), 20.0, 12.1),)))
