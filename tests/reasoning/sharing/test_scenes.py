"""Scene descriptions: who is what to whom, lane by lane."""

import json
from dataclasses import asdict, replace

import pytest
from worlds import Junction, car

from codriving.datatypes.road import Lane, LaneId, Road, Route, Straight, Turn
from codriving.datatypes.situation import Role, SceneDescription
from codriving.datatypes.world import Action, Told
from codriving.geometry.road_map import RoadMap
from codriving.reasoning.sharing.scenes import adjacent_lanes, with_roles
from codriving.reasoning.sharing.sharing import SensedStates


def roles(scene: SceneDescription) -> dict[str, Role]:
    return {n.id: n.role for n in scene.neighbours}


def test_a_vehicle_in_another_role_is_the_same_vehicle(junction: Junction) -> None:
    scene = junction.thoughts(car("CAV1", "south-north", 60.0, 8.0), car("CAV2", "south-west", 75.0, 8.0)).scenes[
        "CAV1"
    ]
    told = replace(scene.neighbours[0], standing=3.0, told=Told(0.5, None))
    assert told.in_role(Role.REARING, 4.5) == replace(told, role=Role.REARING, gap=4.5)


def test_roles_and_gaps(junction: Junction) -> None:
    scene = junction.thoughts(
        car("CAV1", "south-north", 60.0, 8.0),
        car("CAV2", "south-west", 75.0, 8.0),
        car("CAV3", "south-east", 40.0, 8.0),
        car("CAV4", "west-east", 60.0, 8.0),
        car("HDV1", "south-north", 90.0, 8.0),
        car("HDV2", "south-north", 45.0, 8.0),
        car("HDV3", "north-west", 140.0, 8.0),
    ).scenes["CAV1"]
    assert roles(scene) == {
        "CAV2": Role.LEADING,
        "CAV3": Role.OTHER,
        "CAV4": Role.CONFLICT,
        "HDV1": Role.OTHER,
        "HDV2": Role.REARING,
        "HDV3": Role.OTHER,
    }
    gaps = {n.id: n.gap for n in scene.neighbours if n.gap is not None}
    assert gaps == {"CAV2": pytest.approx(10.0, abs=0.1), "HDV2": pytest.approx(10.0, abs=0.1)}
    assert scene.place == pytest.approx(60.0, abs=0.1)
    assert scene.adjacent_lanes == ()
    assert scene.ego.lane == ("o0", "ir0", 0)


def test_conflict_lanes_are_those_on_which_the_others_will_be_in_the_way(junction: Junction) -> None:
    scene = junction.thoughts(
        car("CAV1", "south-north", 60.0, 8.0), car("CAV2", "west-east", 60.0, 8.0), car("CAV3", "east-west", 60.0, 8.0)
    ).scenes["CAV1"]
    assert scene.conflict_lanes == (("ir1", "il3", 0), ("ir3", "il1", 0))


def test_a_vehicle_that_drives_across_the_ego_lane_does_not_lead(junction: Junction) -> None:
    cars = car("CAV1", "south-north", 90.0, 8.0), car("CAV2", "west-east", 113.0, 8.0)
    scene = junction.thoughts(*cars).scenes["CAV1"]
    assert roles(scene) == {"CAV2": Role.CONFLICT}
    # The vehicle that does not know its heading cannot tell.
    sensed = junction.think(junction.world(*cars), SensedStates()).scenes["CAV1"]
    assert roles(sensed) == {"CAV2": Role.LEADING}


def test_oncoming_traffic_is_neither_ahead_nor_in_conflict(junction: Junction) -> None:
    thoughts = junction.thoughts(car("CAV1", "south-north", 60.0, 8.0), car("CAV2", "north-south", 60.0, 8.0))
    assert roles(thoughts.scenes["CAV1"]) == {"CAV2": Role.OTHER}
    assert thoughts.scenes["CAV1"].conflict_lanes == ()


