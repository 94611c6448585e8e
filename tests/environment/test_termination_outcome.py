"""How episodes end: arrivals are latched, outcomes exact, drivers who hit each other towed away."""

from collections.abc import Callable

import pytest

from codriving.datatypes.record import Ending
from codriving.datatypes.road import Lane, Road, Route, Straight, Turn
from codriving.datatypes.world import Action, Kind, Start
from codriving.environment.environment import Environment

Build = Callable[..., Environment]
CAV, HDV = Kind.CAV, Kind.HDV

ROAD = Road(
    "two streets",
    (
        Lane(("a", "b", 0), Straight((0.0, 0.0), (200.0, 0.0))),
        Lane(("c", "d", 0), Straight((0.0, 2.2), (200.0, 2.2))),
        Lane(("e", "f", 0), Straight((200.0, -20.0), (0.0, -20.0))),
        Lane(("g", "h", 0), Straight((0.0, -20.0), (200.0, -20.0))),
    ),
    (
        Route("near", (("a", "b", 0),), Turn.STRAIGHT, entry=100.0, goal=120.0),
        Route("side", (("c", "d", 0),), Turn.STRAIGHT, entry=100.0, goal=120.0),
        Route("against", (("e", "f", 0),), Turn.STRAIGHT, entry=100.0, goal=190.0),
        Route("towards", (("g", "h", 0),), Turn.STRAIGHT, entry=100.0, goal=190.0),
    ),
)


def drive(env: Environment, action: Action = Action.IDLE) -> Environment:
    world = env.reset(0)
    while env.outcome is None:
        world = env.step({cav.id: action for cav in world.cavs})
    return env


def test_success_when_all_have_arrived_each_at_its_time(by_hand: Build) -> None:
    starts = [Start("CAV1", CAV, "near", 90.1, 6.0), Start("CAV2", CAV, "towards", 100.1, 9.0)]
    env = drive(by_hand(starts=starts, road=ROAD))
    outcome = env.outcome
    assert outcome is not None
    assert outcome.ending is Ending.SUCCESS
    assert outcome.arrivals == {"CAV1": 5.0, "CAV2": 10.0}
    assert outcome.time == 10.0
    assert outcome.collision is None
    assert {track.id: track.arrived for track in env.trajectory().tracks} == outcome.arrivals


def test_arrival_is_latched_and_the_vehicle_leaves_the_road(by_hand: Build) -> None:
    starts = [Start("CAV1", CAV, "near", 117.1, 6.0), Start("CAV2", CAV, "towards", 20.0, 9.0)]
    env = by_hand(starts=starts, road=ROAD, time_limit=5.0)
    world = env.reset(0)
    world = env.step(dict.fromkeys(("CAV1", "CAV2"), Action.IDLE))
    assert [cav.id for cav in world.cavs] == ["CAV2"]
    assert set(world.available) == set(world.intents) == {"CAV2"}
    assert env.outcome is None
    while env.outcome is None:
        env.step({"CAV2": Action.SLOWER})
    assert env.outcome.ending is Ending.TIMEOUT
    assert env.outcome.arrivals == {"CAV1": 0.5}


def test_rear_end_collision_ends_the_episode_at_once(by_hand: Build) -> None:
    starts = [Start("CAV1", CAV, "near", 60.0, 0.0), Start("CAV2", CAV, "near", 50.0, 9.0)]
    env = drive(by_hand(starts=starts, road=ROAD))
    outcome = env.outcome
    assert outcome is not None
    assert outcome.ending is Ending.COLLISION
    assert outcome.collision is not None
    assert (outcome.collision.striker, outcome.collision.struck) == ("CAV2", "CAV1")
    assert outcome.collision.pair == "CAV-CAV"
    assert outcome.time == outcome.collision.time == 0.6, "5 m to go at 9 m/s: in the sixth step of 0.1 s"
    assert len(env.trajectory().tracks[0].x) == 7


