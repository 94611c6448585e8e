"""Relations of two routes, told from the stretch that they share."""

import math
from itertools import pairwise

import pytest

from codriving.datatypes.order import Relation
from codriving.datatypes.road import Lane, Straight
from codriving.geometry.box import TRUE
from codriving.geometry.find_zones import find_zones
from codriving.geometry.lane_path import lane_path, route_path
from codriving.geometry.path import Path

Points = list[tuple[float, float]]


def _path(*points: tuple[float, float]) -> Path:
    ends = pairwise(points)
    return route_path([Lane((str(k), str(k + 1), 0), Straight(*pair)) for k, pair in enumerate(ends)])


MAIN = _path((0, 0), (100, 0))


@pytest.mark.parametrize(
    ("other", "relation"),
    [
        ([(50, -40), (50, 40)], Relation.CROSSING),
        ([(0, 20), (40, 0), (100, 0)], Relation.CONVERGING),
        ([(0, 0), (60, 0), (100, 20)], Relation.DIVERGING),
        ([(0, 20), (40, 0), (60, 0), (100, 20)], Relation.WEAVING),
        ([(0, 0), (100, 0)], Relation.FOLLOWING),
        # They stay together for as long as both routes exist, though one goes on or began earlier.
        ([(0, 20), (40, 0), (140, 0)], Relation.CONVERGING),
        ([(0, 20), (40, 0), (80, 0)], Relation.CONVERGING),
        ([(-40, 0), (60, 0), (100, 20)], Relation.DIVERGING),
        # The same centre line, but the other way.
        ([(100, 0), (0, 0)], Relation.CROSSING),
        # A common stretch of 3 m is a mere crossing.
        ([(0, -20), (40, 0), (43, 0), (83, 20)], Relation.CROSSING),
    ],
)
def test_relation_is_told_by_what_the_common_stretch_touches(other: Points, relation: Relation) -> None:
    (zone,) = find_zones(MAIN, _path(*other), TRUE)
    assert zone.relation is relation
    assert (zone.merge_i is None) == (relation not in (Relation.CONVERGING, Relation.WEAVING))
    assert (zone.split_i is None) == (relation not in (Relation.DIVERGING, Relation.WEAVING))


def test_merge_and_split_are_the_ends_of_the_common_stretch() -> None:
    way_in = math.hypot(40, 20)
    (zone,) = find_zones(MAIN, _path((0, 20), (40, 0), (60, 0), (100, 20)), TRUE)
    assert (zone.merge_i, zone.split_i) == pytest.approx((40, 60), abs=0.6)
    assert (zone.merge_j, zone.split_j) == pytest.approx((way_in, way_in + 20), abs=0.6)
    assert (zone.point_i, zone.point_j) == (zone.merge_i, zone.merge_j)


def test_two_separate_meetings_are_two_zones() -> None:
    zones = find_zones(MAIN, _path((0, 20), (20, 0), (30, 0), (50, 15), (70, 0), (100, 0)), TRUE)
    assert [zone.relation for zone in zones] == [Relation.WEAVING, Relation.CONVERGING]
    assert zones[0].exit_i < zones[1].entry_i


def test_neighbouring_lanes_do_not_meet() -> None:
    assert find_zones(MAIN, lane_path(Lane(("a", "b", 0), Straight((0, 4), (100, 4)))), TRUE) == ()