def test_who_shares_an_intent_is_known_to_be_a_cav_even_if_only_sensed(junction: Junction) -> None:
    world = junction.world(
        car("CAV1", "south-north", 80.0, 8.0), car("CAV2", "south-west", 95.0, 8.0), car("HDV1", "west-east", 80.0, 8.0)
    )
    scene = junction.think(world, SensedStates()).scenes["CAV1"]
    assert {n.id: n.kind for n in scene.neighbours} == {"CAV2": "CAV", "HDV1": None}
    assert [len(n.routes) for n in scene.neighbours] == [1, 3]


def test_description_is_plain_data(junction: Junction) -> None:
    scene = junction.thoughts(car("CAV1", "south-north", 80.0, 8.0), car("HDV1", "west-east", 80.0, 8.0)).scenes["CAV1"]
    assert json.loads(json.dumps(asdict(scene), allow_nan=False))["neighbours"][0]["id"] == "HDV1"
    assert scene.neighbour("HDV1") is scene.neighbours[0]
    assert scene.neighbour("CAV1") is None


def test_adjacent_lanes_are_left_and_right_of_one_that_runs_the_same_way() -> None:
    ids: tuple[LaneId, ...] = tuple(("a", "b", k) for k in range(3))
    lanes = tuple(Lane(name, Straight((0.0, 4.0 * name[2]), (200.0, 4.0 * name[2]))) for name in ids)
    routes = tuple(Route(f"lane{k}", (ids[k],), Turn.STRAIGHT, 0.0, 200.0) for k in range(3))
    road_map = RoadMap(Road("three lanes", lanes, routes))
    assert adjacent_lanes(road_map, ids[0]) == (ids[1],)
    assert adjacent_lanes(road_map, ids[1]) == (ids[0], ids[2])


def test_lane_at_finds_the_lane_of_a_place(junction: Junction) -> None:
    places = {-5.0: "o0", 0.0: "o0", 99.0: "o0", 101.0: "ir0", 121.0: "ir0", 123.0: "il2", 500.0: "il2"}
    for place, start in places.items():
        assert junction.road_map.lane_at("south-north", place)[0] == start


def test_a_body_covers_the_lanes_that_it_reaches_onto(highway: Junction) -> None:
    covers = {}
    for offset in (0.0, 0.3, 0.5, 2.0, 4.0):
        scene = highway.thoughts(car("CAV1", "lane-0", 300.0, 20.0, offset=offset)).scenes["CAV1"]
        covers[offset] = [route for route, _ in scene.covers]
        assert all(place == pytest.approx(300.0) for _, place in scene.covers)
    # Its side is 1 m from its centre, and the lane's edge 2 m from that of the lane; who leans over is seen early.
    assert covers == {0.0: [], 0.3: [], 0.5: ["lane-1"], 2.0: ["lane-1"], 4.0: ["lane-1"]}


def test_the_lane_change_that_the_route_asks_for(merge: Junction) -> None:
    def scene(route: str, place: float) -> SceneDescription:
        return merge.thoughts(car("CAV1", route, place, 15.0)).scenes["CAV1"]

    assert scene("main-1", 150.0).must_change is None
    early, late = scene("ramp", 150.0).must_change, scene("ramp", 250.0).must_change
    assert early is not None
    assert late is not None
    assert early.lane == late.lane == ("b", "c", 1)
    assert early.room - late.room == pytest.approx(100.0, abs=0.1)
    # The ramp lane is 330 m long and the taper 40 m; halfway through it the CAV must be changing.
    assert early.room == pytest.approx(330.0 - 20.0 - 150.0, abs=1.0)
    assert scene("ramp", 340.0).must_change is None


