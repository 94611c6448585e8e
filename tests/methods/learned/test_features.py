"""Features of learned drivers: the same from every side, only what can be known, zeros where no vehicle is."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from worlds import Car, Junction, car

from codriving.datatypes.road import Straight
from codriving.datatypes.world import Kind, Start, WorldState
from codriving.methods.learned.features import Features, Observation
from codriving.methods.learned.layout import JUNCTION, LANES, SLOTS, family_of, feature_count, feature_names
from codriving.methods.learned.slots import EQUAL, GIVES_WAY, GOES_FIRST

FAR = 7.0
NEAR = 4.5

NEXT = {"south": "west", "west": "north", "north": "east", "east": "south"}
"""A quarter turn, clockwise."""

FAMILY = {"intersection": JUNCTION, "roundabout": JUNCTION, "highway": LANES, "merge": LANES}


def features(junction: Junction, shared: bool = True) -> Features:
    return Features(junction.road_map, junction.model, family_of(junction.road_map.road), shared)


def seen(junction: Junction, *cars: Car, shared: bool = True) -> dict[str, Observation]:
    return features(junction, shared).observe(junction.world(*cars))


def named(observation: Observation, family: str = JUNCTION) -> dict[str, float]:
    return dict(zip(feature_names(family), observation.tolist(), strict=True))


def turned(cars: tuple[Car, ...]) -> tuple[Car, ...]:
    return tuple(replace(c, route="-".join(NEXT[leg] for leg in c.route.split("-"))) for c in cars)


SOME = (
    car("CAV1", "south-north", 80.0, 8.0, 9.0),
    car("CAV2", "west-south", 85.0, 6.0, 3.0),
    car("CAV3", "south-west", 60.0, 7.0, 6.0),
    car("HDV1", "north-east", 78.0, 7.0, pedal=-1.0),
)


@pytest.mark.parametrize("shared", [True, False])
def test_a_quarter_turn_of_the_intersection_changes_nothing_but_the_right_of_way(
    junction: Junction, shared: bool
) -> None:
    cars, first = SOME, seen(junction, *SOME, shared=shared)
    ranks = [k for k, name in enumerate(feature_names(JUNCTION)) if name.endswith(".there")]
    for quarter in range(1, 4):
        cars = turned(cars)
        again = seen(junction, *cars, shared=shared)
        for name, observation in first.items():
            # One of the two roads has the right of way, so for those who mind it a half turn is needed.
            kept = np.delete(np.arange(len(observation)), ranks if shared and quarter % 2 else [])
            np.testing.assert_allclose(again[name][kept], observation[kept], atol=2e-3)


def test_who_goes_first_by_the_rules_of_the_road_is_known_to_those_who_share(junction: Junction) -> None:
    across, along = car("CAV1", "south-north", 85.0, 7.0), car("HDV1", "west-east", 85.0, 7.0)
    found = {}
    for one, other in ((across, along), (replace(along, id="CAV1"), replace(across, id="HDV1"))):
        found[one.route] = named(seen(junction, one, other)["CAV1"])["slot1.there"]
        assert named(seen(junction, one, other, shared=False)["CAV1"])["slot1.there"] == 1
    assert found == pytest.approx({"south-north": GIVES_WAY, "west-east": GOES_FIRST}), "east-west has the right of way"
    towards = car("HDV1", "north-west", 95.0, 7.0)
    assert named(seen(junction, across, towards)["CAV1"])["slot1.there"] == pytest.approx(EQUAL)


@pytest.mark.parametrize("shared", [True, False])
def test_where_a_human_driver_is_bound_is_not_seen(junction: Junction, shared: bool) -> None:
    ego = car("CAV1", "south-north", 85.0, 7.0)
    found = [
        seen(junction, ego, car("HDV1", route, 85.0, 7.0), shared=shared)["CAV1"].tobytes()
        for route in ("west-north", "west-east", "west-south")
    ]
    assert found[0] == found[1] == found[2]


@pytest.mark.parametrize("place", [95.0, 101.0, 106.0])
def test_lane_of_a_human_driver_is_not_seen(junction: Junction, place: float) -> None:
    """Inside the junction it would tell a left turn, whose rank is lower, before the vehicle is seen to turn."""
    world = junction.world(car("CAV1", "south-north", 85.0, 7.0), car("HDV1", "west-north", place, 7.0))
    once = features(junction).observe(world)["CAV1"]
    assert once[feature_names(JUNCTION).index("slot1.there")] > 0
    human = next(v for v in world.vehicles if v.id == "HDV1")
    for lane in junction.road_map.lanes:
        vehicles = tuple(replace(v, lane=lane) if v is human else v for v in world.vehicles)
        again = features(junction).observe(replace(world, vehicles=vehicles))["CAV1"]
        np.testing.assert_array_equal(again, once, err_msg=str(lane))


def test_drivers_bound_elsewhere_are_seen_alike_as_long_as_they_drive_alike(junction: Junction) -> None:
    found = []
    for route in ("west-north", "west-south"):
        starts = (
            Start("CAV1", Kind.CAV, "south-north", 60.0, 7.0),
            Start("HDV1", Kind.HDV, route, 60.0, 7.0),
        )
        environment, made = junction.drive(*starts), features(junction)
        worlds: list[WorldState] = [environment.reset(10_000)]
        for _ in range(4):
            worlds.append(environment.step(dict.fromkeys(worlds[-1].available, worlds[-1].available["CAV1"][1])))
        found.append([made.observe(world)["CAV1"].tobytes() for world in worlds])
    assert found[0] == found[1]


def test_a_partner_who_shares_its_route_is_seen_to_turn_away(junction: Junction) -> None:
    ego = car("CAV1", "south-north", 85.0, 7.0)
    across, away = (seen(junction, ego, car("CAV2", route, 85.0, 7.0))["CAV1"] for route in ("west-east", "west-south"))
    assert named(across)["slot1.crossing"] == 1
    assert named(away)["slot1.there"] == 0, "its route has no zone with this one"


def test_strangers_have_no_intent(junction: Junction) -> None:
    cars = (car("CAV1", "south-north", 85.0, 7.0), car("CAV2", "west-south", 85.0, 7.0, 3.0))
    alone = named(seen(junction, *cars, shared=False)["CAV1"])
    assert alone["slot1.there"] == 1, "its route is unknown, so it may cross"
    assert (alone["slot1.is_cav"], alone["slot1.target"]) == (0, 0)
    other = (cars[0], replace(cars[1], target=9.0, route="west-east", acceleration=2.0))
    assert (
        seen(junction, *other, shared=False)["CAV1"].tobytes() == seen(junction, *cars, shared=False)["CAV1"].tobytes()
    )


def test_strangers_out_of_range_are_not_seen(junction: Junction) -> None:
    cars = (
        car("CAV1", "south-north", 65.0, 7.0),
        car("CAV2", "north-south", 85.0, 7.0),
        car("HDV1", "west-east", 75.0, 7.0),
    )
    slots = slice(8, None)
    assert not seen(junction, *cars, shared=False)["CAV1"][slots].any()
    assert seen(junction, *cars)["CAV1"][slots].any(), "the other CAV sees the driver and says so"


def test_alone_on_the_road_all_slots_are_zero(junction: Junction) -> None:
    observation = seen(junction, car("CAV1", "south-west", 85.0, 4.5, 6.0))["CAV1"]
    assert observation.shape == (feature_count(JUNCTION),) == (8 + 9 * SLOTS,)
    assert not observation[8:].any()
    ego = named(observation)
    assert (ego["ego.speed"], ego["ego.left"], ego["ego.straight"], ego["ego.one"]) == (0.5, 1, 0, 1)
    assert ego["ego.target"] == pytest.approx(6 / 9)
    route = junction.road_map.routes["south-west"]
    assert ego["ego.to_entry"] == pytest.approx((route.entry - 85) / (FAR * 9), abs=1e-3)


def test_a_leader_is_seen_by_its_gap(junction: Junction) -> None:
    cars = (car("CAV1", "south-north", 50.0, 7.0), car("CAV2", "south-west", 65.0, 6.0, 9.0))
    both = seen(junction, *cars)
    front = named(both["CAV1"])
    assert front["slot1.same_path"] == front["slot1.is_cav"] == 1
    assert front["slot1.own_entry"] == front["slot1.other_entry"] == pytest.approx(10 / (NEAR * 9), abs=1e-3)
    assert not both["CAV2"][8:].any(), "who drives behind is no concern"


def test_a_human_driver_who_brakes_is_expected_to_be_slower(junction: Junction) -> None:
    ego = car("CAV1", "south-north", 85.0, 7.0)
    target = [
        named(seen(junction, ego, car("HDV1", "west-east", 85.0, 6.0, pedal=a))["CAV1"])["slot1.target"]
        for a in (0, -3)
    ]
    assert target == pytest.approx([6 / 9, 3 / 9])


def test_the_most_urgent_come_first_and_no_more_than_there_is_room_for(junction: Junction) -> None:
    cars = [car("CAV0", "south-north", 85.0, 8.0)]
    cars += [car(f"CAV{k}", "west-east", 95.0 - 9 * k, 8.0) for k in range(1, 7)]
    observation = named(seen(junction, *cars)["CAV0"])
    ways = [observation[f"slot{k}.other_entry"] * NEAR * 9 for k in range(1, SLOTS + 1)]
    apart = [abs(way - observation["slot1.own_entry"] * NEAR * 9) for way in ways]
    assert all(observation[f"slot{k}.there"] > 0 for k in range(1, SLOTS + 1))
    assert apart == sorted(apart)


@pytest.mark.parametrize("scenario", sorted(FAMILY))
@pytest.mark.parametrize("shared", [True, False])
def test_every_number_is_finite_and_within_bounds_all_along(
    scenario: str, shared: bool, configured: Callable[..., object], request: pytest.FixtureRequest
) -> None:
    name = "junction" if scenario == "intersection" else scenario
    road: Junction = request.getfixturevalue(name)
    assert family_of(road.road_map.road) == FAMILY[scenario]
    made, environment = features(road, shared), road.environment
    world = environment.reset(10_001)
    for _ in range(12):
        observed = made.observe(world)
        assert sorted(observed) == sorted(world.available)
        for observation in observed.values():
            assert observation.dtype == np.float32
            assert observation.shape == (feature_count(FAMILY[scenario]),)
            assert np.isfinite(observation).all()
            assert np.abs(observation).max() <= 1
        if environment.outcome is not None:
            break
        world = environment.step({cav: actions[1] for cav, actions in world.available.items()})


def test_lanes_tell_who_drives_beside(highway: Junction) -> None:
    cars = (
        car("CAV1", "lane-1", 200.0, 25.0),
        car("HDV1", "lane-0", 230.0, 20.0),
        car("HDV2", "lane-2", 197.0, 22.0),
        car("HDV3", "lane-1", 260.0, 22.0),
        car("HDV4", "lane-3", 210.0, 22.0),
    )
    found = named(seen(highway, *cars)["CAV1"], LANES)
    scale = NEAR * 30
    assert found["slot1.own_entry"] == pytest.approx(55 / scale)
    assert found["left_leader.gap"] == pytest.approx(25 / scale)
    assert found["left_leader.relative_speed"] == pytest.approx(-5 / 30)
    assert found["left_follower.there"] == found["right_leader.there"] == 0
    assert found["right_follower.gap"] == pytest.approx(-2 / scale), "beside counts as overlapping"
    assert (found["lane.left_allowed"], found["lane.right_allowed"]) == (1, 1)
    assert (found["lane.left_free"], found["lane.right_free"]) == (1, 0)
    assert found["lane.rear"] == 1
    assert found["lane.must_side"] == found["lane.must_room"] == 0


def test_a_ramp_asks_for_a_change_until_it_is_under_way(merge: Junction) -> None:
    place = merge.road_map.lane_start("ramp", ("b", "c", 2)) + 20
    _, _, ends = merge.road_map.changes.ahead("ramp", place) or ("", 0, 0.0)
    world = merge.world(car("CAV1", "ramp", place, 15.0), car("HDV1", "main-1", place - 10, 15.0))
    found = named(features(merge).observe(world)["CAV1"], LANES)
    assert found["lane.must_side"] == -1
    assert found["lane.must_room"] == pytest.approx((ends - place) / (FAR * 20))
    assert found["left_follower.gap"] == pytest.approx(5 / (NEAR * 20), abs=5e-3)
    assert found["slot1.there"] == 1, "the routes converge"
    steered = replace(world.intents["CAV1"], target_lane=("b", "c", 1))
    found = named(features(merge).observe(replace(world, intents={"CAV1": steered}))["CAV1"], LANES)
    assert found["lane.must_side"] == 0
    assert found["lane.offset"] == pytest.approx(1, abs=0.05)


def test_lanes_of_the_shipped_roads_are_straight_where_they_run_side_by_side(
    highway: Junction, merge: Junction
) -> None:
    for road in (highway, merge):
        sides = [lane for lane in road.road_map.road.lanes if (*lane.id[:2], 1) in road.road_map.lanes]
        assert sides
        assert all(isinstance(lane.shape, Straight) for lane in sides)