def test_side_impact_and_the_kinds_of_the_pair(by_hand: Build) -> None:
    # From the west across the way of who stands in the middle of the junction; a driver would have seen it coming.
    starts = [Start("HDV1", HDV, "south-north", 109.0, 0.1), Start("CAV1", CAV, "west-east", 85.0, 9.0)]
    outcome = drive(by_hand(starts=starts, drivers={"acceleration": 0.1})).outcome
    assert outcome is not None
    assert outcome.collision is not None
    assert (outcome.collision.striker, outcome.collision.struck) == ("CAV1", "HDV1")
    assert outcome.collision.pair == "CAV-HDV"


def test_head_on(by_hand: Build) -> None:
    starts = [Start("CAV1", CAV, "towards", 100.0, 9.0), Start("CAV2", CAV, "against", 60.0, 3.0)]
    outcome = drive(by_hand(starts=starts, road=ROAD)).outcome
    assert outcome is not None
    assert outcome.collision is not None
    assert (outcome.collision.striker, outcome.collision.struck) == ("CAV1", "CAV2")


def test_cars_that_pass_closely_do_not_collide(by_hand: Build) -> None:
    starts = [Start("CAV1", CAV, "near", 60.0, 0.0), Start("CAV2", CAV, "side", 50.0, 9.0)]
    env = by_hand(starts=starts, road=ROAD)
    env.reset(0)
    while env.outcome is None and env._world is not None and "CAV2" in env._world.available:
        env.step({"CAV1": Action.SLOWER, "CAV2": Action.IDLE})
    assert env.outcome is None


def test_who_crashes_at_its_goal_has_not_arrived(by_hand: Build) -> None:
    starts = [Start("CAV1", CAV, "near", 119.9, 3.0), Start("CAV2", CAV, "near", 114.9, 9.0)]
    outcome = drive(by_hand(starts=starts, road=ROAD)).outcome
    assert outcome is not None
    assert outcome.ending is Ending.COLLISION
    assert outcome.arrivals == {}


def test_drivers_who_hit_each_other_are_towed_away_and_counted_apart(by_hand: Build) -> None:
    starts = [
        Start("HDV1", HDV, "towards", 100.0, 9.0),
        Start("HDV2", HDV, "against", 94.0, 9.0),
        Start("CAV1", CAV, "near", 70.0, 9.0),
    ]
    env = drive(by_hand(starts=starts, road=ROAD))
    outcome = env.outcome
    assert outcome is not None
    assert outcome.ending is Ending.SUCCESS
    assert outcome.collision is None
    assert [(c.pair, {c.striker, c.struck}) for c in outcome.bystander_collisions] == [("HDV-HDV", {"HDV1", "HDV2"})]
    rows = {track.id: len(track.x) for track in env.trajectory().tracks}
    assert rows["HDV1"] == rows["HDV2"] < rows["CAV1"]


def test_time_runs_out(by_hand: Build) -> None:
    env = drive(by_hand(starts=[Start("CAV1", CAV, "near", 20.0, 0.0)], road=ROAD, time_limit=3.0), Action.SLOWER)
    assert env.outcome is not None
    assert env.outcome.ending is Ending.TIMEOUT
    assert env.outcome.time == 3.0


@pytest.mark.parametrize(("aside", "off_road"), [(3.9, False), (-4.1, True)])
def test_who_has_left_its_lane_by_half_a_lane_is_off_the_road(aside: float, off_road: bool, by_hand: Build) -> None:
    env = by_hand(starts=[Start("CAV1", CAV, "against", 60.0, 0.0)], road=ROAD)
    env.reset(0)
    env._traffic.vehicles[0].position[1] += aside
    env.step({"CAV1": Action.SLOWER})
    if off_road:
        assert env.outcome is not None
        assert (env.outcome.ending, env.outcome.off_road) == (Ending.OFF_ROAD, ("CAV1",))
    else:
        assert env.outcome is None


@pytest.mark.parametrize("off", [(), ("true_collisions",)])
def test_drivers_are_towed_away_either_way(off: tuple[str, ...], by_hand: Build) -> None:
    starts = [
        Start("HDV1", HDV, "towards", 100.0, 9.0),
        Start("HDV2", HDV, "against", 94.0, 9.0),
        Start("CAV1", CAV, "near", 70.0, 9.0),
    ]
    outcome = drive(by_hand(*off, starts=starts, road=ROAD)).outcome
    assert outcome is not None
    assert len(outcome.bystander_collisions) == 1
