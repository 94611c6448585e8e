"""CAVs that change lanes: which changes are offered, and that the route goes along to the new lane."""

from collections.abc import Callable

import pytest

from codriving.datatypes.record import Ending
from codriving.datatypes.road import Road
from codriving.datatypes.world import Action, Kind, Start
from codriving.environment.environment import Environment

Build = Callable[..., Environment]
CAV = Kind.CAV
FAST = tuple(5.0 * k for k in range(7))


@pytest.fixture(scope="module")
def highway(configured: Build) -> Road:
    return configured("scenario=highway", "scenario.lanes=4", "scenario.finish=750").scenario.road


@pytest.fixture(scope="module")
def merge(configured: Build) -> Road:
    lengths = ["before=150", "converge=80", "parallel=100", "after=200"]
    return configured("scenario=merge", "scenario.lanes=2", *(f"scenario.{v}" for v in lengths)).scenario.road


def test_who_changes_lanes_takes_the_route_along_the_new_one(by_hand: Build, highway: Road) -> None:
    env = by_hand(starts=[Start("CAV1", CAV, "lane-1", 100.0, 20.0)], road=highway, target_speeds=FAST)
    world = env.reset(0)
    assert world.intents["CAV1"].route == "lane-1"
    before = env._traffic.vehicles[0].s
    world = env.step({"CAV1": Action.LANE_LEFT})
    assert world.intents["CAV1"].route == "lane-0"
    assert world.intents["CAV1"].target_lane == ("begin", "end", 0)
    vehicle = env._traffic.vehicles[0]
    assert vehicle.s - before == pytest.approx(10.0, abs=0.3), "half a second at 20 m/s, and no jump"
    assert vehicle.s == pytest.approx(world.cavs[0].x, abs=1e-6)
    for _ in range(8):
        assert vehicle.offset == pytest.approx(world.cavs[0].y, abs=1e-6), "counted from the new lane's centre"
        world = env.step({"CAV1": Action.IDLE})
    assert world.cavs[0].y == pytest.approx(0.0, abs=0.1)
    assert world.cavs[0].lane == ("begin", "end", 0)


def test_it_arrives_at_the_goal_of_the_new_route(by_hand: Build, highway: Road) -> None:
    env = by_hand(starts=[Start("CAV1", CAV, "lane-3", 690.0, 25.0)], road=highway, target_speeds=FAST)
    env.reset(0)
    env.step({"CAV1": Action.LANE_LEFT})
    while env.outcome is None:
        env.step({"CAV1": Action.IDLE})
    assert env.outcome.ending is Ending.SUCCESS
    # It drives a little aslant, so it is a step later than straight on.
    assert env.outcome.arrivals["CAV1"] == pytest.approx(2.4, abs=0.11)


def test_a_change_can_be_taken_back(by_hand: Build, highway: Road) -> None:
    env = by_hand(starts=[Start("CAV1", CAV, "lane-2", 100.0, 20.0)], road=highway, target_speeds=FAST)
    env.reset(0)
    assert env.step({"CAV1": Action.LANE_RIGHT}).intents["CAV1"].route == "lane-3"
    world = env.step({"CAV1": Action.LANE_LEFT})
    assert world.intents["CAV1"].route == "lane-2"
    for _ in range(8):
        world = env.step({"CAV1": Action.IDLE})
    assert world.cavs[0].y == pytest.approx(8.0, abs=0.1)


def test_without_the_correction_the_route_stays_what_it_was(by_hand: Build, highway: Road) -> None:
    starts = [Start("CAV1", CAV, "lane-1", 100.0, 20.0)]
    env = by_hand("route_lane", starts=starts, road=highway, target_speeds=FAST)
    env.reset(0)
    assert env.step({"CAV1": Action.LANE_LEFT}).intents["CAV1"].route == "lane-1"


@pytest.mark.parametrize(
    ("route", "place", "left", "right"),
    [
        ("main-0", 50.0, False, True),
        ("main-1", 50.0, True, False),
        ("main-1", 250.0, True, False),  # beside the ramp, onto which no vehicle may change
        ("main-1", 400.0, True, False),
        ("ramp", 50.0, False, False),
        ("ramp", 200.0, False, False),  # still coming closer
        ("ramp", 250.0, True, False),
        ("ramp", 320.0, True, False),  # on the taper: its way leads over, but it is free to decide when
    ],
)
def test_changes_are_offered_where_there_is_a_lane_that_may_be_used(
    route: str, place: float, left: bool, right: bool, by_hand: Build, merge: Road
) -> None:
    env = by_hand(starts=[Start("CAV1", CAV, route, place, 15.0)], road=merge, target_speeds=FAST[:5])
    offered = env.reset(0).available["CAV1"]
    assert (Action.LANE_LEFT in offered) == left
    assert (Action.LANE_RIGHT in offered) == right
    assert {Action.SLOWER, Action.IDLE, Action.FASTER} <= set(offered)


def test_no_vehicle_changes_lanes_while_standing(by_hand: Build, highway: Road) -> None:
    env = by_hand(starts=[Start("CAV1", CAV, "lane-1", 100.0, 0.0)], road=highway, target_speeds=FAST)
    assert set(env.reset(0).available["CAV1"]) == {Action.SLOWER, Action.IDLE, Action.FASTER}


@pytest.mark.parametrize(
    ("speed", "action", "target"),
    [(22.0, Action.FASTER, 25.0), (23.0, Action.SLOWER, 20.0), (30.0, Action.FASTER, 30.0)],
)
def test_target_speeds_are_those_of_the_scenario(
    speed: float, action: Action, target: float, by_hand: Build, highway: Road
) -> None:
    env = by_hand(starts=[Start("CAV1", CAV, "lane-1", 100.0, speed)], road=highway, target_speeds=FAST)
    env.reset(0)
    assert env.step({"CAV1": action}).intents["CAV1"].target_speed == target


@pytest.mark.parametrize(("y", "off_road"), [(15.9, False), (16.2, True), (10.0, False), (-4.2, True)])
def test_only_beside_all_lanes_is_off_the_road(y: float, off_road: bool, by_hand: Build, highway: Road) -> None:
    env = by_hand(starts=[Start("CAV1", CAV, "lane-3", 100.0, 0.0)], road=highway, target_speeds=FAST)
    env.reset(0)
    env._traffic.vehicles[0].position[1] = y
    env.step({"CAV1": Action.SLOWER})
    assert (env.outcome is not None) == off_road
    if env.outcome is not None:
        assert (env.outcome.ending, env.outcome.off_road) == (Ending.OFF_ROAD, ("CAV1",))


def test_between_two_lanes_no_vehicle_is_off_the_road(by_hand: Build, highway: Road) -> None:
    starts = [Start("CAV1", CAV, "lane-0", 100.0, 10.0)]
    env = by_hand(starts=starts, road=highway, target_speeds=FAST, time_limit=20.0)
    env.reset(0)
    for action in [Action.LANE_RIGHT] * 3 + [Action.LANE_LEFT] * 3 + [Action.IDLE] * 6:
        world = env.step({"CAV1": action})
    assert env.outcome is None
    assert world.intents["CAV1"].route == "lane-0"
