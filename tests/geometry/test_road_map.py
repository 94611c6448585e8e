"""Maps of whole roads: the textbook counts, and what a broken road is told."""

import math
from collections import Counter
from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest

from codriving.datatypes.order import Relation
from codriving.datatypes.road import Arc, Lane, Road, Route, Straight, Turn
from codriving.errors import ScenarioError
from codriving.geometry.box import PLANNING, TRUE, Footprint
from codriving.geometry.road_map import RoadMap, road_map

FOOTPRINTS = [Footprint(0.6, 0.6), Footprint(1.0, 1.0), Footprint(4.0, 1.8), TRUE, Footprint(6.0, 2.4), PLANNING]

ROAD = Road(
    "two lanes",
    (Lane(("a", "b", 0), Straight((0, 0), (30, 0))), Lane(("b", "c", 0), Straight((30, 0), (60, 0)))),
    (Route("all", (("a", "b", 0), ("b", "c", 0)), Turn.STRAIGHT, 20, 50),),
)


def _pairs(road: RoadMap, footprint: Footprint) -> tuple[Counter[Relation], int]:
    zones = [road.zones(*pair, footprint) for pair in combinations(sorted(road.paths), 2)]
    return Counter(zone.relation for found in zones for zone in found), sum(not found for found in zones)


@pytest.mark.parametrize("footprint", FOOTPRINTS)
def test_intersection_has_the_textbook_counts(intersection: RoadMap, footprint: Footprint) -> None:
    relations, free = _pairs(intersection, footprint)
    assert relations == {Relation.CROSSING: 16, Relation.CONVERGING: 12, Relation.DIVERGING: 12}
    assert free == 26
    assert all(len(intersection.zones(*pair, footprint)) <= 1 for pair in combinations(intersection.paths, 2))


@pytest.mark.parametrize("footprint", [TRUE, PLANNING])
def test_intersection_crossings_by_turn(intersection: RoadMap, footprint: Footprint) -> None:
    turns = Counter(
        tuple(sorted((str(intersection.routes[a].turn), str(intersection.routes[b].turn))))
        for a, b in combinations(sorted(intersection.paths), 2)
        if any(zone.relation is Relation.CROSSING for zone in intersection.zones(a, b, footprint))
    )
    assert turns == {("straight", "straight"): 4, ("left", "straight"): 8, ("left", "left"): 4}
    assert not intersection.zones("south-west", "north-east", footprint), "opposite left turns"


@pytest.mark.parametrize("footprint", [Footprint(0.6, 0.6), TRUE, PLANNING])
def test_roundabout_weaves_and_never_crosses(roundabout: RoadMap, footprint: Footprint) -> None:
    relations, _ = _pairs(roundabout, footprint)
    assert relations == {Relation.WEAVING: 24, Relation.CONVERGING: 12, Relation.DIVERGING: 12}


@pytest.mark.parametrize("network", ["intersection", "roundabout"])
def test_both_see_the_same_zones(network: str, request: pytest.FixtureRequest) -> None:
    road: RoadMap = request.getfixturevalue(network)
    for a, b in combinations(sorted(road.paths), 2):
        there, back = road.zones(a, b), road.zones(b, a)
        assert len(there) == len(back)
        assert {(z.entry_i, z.exit_i, z.entry_j, z.exit_j, z.relation) for z in there} == {
            (z.entry_j, z.exit_j, z.entry_i, z.exit_i, z.relation) for z in back
        }
        assert [z.entry_i for z in back] == sorted(z.entry_i for z in back)


def test_a_quarter_turn_of_the_map_permutes_the_table(intersection: RoadMap) -> None:
    legs = ("south", "west", "north", "east")
    after = dict(zip(legs, legs[1:] + legs[:1], strict=True))

    def turned(route: str) -> str:
        return "-".join(after[leg] for leg in route.split("-"))

    for a, b in combinations(intersection.paths, 2):
        here, there = intersection.zones(a, b), intersection.zones(turned(a), turned(b))
        assert [z.relation for z in here] == [z.relation for z in there]
        for z, w in zip(here, there, strict=True):
            assert (z.entry_i, z.exit_i, z.entry_j, z.exit_j) == pytest.approx(
                (w.entry_i, w.exit_i, w.entry_j, w.exit_j), abs=0.02
            )
            s = np.linspace(z.entry_j + 0.6, z.exit_j - 0.6, 30)
            np.testing.assert_allclose(z.front(s), w.front(s), atol=0.6)


def test_zones_of_one_route_follow(intersection: RoadMap) -> None:
    (zone,) = intersection.zones("south-north", "south-north")
    assert zone.relation is Relation.FOLLOWING
    assert zone.front(50.0) == 56.0


