"""Lanes beside one another: which one a place is on, which ones a body reaches onto, and who still has to change."""

import math

import numpy as np
import pytest

from codriving.datatypes.road import Lane, LaneId, Road, Route, Straight, Turn
from codriving.geometry.road_map import RoadMap


def _lane(start: str, end: str, index: int, x: float, x2: float) -> Lane:
    return Lane((start, end, index), Straight((x, 4.0 * index), (x2, 4.0 * index)))


def _route(name: str, *lanes: LaneId, goal: float = 180.0) -> Route:
    return Route(name, lanes, Turn.STRAIGHT, 0.0, goal)


A, B = [("a", "b", k) for k in range(3)], [("b", "c", k) for k in range(3)]
LANES = (*(_lane("a", "b", k, 0.0, 100.0) for k in range(3)), *(_lane("b", "c", k, 100.0, 200.0) for k in range(2)))


@pytest.fixture(scope="module")
def road() -> RoadMap:
    """Three lanes, of which the right one ends after 100 m; the vehicle that is on it changes on its last 40 m."""
    routes = (_route("left", A[0], B[0]), _route("middle", A[1], B[1]), _route("ending", A[2], A[1], B[1]))
    return RoadMap(Road("narrowing", LANES, routes))


def test_lane_at_a_place_of_a_route(road: RoadMap) -> None:
    assert [road.lane_at("left", s) for s in (-3.0, 0.0, 99.0, 100.0, 250.0)] == [A[0], A[0], A[0], B[0], B[0]]
    assert [road.lane_at("ending", s) for s in (0.0, 79.0, 82.0, 99.0, 101.0)] == [A[2], A[2], A[1], A[1], B[1]]


def test_a_change_is_ahead_until_the_lane_ends(road: RoadMap) -> None:
    by = road.lane_start("ending", A[1])
    assert by == pytest.approx(80.0, abs=0.2)
    ahead = (A[1], by, by + 20.0)
    assert road.changes.ahead("ending", 0.0) == road.changes.ahead("ending", by + 19.9) == ahead
    assert road.changes.ahead("ending", by + 20.0) is None
    assert road.changes.ahead("middle", 0.0) is None


def test_routes_beside_are_those_that_need_the_fewest_changes(road: RoadMap) -> None:
    assert road.changes.routes_beside("left", A[0]) == (("middle", A[1]),)
    assert road.changes.routes_beside("middle", A[1]) == (("left", A[0]), ("ending", A[2]))
    assert road.changes.routes_beside("ending", A[2]) == (("middle", A[1]),), "not itself, which also comes along there"
    assert road.changes.routes_beside("ending", B[1]) == (("left", B[0]),)


def test_routes_that_end_elsewhere_are_not_beside() -> None:
    lanes = (*LANES[:2], Lane(("b", "d", 0), Straight((100.0, 0.0), (200.0, -50.0))), LANES[4])
    lanes = (*lanes[:3], Lane(("b", "c", 0), Straight((100.0, 4.0), (200.0, 4.0))))
    routes = (_route("off", A[0], ("b", "d", 0)), _route("on", A[1], ("b", "c", 0)))
    road = RoadMap(Road("fork", lanes, routes))
    assert road.changes.routes_beside("on", A[1]) == ()


@pytest.mark.parametrize(
    ("route", "y", "covered"),
    [
        ("left", 0.0, []),
        ("left", 0.3, []),
        ("left", 0.5, ["middle"]),  # its side is 0.5 m from the line, nearer than 0.6 m
        ("left", 2.5, ["middle"]),
        ("middle", 4.0, []),
        ("middle", 3.5, ["left"]),
        ("middle", 4.5, ["ending"]),
        ("ending", 8.0, []),
        ("ending", 6.0, ["middle"]),
    ],
)
def test_a_body_reaches_onto_the_lanes_beside(route: str, y: float, covered: list[str], road: RoadMap) -> None:
    found = road.changes.covered(route, road.lane_at(route, 50.0), 50.0, y)
    assert [name for name, _ in found] == covered
    assert [s for _, s in found] == pytest.approx([50.0] * len(covered))


def test_places_on_a_covered_lane_are_counted_along_its_route(road: RoadMap) -> None:
    assert road.changes.covered("left", B[0], 130.0, 1.0) == (("middle", pytest.approx(130.0)),)


def test_who_has_not_changed_yet_is_still_on_the_route(road: RoadMap) -> None:
    for x in (65.0, 80.0, 95.0):
        found = dict(road.nearby.routes(x, 8.0, 0.0))
        assert set(found) == {"ending"}, "beside the taper, and 4 m from the lane that is changed to"
        assert found["ending"] == pytest.approx(x, abs=0.3)
        assert dict(road.nearby.routes(x, 8.0, None)).keys() == {"ending"}
        assert road.nearby.routes(x, 8.0, math.pi) == (), "against the traffic"
    assert road.nearby.routes(104.0, 8.0, 0.0) == ()
    assert set(dict(road.nearby.routes(30.0, 8.0, 0.0))) == {"ending"}


def test_who_is_on_the_taper_is_found_once(road: RoadMap) -> None:
    path = road.paths["ending"]
    for s in np.linspace(60.0, 100.0, 9):
        x, y = path.position(s)
        names = [name for name, _ in road.nearby.routes(float(x), float(y), float(path.heading(s)))]
        assert names.count("ending") == 1
        assert ("middle" in names) == (abs(y - 4.0) <= 2.0)