def test_roles_are_found_anew_from_another_lane(highway: Junction) -> None:
    thoughts = highway.thoughts(
        car("CAV1", "lane-1", 300.0, 20.0),
        car("CAV2", "lane-1", 320.0, 20.0),
        car("HDV1", "lane-0", 330.0, 20.0),
        car("HDV2", "lane-0", 280.0, 20.0),
    )
    scene = thoughts.scenes["CAV1"]
    assert roles(scene) == {"CAV2": Role.LEADING, "HDV1": Role.OTHER, "HDV2": Role.OTHER}
    found = with_roles(scene.neighbours, scene.ego, "lane-0", 300.0, highway.road_map)
    assert {n.id: (n.role, n.gap) for n in found} == {
        "CAV2": (Role.OTHER, None),
        "HDV1": (Role.LEADING, pytest.approx(25.0)),
        "HDV2": (Role.REARING, pytest.approx(15.0)),
    }
    assert with_roles(found, scene.ego, "lane-1", 300.0, highway.road_map) == scene.neighbours


@pytest.mark.parametrize("name", ["CAV2", "HDV2"])
def test_who_comes_onto_the_lane_where_ways_merge_is_behind_or_ahead(name: str, junction: Junction) -> None:
    # The ways merge at 119.5 m and 118.0 m; neither vehicle is on the way of the other one yet.
    ahead = junction.thoughts(car("CAV1", "south-north", 116.0, 5.0), car(name, "west-north", 105.0, 7.0))
    behind = junction.thoughts(car("CAV1", "west-north", 105.0, 7.0), car(name, "south-north", 116.0, 5.0))
    (follower,), (leader,) = ahead.scenes["CAV1"].neighbours, behind.scenes["CAV1"].neighbours
    assert (follower.role, leader.role) == (Role.REARING, Role.LEADING)
    assert follower.gap == pytest.approx(4.5, abs=0.5)
    assert leader.gap == pytest.approx(4.5, abs=0.5)


@pytest.mark.parametrize(
    ("ego", "other", "lane", "role", "gap"),
    [
        (("main-1", 235.0), ("ramp", 222.0), ("b", "c", 2), Role.REARING, 8.0),
        (("ramp", 235.0), ("main-1", 222.0), ("b", "c", 1), Role.REARING, 8.0),
        (("main-0", 225.0), ("main-1", 245.0), ("a", "b", 1), Role.LEADING, 15.0),
        (("main-1", 338.0), ("main-0", 325.0), ("c", "d", 0), Role.REARING, 8.0),
        (("main-1", 250.0), ("main-0", 260.0), ("b", "c", 0), Role.LEADING, 5.0),
    ],
    ids=["ramp behind", "main behind", "ahead on the next segment", "past the ramp", "same segment"],
)
def test_neighbours_on_a_lane_beside_are_seen_on_the_segments_before_and_after(
    ego: tuple[str, float], other: tuple[str, float], lane: LaneId, role: Role, gap: float, merge: Junction
) -> None:
    scene = merge.thoughts(car("CAV1", *ego, 15.0), car("HDV1", *other, 15.0)).scenes["CAV1"]
    (found,) = [b for b in scene.beside if b.lane == lane]
    assert (found.id, found.role, found.gap) == ("HDV1", role, pytest.approx(gap, abs=1.0))


def test_a_vehicle_on_another_lane_is_not_beside(merge: Junction) -> None:
    # On the ego's own lane, ahead; the ramp comes onto it there, but that is not the lane on the right.
    scene = merge.thoughts(car("CAV1", "main-1", 300.0, 15.0), car("HDV1", "main-1", 325.0, 15.0)).scenes["CAV1"]
    assert scene.beside == ()


@pytest.mark.parametrize("place", [100.0, 200.0, 250.0, 300.0])
def test_the_side_of_a_lane_change_is_that_of_the_lanes_between_which_it_is(place: float, merge: Junction) -> None:
    # On the first segments the ramp has lane 0, between the others it is lane 2 and leads onto lane 1.
    change = merge.thoughts(car("CAV1", "ramp", place, 15.0)).scenes["CAV1"].must_change
    assert change is not None
    assert (change.lane, change.action) == (("b", "c", 1), Action.LANE_LEFT)
