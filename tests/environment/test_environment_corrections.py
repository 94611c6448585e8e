"""Each fault of highway-env at the junction: there with its switch off, gone with it on."""

from collections.abc import Callable

import pytest
from highway_env.vehicle.behavior import IDMVehicle
from highway_env.vehicle.controller import ControlledVehicle, MDPVehicle
from highway_env.vehicle.kinematics import Vehicle

from codriving.datatypes.record import Ending
from codriving.datatypes.road import Lane, Road, Route, Straight, Turn
from codriving.datatypes.world import Action, Kind, Start
from codriving.environment.environment import Environment
from codriving.environment.traffic.human_driver import HumanDriver
from codriving.environment.traffic.route_following import RouteFollower

Build = Callable[..., Environment]
CAV, HDV = Kind.CAV, Kind.HDV

STREET = Road(
    "street",
    (Lane(("a", "b", 0), Straight((0.0, 0.0), (200.0, 0.0))),),
    (Route("along", (("a", "b", 0),), Turn.STRAIGHT, entry=100.0, goal=190.0),),
)
PLUS = Road(
    "plus",
    (
        Lane(("w", "e", 0), Straight((-50.0, 0.0), (50.0, 0.0))),
        Lane(("n", "s", 0), Straight((0.0, -50.0), (0.0, 50.0))),
    ),
    (
        Route("east", (("w", "e", 0),), Turn.STRAIGHT, entry=45.0, goal=80.0),
        Route("south", (("n", "s", 0),), Turn.STRAIGHT, entry=45.0, goal=80.0),
    ),
)


def drive(env: Environment, decisions: int, action: Action = Action.IDLE) -> Environment:
    """Let every CAV repeat one action."""
    world = env.reset(0)
    for _ in range(decisions):
        if env.outcome is not None:
            break
        world = env.step({cav.id: action for cav in world.cavs})
    return env


def on_road(env: Environment) -> dict[str, RouteFollower]:
    return {vehicle.id: vehicle for vehicle in env._traffic.vehicles}


def test_drivers_never_roll_backwards(by_hand: Build) -> None:
    starts = [Start("CAV1", CAV, "along", 57.5, 0.0), Start("HDV1", HDV, "along", 50.0, 1.0)]
    slowest = {}
    for off in ((), ("no_reverse",)):
        env = drive(by_hand(*off, starts=starts, road=STREET), 8, Action.SLOWER)
        slowest[off] = min(track.speed.min() for track in env.trajectory().tracks)
    assert slowest[()] == 0.0
    assert slowest["no_reverse",] < -0.5


def test_drivers_do_not_yield_to_ghosts(by_hand: Build) -> None:
    # In the last 2.5 m of a lane, highway-env takes the arc length of 98.5 m for one on the next lane.
    starts = [
        Start("HDV1", HDV, "south-north", 98.5, 5.0),
        Start("CAV1", CAV, "south-north", 201.0, 5.0),
    ]
    sees = {}
    for off in ((), ("route_prediction",)):
        env = by_hand(*off, starts=starts)
        env.reset(0)
        driver, far = on_road(env)["HDV1"], on_road(env)["CAV1"]
        driver.act()
        sees[off] = env._traffic.is_conflict_possible(driver, far)
    assert sees == {(): False, ("route_prediction",): True}


def test_a_real_conflict_is_seen(by_hand: Build) -> None:
    starts = [Start("HDV1", HDV, "south-north", 90.0, 8.0), Start("CAV1", CAV, "west-east", 90.0, 8.0)]
    for off in ((), ("route_prediction",)):
        env = by_hand(*off, starts=starts)
        env.reset(0)
        assert env._traffic.is_conflict_possible(*on_road(env).values())


def test_drivers_see_who_stands_across_their_way(by_hand: Build) -> None:
    # The middle of the other car is off the lane, where highway-env looks; its nose is not.
    starts = [Start("CAV1", CAV, "south", 46.7, 0.0), Start("HDV1", HDV, "east", 0.0, 9.0)]
    seen = drive(by_hand(starts=starts, road=PLUS), 20, Action.SLOWER)
    blind = drive(by_hand("route_leader", starts=starts, road=PLUS), 20, Action.SLOWER)
    assert seen.outcome is None
    assert on_road(seen)["HDV1"].speed < 0.5
    assert blind.outcome is not None
    assert blind.outcome.collision is not None
    assert blind.outcome.collision.striker == "HDV1"


def test_drivers_see_past_the_end_of_their_lane(by_hand: Build) -> None:
    starts = [Start("CAV1", CAV, "south-north", 107.0, 0.0), Start("HDV1", HDV, "south-north", 60.0, 9.0)]
    seen = drive(by_hand(starts=starts), 20, Action.SLOWER)
    blind = drive(by_hand("route_leader", "connected_lanes", starts=starts), 20, Action.SLOWER)
    assert seen.outcome is None
    assert on_road(seen)["HDV1"].speed < 0.5
    assert blind.outcome is not None
    assert blind.outcome.ending is Ending.COLLISION


def test_drivers_do_not_stop_for_cars_on_other_roads(by_hand: Build) -> None:
    # Who turns right passes behind the one who waits to turn left, whose lane begins at the same place.
    starts = [Start("CAV1", CAV, "south-west", 112.0, 0.0), Start("HDV1", HDV, "south-east", 80.0, 6.0)]
    env = drive(by_hand(starts=starts), 20, Action.SLOWER)
    assert env.outcome is None
    assert on_road(env)["HDV1"].s > 120.0


