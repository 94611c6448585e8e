"""The end of a ramp: who changes in time, who waits there, and who runs into the block."""

from collections.abc import Callable
from dataclasses import replace

import pytest
from highway_env.road.road import Road as StockRoad

from codriving.datatypes.record import Ending
from codriving.datatypes.road import Block, Road
from codriving.datatypes.world import Action, Kind, Start
from codriving.environment.environment import Environment
from codriving.environment.traffic.human_driver import GAP, HumanDriver
from codriving.environment.traffic.route_following import RouteFollower

Build = Callable[..., Environment]
CAV, HDV = Kind.CAV, Kind.HDV
SPEEDS = (0.0, 5.0, 10.0, 15.0, 20.0)
ENDS = 330.0
"""Where the ramp lane ends, along it and along the main road [m]."""


@pytest.fixture(scope="module")
def merge(configured: Build) -> Road:
    lengths = ["before=150", "converge=80", "parallel=100", "after=200"]
    return configured("scenario=merge", "scenario.lanes=2", *(f"scenario.{v}" for v in lengths)).scenario.road


@pytest.fixture
def on_merge(by_hand: Build, merge: Road) -> Build:
    """Builds the merge with starts by hand."""

    def build(*off: str, starts: list[Start], road: Road | None = None, time_limit: float = 80.0) -> Environment:
        settings = {"target_speeds": SPEEDS, "time_limit": time_limit, "drivers": {"jam_distance": 7.0}}
        return by_hand(*off, starts=starts, road=road or merge, **settings)

    return build


def on_road(env: Environment) -> dict[str, RouteFollower]:
    return {vehicle.id: vehicle for vehicle in env._traffic.vehicles}


def test_a_cav_that_changes_in_time_arrives_on_the_main_road(on_merge: Build) -> None:
    env = on_merge(starts=[Start("CAV1", CAV, "ramp", 220.0, 15.0)])
    world = env.reset(0)
    while Action.LANE_LEFT not in world.available["CAV1"]:
        world = env.step({"CAV1": Action.IDLE})
    s = on_road(env)["CAV1"].s
    world = env.step({"CAV1": Action.LANE_LEFT})
    assert world.intents["CAV1"].route == "main-1"
    assert on_road(env)["CAV1"].s - s == pytest.approx(7.5, abs=1.5), "the ramp is a metre longer than the main road"
    while env.outcome is None:
        world = env.step({"CAV1": Action.IDLE})
    assert env.outcome.ending is Ending.SUCCESS
    track = env.trajectory().tracks[0]
    assert track.y[-1] == pytest.approx(4.0, abs=0.1)
    assert track.x[-1] == pytest.approx(410.0, abs=2.0)


def test_a_cav_that_does_nothing_runs_into_the_block(on_merge: Build) -> None:
    env = on_merge(starts=[Start("CAV1", CAV, "ramp", 220.0, 15.0)])
    env.reset(0)
    while env.outcome is None:
        env.step({"CAV1": Action.IDLE})
    collision = env.outcome.collision
    assert env.outcome.ending is Ending.COLLISION
    assert collision is not None
    assert (collision.striker, collision.struck, collision.pair) == ("CAV1", "block1", "CAV-block")
    track = env.trajectory().tracks[0]
    assert ENDS - 3.5 < track.x[-1] < ENDS - 3.5 + 1.6, "its front has just reached the block, which is 2 m long"


def test_a_block_is_struck_wherever_it_is_touched(on_merge: Build, merge: Road) -> None:
    long = replace(merge, name="long block", blocks=(Block((300.0, 8.0), length=90.0),))
    env = on_merge(starts=[Start("CAV1", CAV, "ramp", 235.0, 15.0)], road=long)
    env.reset(0)
    while env.outcome is None:
        env.step({"CAV1": Action.IDLE})
    assert env.outcome.collision is not None
    assert env.outcome.collision.pair == "CAV-block"
    assert env.trajectory().tracks[0].x[-1] < 255.0, "at its near end, 45 m from its middle"


def test_without_true_collisions_it_is_what_highway_env_declares(on_merge: Build) -> None:
    env = on_merge("true_collisions", starts=[Start("CAV1", CAV, "ramp", 220.0, 15.0)])
    env.reset(0)
    while env.outcome is None:
        env.step({"CAV1": Action.IDLE})
    assert env.outcome.collision is not None
    assert env.outcome.collision.pair == "CAV-block"


def test_a_driver_changes_before_the_end_while_the_main_road_is_free(on_merge: Build) -> None:
    starts = [Start("HDV1", HDV, "ramp", 100.0, 15.0), Start("CAV1", CAV, "main-0", 20.0, 0.0)]
    env = on_merge(starts=starts)
    world = env.reset(0)
    changed = []
    while "HDV1" in on_road(env) and env.outcome is None:
        driver = on_road(env)["HDV1"]
        if driver.route_path.route.id == "main-1":
            changed.append(float(driver.position[0]))
        world = env.step({cav.id: Action.SLOWER for cav in world.cavs})
    assert changed[0] < 290.0, "long before the lane ends"
    track = next(track for track in env.trajectory().tracks if track.id == "HDV1")
    assert track.speed.min() > 14.0, "it need not slow down"
    assert track.x[-1] > 500.0


def put_at_the_end(env: Environment, away: float, name: str = "HDV1") -> RouteFollower:
    """Move a vehicle to the ramp lane, some way before its end [m]."""
    vehicle = on_road(env)[name]
    vehicle.position[:], vehicle.heading = (ENDS - away, 8.0), 0.0
    vehicle.on_state_update()
    vehicle.target_lane_index = vehicle.lane_index
    assert vehicle.lane_index == ("b", "c", 2)
    return vehicle


