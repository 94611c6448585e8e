"""The faults that show only where there are several lanes: neighbours past a lane end, and the end of a ramp."""

from collections.abc import Callable

import pytest
from highway_env.road.road import Road as StockRoad
from highway_env.vehicle.objects import Obstacle

from codriving.datatypes.road import Lane, LaneId, Road, Route, Straight, Turn
from codriving.datatypes.world import Action, Kind, Start
from codriving.environment.environment import Environment
from codriving.environment.traffic.route_following import RouteFollower

Build = Callable[..., Environment]


def _lane(start: str, end: str, index: int, x0: float, x1: float, y: float) -> Lane:
    return Lane((start, end, index), Straight((x0, y), (x1, y)), speed_limit=20.0)


def _route(name: str, *lanes: LaneId, goal: float) -> Route:
    return Route(name, lanes, Turn.STRAIGHT, entry=goal, goal=goal)


# Past node b a lane is added on the left, so that the number of every lane shifts by one.
SHIFTED = Road(
    "shifted",
    (
        _lane("a", "b", 0, 0.0, 100.0, 0.0),
        _lane("a", "b", 1, 0.0, 100.0, 4.0),
        _lane("b", "c", 0, 100.0, 200.0, -4.0),
        _lane("b", "c", 1, 100.0, 200.0, 0.0),
        _lane("b", "c", 2, 100.0, 200.0, 4.0),
    ),
    (
        _route("middle", ("a", "b", 0), ("b", "c", 1), goal=180.0),
        _route("right", ("a", "b", 1), ("b", "c", 2), goal=180.0),
        _route("added", ("b", "c", 0), goal=80.0),
    ),
)

# The right lane ends at 120 m, where an obstacle stands.
RAMP = Road(
    "ramp",
    (_lane("a", "b", 0, 0.0, 300.0, 0.0), _lane("a", "b", 1, 0.0, 300.0, 4.0)),
    (_route("main", ("a", "b", 0), goal=280.0), _route("ramp", ("a", "b", 1), goal=280.0)),
)


def on_road(env: Environment) -> dict[str, RouteFollower]:
    return {vehicle.id: vehicle for vehicle in env._traffic.vehicles}


def test_neighbours_are_on_the_lane_that_really_goes_on(by_hand: Build) -> None:
    starts = [
        Start("HDV1", Kind.HDV, "middle", 90.0, 10.0),
        Start("CAV1", Kind.CAV, "added", 5.0, 9.0),
        Start("CAV2", Kind.CAV, "middle", 120.0, 9.0),
        Start("CAV3", Kind.CAV, "right", 110.0, 9.0),
        Start("HDV2", Kind.HDV, "middle", 60.0, 10.0),
    ]
    found = {}
    for off in ((), ("connected_lanes",)):
        env = by_hand(*off, starts=starts, road=SHIFTED)
        env.reset(0)
        road = on_road(env)
        found[off] = env._traffic.neighbour_vehicles(road["HDV1"])
        if off:
            # What highway-env offers against it follows the number of the lane, which is another lane here.
            env._traffic.neighbour_vehicles_connected_lanes = True
            assert StockRoad.neighbour_vehicles(env._traffic, road["HDV1"])[0].id == "CAV1"
    assert [v and v.id for v in found[()]] == ["CAV2", "HDV2"]
    assert [v and v.id for v in found["connected_lanes",]] == [None, "HDV2"]


def test_neighbours_behind_are_found_past_a_lane_end_too(by_hand: Build) -> None:
    starts = [Start("CAV1", Kind.CAV, "right", 110.0, 9.0), Start("CAV2", Kind.CAV, "right", 80.0, 9.0)]
    env = by_hand(starts=starts, road=SHIFTED)
    env.reset(0)
    ahead, behind = env._traffic.neighbour_vehicles(on_road(env)["CAV1"])
    assert ahead is None
    assert behind is on_road(env)["CAV2"]


@pytest.mark.parametrize("off", [(), ("start_into_gap",)], ids=["corrected", "fault"])
def test_driver_at_the_end_of_a_ramp_starts_into_a_gap(off: tuple[str, ...], by_hand: Build) -> None:
    # A queue on the main lane keeps the driver on the ramp until it stands at its end; then the queue drives off.
    queue = [Start(f"CAV{k + 1}", Kind.CAV, "main", 130.0 - 8.0 * k, 0.0) for k in range(9)]
    starts = [*queue, Start("HDV1", Kind.HDV, "ramp", 70.0, 9.0)]
    env = by_hand(*off, starts=starts, road=RAMP, time_limit=60.0)
    world = env.reset(0)
    env._traffic.objects.append(Obstacle(env._traffic, [120.0, 4.0]))
    for _ in range(40):
        world = env.step({cav.id: Action.SLOWER for cav in world.cavs})
    driver = on_road(env)["HDV1"]
    assert driver.speed < 0.1, "it stands at the end of the ramp"
    assert driver.lane_index[2] == 1
    while env.outcome is None and world.time < 59:
        action = {cav.id: Action.FASTER if cav.x > 105 else Action.SLOWER for cav in world.cavs}
        world = env.step(action)
    assert env.outcome is None, "the last cars of the queue wait, no vehicle crashed"
    track = next(track for track in env.trajectory().tracks if track.id == "HDV1")
    assert (track.x[-1] > 250.0) == (not off)
    assert (abs(track.y).min() < 0.5) == (not off)


def test_drivers_overtake_on_a_road_with_two_lanes(by_hand: Build) -> None:
    starts = [Start("CAV1", Kind.CAV, "main", 80.0, 3.0), Start("HDV1", Kind.HDV, "main", 40.0, 10.0)]
    env = by_hand(starts=starts, road=RAMP)
    world = env.reset(0)
    for _ in range(20):
        world = env.step({cav.id: Action.IDLE for cav in world.cavs})
    driver = next(vehicle for vehicle in world.vehicles if vehicle.id == "HDV1")
    assert driver.lane == ("a", "b", 1)
    assert driver.x > world.cavs[0].x


def test_cav_that_changed_lanes_keeps_the_new_one(by_hand: Build) -> None:
    env = by_hand(starts=[Start("CAV1", Kind.CAV, "right", 60.0, 9.0)], road=SHIFTED)
    world = env.reset(0)
    assert Action.LANE_RIGHT not in world.available["CAV1"]
    world = env.step({"CAV1": Action.LANE_LEFT})
    assert world.intents["CAV1"].target_lane == ("a", "b", 0)
    assert type(world.intents["CAV1"].target_lane[2]) is int
    for _ in range(10):
        world = env.step({"CAV1": Action.IDLE})
    assert world.cavs[0].lane == ("b", "c", 1)
    assert abs(world.cavs[0].y) < 0.2