def test_lane_starts_and_paths(intersection: RoadMap) -> None:
    assert intersection.lane_start("south-east", ("ir0", "il3", 0)) == pytest.approx(100)
    assert intersection.lane_start("south-east", ("il3", "o3", 0)) == pytest.approx(100 + 9 * math.pi / 2)
    assert intersection.paths["south-north"].length == pytest.approx(222)
    with pytest.raises(KeyError):
        intersection.lane_start("south-east", ("ir0", "il1", 0))


def test_routes_near_a_place_on_an_approach(intersection: RoadMap) -> None:
    found = intersection.nearby.routes(2.3, 61, heading=-math.pi / 2)
    assert [name for name, _ in found] == ["south-east", "south-north", "south-west"]
    assert [s for _, s in found] == pytest.approx([50, 50, 50])


def test_routes_near_a_place_on_a_turn(intersection: RoadMap) -> None:
    path = intersection.paths["south-east"]
    x, y = path.position(107.0)
    found = intersection.nearby.routes(float(x), float(y), heading=float(path.heading(107.0)) + 4 * math.pi)
    assert [name for name, _ in found] == ["south-east"]
    assert found[0][1] == pytest.approx(107, abs=0.02)


def test_routes_near_needs_place_and_heading_to_fit(intersection: RoadMap) -> None:
    assert intersection.nearby.routes(2, 61, heading=math.pi / 2) == ()
    assert intersection.nearby.routes(30, 61, heading=None) == ()
    assert len(intersection.nearby.routes(0, 61, heading=None, tolerance=2.5)) == 6


def test_equal_roads_share_a_map() -> None:
    assert road_map(ROAD) is road_map(replace(ROAD))
    assert road_map(replace(ROAD, name="another")) is not road_map(ROAD)


@pytest.mark.parametrize(
    ("broken", "complaint"),
    [
        (replace(ROAD, routes=()), "no routes"),
        (replace(ROAD, lanes=ROAD.lanes * 2), r"lane id \('a', 'b', 0\) is used 2 times"),
        (replace(ROAD, routes=ROAD.routes * 2), "route id 'all' is used 2 times"),
        (replace(ROAD, lanes=ROAD.lanes[:1]), r"uses lane \('b', 'c', 0\), which does not exist"),
        (replace(ROAD, routes=(replace(ROAD.routes[0], lanes=()),)), "has no lanes"),
        (replace(ROAD, routes=(replace(ROAD.routes[0], lanes=ROAD.routes[0].lanes[::-1]),)), "ends at node 'c'"),
        (replace(ROAD, routes=(replace(ROAD.routes[0], goal=60.5),)), "0 <= entry <= goal"),
        (replace(ROAD, routes=(replace(ROAD.routes[0], entry=51),)), "0 <= entry <= goal"),
        (
            replace(ROAD, lanes=(ROAD.lanes[0], Lane(("b", "c", 0), Straight((60, 0), (90, 0))))),
            "over a gap of 30.0 m",
        ),
        (
            replace(ROAD, lanes=(ROAD.lanes[0], Lane(("b", "c", 0), Straight((30, 4), (60, 4))))),
            "4.0 m away at an angle of 90 deg",
        ),
        (replace(ROAD, lanes=(ROAD.lanes[0], Lane(("b", "c", 0), Straight((1, 1), (1, 1))))), "starts and ends at"),
        (replace(ROAD, lanes=(ROAD.lanes[0], Lane(("b", "c", 0), Arc((0, 0), -1, 0, 1)))), "radius > 0"),
        (replace(ROAD, lanes=(ROAD.lanes[0], Lane(("b", "c", 0), Arc((0, 0), 5, 1, 0)))), "against its direction"),
        (replace(ROAD, lanes=(ROAD.lanes[0], replace(ROAD.lanes[1], width=0))), "a width and a speed limit > 0"),
    ],
)
def test_a_broken_road_is_refused_with_its_fault(broken: Road, complaint: str) -> None:
    with pytest.raises(ScenarioError, match=complaint):
        RoadMap(broken)


def test_projecting_together_changes_nothing(intersection: RoadMap) -> None:
    together, alone = RoadMap(intersection.road), RoadMap(intersection.road)
    places = [(2.0 + 0.3 * k, 60.0 - 7.7 * k) for k in range(12)]
    for route in intersection.routes:
        together.project_all(route, places)
        # A second time there is nothing left to do.
        together.project_all(route, places[:3])
        assert [together.project(route, *at) for at in places] == [alone.project(route, *at) for at in places]
        assert [alone.paths[route].project(*at) for at in places] == [alone.project(route, *at) for at in places]


def test_the_lane_at_a_place_begins_at_or_before_it(intersection: RoadMap) -> None:
    for name, route in intersection.routes.items():
        for lane in route.lanes:
            start = intersection.lane_start(name, lane)
            assert intersection.lane_at(name, start) == lane
            assert intersection.lane_at(name, start + 0.1) == lane
        assert intersection.lane_at(name, -5.0) == route.lanes[0]