def queue_beside_the_end() -> list[Start]:
    """Standing CAVs on the main lane, so near to each other that no vehicle fits between them."""
    return [Start(f"CAV{k + 1}", CAV, "main-1", ENDS + 20.0 - 7.0 * k, 0.0) for k in range(9)]


def test_a_driver_waits_at_the_end_and_then_starts_into_a_gap(on_merge: Build) -> None:
    env = on_merge(starts=[*queue_beside_the_end(), Start("HDV1", HDV, "ramp", 260.0, 14.0)])
    world = env.reset(0)
    for _ in range(60):
        world = env.step({cav.id: Action.SLOWER for cav in world.cavs})
    driver = on_road(env)["HDV1"]
    assert driver.speed < 0.1
    assert driver.lane_index[2] == 2
    assert ENDS - 8.0 < driver.position[0] < ENDS - 3.5
    while env.outcome is None and "HDV1" in on_road(env) and world.time < 75.0:
        world = env.step({cav.id: Action.FASTER if cav.x > 315.0 else Action.SLOWER for cav in world.cavs})
    track = next(track for track in env.trajectory().tracks if track.id == "HDV1")
    assert track.x[-1] > 500.0
    assert env.outcome is None


def test_it_waits_there_also_if_nothing_stands_at_the_end(on_merge: Build, merge: Road) -> None:
    bare = replace(merge, name="without a block", blocks=())
    env = on_merge(starts=[*queue_beside_the_end(), Start("HDV1", HDV, "ramp", 260.0, 14.0)], road=bare)
    world = env.reset(0)
    for _ in range(60):
        world = env.step({cav.id: Action.SLOWER for cav in world.cavs})
        assert on_road(env)["HDV1"].position[0] < ENDS - 2.5
    assert on_road(env)["HDV1"].speed < 0.1


@pytest.mark.parametrize("name", ["a ramp", "the ramp"])
def test_a_late_change_leads_to_the_main_road_whatever_the_ramp_is_called(
    name: str, on_merge: Build, merge: Road
) -> None:
    # Past the middle of the taper both routes count as being on the main lane.
    routes = tuple(replace(route, id=name) if route.id == "ramp" else route for route in merge.routes)
    env = on_merge(starts=[Start("CAV1", CAV, name, 285.0, 5.0)], road=replace(merge, name=name, routes=routes))
    env.reset(0)
    put_at_the_end(env, 12.0, "CAV1")
    on_road(env)["CAV1"].act(Action.LANE_LEFT)
    assert on_road(env)["CAV1"].route_path.route.id == "main-1"
    assert on_road(env)["CAV1"].offset == pytest.approx(4.0)


@pytest.mark.parametrize(("away", "starts"), [(GAP - 0.2, False), (GAP + 0.2, True)])
def test_who_stands_lets_those_pass_who_would_be_there_within_the_gap(
    away: float, starts: bool, on_merge: Build
) -> None:
    # At 3.3 m/s they could still brake softly, which is all that MOBIL asks; but they would rather speed up.
    speed = 3.3
    comes = Start("HDV2", HDV, "main-1", ENDS - 6.0 - 5.0 - speed * away, speed)
    waits = Start("HDV1", HDV, "ramp", 300.0, 0.0)
    env = on_merge(starts=[waits, comes, Start("CAV1", CAV, "main-0", 20.0, 0.0)])
    env.reset(0)
    driver = put_at_the_end(env, 6.0)
    assert isinstance(driver, HumanDriver)
    assert driver.mobil(("b", "c", 1))
    driver.change_lane_policy()
    assert (driver.target_lane_index == ("b", "c", 1)) == starts


def test_a_driver_who_runs_into_the_block_is_towed_away(on_merge: Build) -> None:
    env = on_merge(starts=[*queue_beside_the_end(), Start("HDV1", HDV, "ramp", 300.0, 18.0)])
    world = env.reset(0)
    put_at_the_end(env, 8.0)
    for _ in range(2):
        world = env.step({cav.id: Action.SLOWER for cav in world.cavs})
    assert "HDV1" not in on_road(env)
    assert env.outcome is None
    (collision,) = env._termination._bystanders
    assert (collision.striker, collision.struck, collision.pair) == ("HDV1", "block1", "HDV-block")


@pytest.mark.parametrize("off", [(), ("connected_lanes",)], ids=["corrected", "fault"])
def test_neighbours_are_found_where_the_ramp_lane_goes_on(off: tuple[str, ...], on_merge: Build) -> None:
    starts = [
        Start("HDV1", HDV, "ramp", 215.0, 12.0),
        Start("CAV1", CAV, "ramp", 245.0, 12.0),
        Start("CAV2", CAV, "main-0", 240.0, 12.0),
        Start("CAV3", CAV, "ramp", 190.0, 12.0),
        Start("HDV2", HDV, "main-1", 220.0, 12.0),
        Start("CAV4", CAV, "main-1", 255.0, 12.0),
        Start("CAV5", CAV, "main-0", 235.0, 12.0),
    ]
    env = on_merge(*off, starts=starts)
    env.reset(0)
    road = on_road(env)
    found = {name: [v and v.id for v in env._traffic.neighbour_vehicles(road[name])] for name in ("HDV1", "HDV2")}
    if not off:
        assert found == {"HDV1": ["CAV1", "CAV3"], "HDV2": ["CAV4", None]}
        return
    assert found == {"HDV1": [None, "CAV3"], "HDV2": [None, None]}, "no vehicle past the end of the lane"
    # What highway-env offers against it goes by the number of the lane: the ramp goes on as the leftmost main lane.
    env._traffic.neighbour_vehicles_connected_lanes = True
    assert StockRoad.neighbour_vehicles(env._traffic, road["HDV1"])[0].id == "CAV5"