def test_vehicles_are_on_the_lane_of_their_own_route(by_hand: Build) -> None:
    starts = [Start("CAV1", CAV, "south-north", 103.0, 0.0)]
    lanes = {}
    for off in ((), ("route_lane",)):
        env = by_hand(*off, starts=starts)
        env.reset(0)
        vehicle = on_road(env)["CAV1"]
        # A little off its line, where the right turn has just begun to leave the way straight on.
        vehicle.position[0] += 0.5
        vehicle.on_state_update()
        lanes[off] = vehicle.lane_index
    assert lanes[()] == ("ir0", "il2", 0)
    assert lanes["route_lane",] == ("ir0", "il3", 0)


def test_no_vehicle_is_frozen_inside_the_junction(by_hand: Build) -> None:
    starts = [Start("HDV1", HDV, "south-north", 101.0, 4.0), Start("CAV1", CAV, "west-east", 97.0, 6.0)]
    for off, target in (((), 4.0), (("yield_at_entry",), 0.0)):
        env = by_hand(*off, starts=starts)
        env.reset(0)
        driver = on_road(env)["HDV1"]
        env._traffic.enforce_road_rules()
        assert driver.target_speed == target
        assert getattr(driver, "waits_at", None) is None


def test_drivers_wait_before_the_junction(by_hand: Build) -> None:
    # Both would be in the middle at the same time; from the south one yields to those from the west.
    starts = [Start("CAV1", CAV, "west-east", 60.0, 6.0), Start("HDV1", HDV, "south-north", 60.0, 6.0)]
    env = by_hand(starts=starts)
    world = env.reset(0)
    told, first = [], []
    while env.outcome is None:
        road = on_road(env)
        if road["HDV1"].waits_at == road["HDV1"].route_path.route.entry:
            told.append(road["HDV1"].s)
        if road["HDV1"].s > 104.0 and not first:
            first.append(road["CAV1"].s)
        world = env.step({cav.id: Action.IDLE for cav in world.cavs})
    assert env.outcome.ending is Ending.SUCCESS
    assert told
    assert max(told) < 100.0
    assert first, "it went on in the end"
    assert first[0] > 113.0, "after the other one"


@pytest.mark.usefixtures("clean_class")
def test_parameters_belong_to_the_driver(by_hand: Build) -> None:
    starts = [Start("CAV1", CAV, "west-east", 20.0, 5.0), Start("HDV1", HDV, "south-north", 30.0, 6.0)]
    kept = {}
    for off in ((), ("own_parameters",)):
        first = by_hand(*off, starts=starts, drivers={"jam_distance": 7.0})
        first.reset(0)
        by_hand(*off, starts=starts, drivers={"jam_distance": 20.0}).reset(0)
        kept[off] = on_road(first)["HDV1"].DISTANCE_WANTED
    assert kept == {(): 7.0, ("own_parameters",): 20.0}


def test_classes_stay_as_they_are(intersection: Build) -> None:
    classes = (Vehicle, ControlledVehicle, MDPVehicle, IDMVehicle, HumanDriver)
    before = [dict(vars(c)) for c in classes]
    env = intersection(drivers={"jam_distance": 6.0, "headway": 0.7})
    world = env.reset(1)
    for _ in range(4):
        world = env.step({cav.id: Action.SLOWER for cav in world.cavs})
    assert [dict(vars(c)) for c in classes] == before


def test_who_reaches_the_end_of_the_road_leaves_it(by_hand: Build) -> None:
    starts = [Start("HDV1", HDV, "along", 160.0, 9.0), Start("CAV1", CAV, "along", 20.0, 0.0)]
    farthest = {}
    for off in ((), ("remove_at_sink",)):
        env = drive(by_hand(*off, starts=starts, road=STREET), 16, Action.SLOWER)
        farthest[off] = {track.id: track.x.max() for track in env.trajectory().tracks}["HDV1"]
        assert ("HDV1" in on_road(env)) == bool(off)
    assert 192.0 <= farthest[()] < 193.0, "8 m before the end, plus a step"
    assert farthest["remove_at_sink",] > 210.0


def test_a_near_miss_is_no_collision(by_hand: Build) -> None:
    # The one clears the other's lane just in time: highway-env extends both boxes by the motion of the next step.
    starts = [Start("CAV1", CAV, "east", 50.0 - 4.0 - 2.7, 9.0), Start("CAV2", CAV, "south", 50.0 + 3.2 - 2.7, 9.0)]
    exact = drive(by_hand(starts=starts, road=PLUS), 30)
    stock = drive(by_hand("true_collisions", starts=starts, road=PLUS), 30)
    assert exact.outcome is not None
    assert exact.outcome.ending is Ending.SUCCESS
    assert stock.outcome is not None
    assert stock.outcome.ending is Ending.COLLISION


def test_a_collision_does_not_push_the_cars_apart(by_hand: Build) -> None:
    starts = [Start("CAV1", CAV, "along", 60.0, 0.0), Start("CAV2", CAV, "along", 50.0, 9.0)]
    for off, moved in (((), False), (("true_collisions",), True)):
        env = drive(by_hand(*off, starts=starts, road=STREET), 10)
        assert env.outcome is not None
        assert env.outcome.ending is Ending.COLLISION
        env._traffic.step(0.1)
        assert (on_road(env)["CAV1"].position[0] != 60.0) == moved
