"""A flow under way: vehicles come in where there is room, leave at their goal, and are removed where they collide."""

from dataclasses import replace

import numpy as np
import pytest
from streets import NARROW, Silent, Streets, configured, drive, environment, parallel
from thorough import some

from codriving.datatypes.flow import Flow
from codriving.datatypes.record import Ending
from codriving.datatypes.world import Action, Kind
from codriving.errors import ScenarioError

FLOW = Flow(arrivals=400.0, share=1.0, headway=2.0, warm_up=10.0, window=50.0)

LEGS = ("flow.warm_up=0", "flow.window=60")  # The intersection


def test_all_that_come_in_leave_at_their_goal_until_the_window_is_over() -> None:
    env = drive(environment(Streets(parallel(2)), replace(FLOW, share=0.0)))
    outcome, tracks = env.outcome, {track.id: track for track in env.trajectory().tracks}
    assert outcome is not None
    assert outcome.flow is not None
    assert (outcome.ending, outcome.time, outcome.flow.begins) == (Ending.COUNTED, 60.0, 10.0)
    assert len(outcome.arrivals) >= 3
    for name, arrived in outcome.arrivals.items():
        track = tracks[name]
        goal = {"r0": 190, "r1": 190, "near": 150}[track.route]
        assert track.x[-2] < goal <= track.x[-1], "gone with the step in which it is there"
        assert (track.first_step + len(track.x) - 1) * 0.1 == pytest.approx(arrived)
        assert track.arrived == arrived
    for arrival in outcome.flow.wanted:
        assert tracks[arrival.id].first_step * 0.1 == pytest.approx(arrival.time), "there is room for all"


def test_what_vehicles_do_changes_nothing_of_who_wants_to_come_in() -> None:
    fast, slow = (
        drive(environment(Streets(parallel(2)), FLOW), action).outcome for action in (Action.FASTER, Action.SLOWER)
    )
    assert fast is not None
    assert slow is not None
    assert fast.flow is not None
    assert slow.flow is not None
    assert fast.flow.wanted == slow.flow.wanted
    assert fast.arrivals != slow.arrivals


def test_where_all_stand_the_others_wait_outside() -> None:
    """They stop 12 m after they have come in; a newcomer at up to 9 m/s wants 2 + 7.2 + 10.1 m before it."""
    env = drive(environment(Streets(parallel(1)), FLOW), Action.SLOWER)
    outcome, tracks = env.outcome, env.trajectory().tracks
    assert outcome is not None
    assert outcome.flow is not None
    assert not outcome.arrivals
    assert len(tracks) == 1
    assert len(outcome.flow.wanted) > 3


@pytest.mark.parametrize("seed", some(2, range(10_000, 10_004)))
def test_a_newcomer_has_room_to_brake(seed: int) -> None:
    """Bumper to bumper 2 m, 0.8 s of driving, and the difference of the ways to stop at 4 m/s2."""
    env = drive(configured(*LEGS, "flow.arrivals=900", "flow.share=0.0"), seed=seed)
    tracks = env.trajectory().tracks
    met = 0
    for track in tracks:
        for other in tracks:
            row = track.first_step - other.first_step
            if other is track or other.route[:4] != track.route[:4] or not 0 <= row < len(other.x) - 1:
                continue
            gap = np.hypot(other.x[row] - track.x[0], other.y[row] - track.y[0]) - 5
            v, u = track.speed[0], other.speed[row]
            assert gap >= 2 + 0.8 * v + max(0, (v * v - u * u) / 8) - 1e-6
            met += 1
    assert met > 3


def test_both_vehicles_of_a_collision_are_removed_and_the_flow_goes_on() -> None:
    env = drive(environment(Streets(NARROW), FLOW))
    outcome, tracks = env.outcome, {track.id: track for track in env.trajectory().tracks}
    assert outcome is not None
    assert outcome.flow is not None
    collisions = outcome.flow.collisions
    assert len(collisions) >= 2
    assert outcome.collision is None
    for collision in collisions:
        assert collision.pair == "CAV-CAV"
        for name in (collision.striker, collision.struck):
            track = tracks[name]
            assert (track.first_step + len(track.x) - 1) * 0.1 == pytest.approx(collision.time)
            assert name not in outcome.arrivals
    hit = [name for collision in collisions for name in (collision.striker, collision.struck)]
    assert len(set(hit)) == len(hit), "each vehicle collides once"
    after = [track for track in tracks.values() if track.first_step * 0.1 > collisions[0].time]
    assert after, "others come in later"


def test_a_vehicle_beside_the_road_is_removed_and_named() -> None:
    env = environment(Streets(parallel(1)), FLOW)
    world = env.reset(10_000)
    while not world.cavs:
        world = env.step({})
    name = world.cavs[0].id
    env._traffic.vehicles[0].position[1] += 6
    world = env.step({cav.id: Action.IDLE for cav in world.cavs})
    assert name not in [cav.id for cav in world.cavs]
    while env.outcome is None:
        world = env.step({cav.id: Action.IDLE for cav in world.cavs})
    assert env.outcome.off_road == (name,)


@pytest.mark.parametrize("share", [0.0, 1.0])
def test_one_that_meets_none_drives_as_it_does_alone(share: float) -> None:
    """Every driver is the same one in the flow and alone, whoever came before."""
    env = drive(configured("flow.arrivals=20", f"flow.share={share}", "flow.window=300"), Action.FASTER)
    alone, tracks = env.alone(10_000), env.trajectory().tracks
    spans = {t.id: (t.first_step, t.first_step + len(t.x)) for t in tracks}
    by_itself = [
        t
        for t in tracks
        if t.arrived and not any(a < spans[t.id][1] and spans[t.id][0] < b for n, (a, b) in spans.items() if n != t.id)
    ]
    assert len(by_itself) >= 2
    assert [len(alone[track.id]) for track in by_itself] == [len(track.x) for track in by_itself]
    straight = [t for t in by_itself if t.route in ("south-north", "north-south", "west-east", "east-west")]
    assert straight
    for track in straight:
        steps = np.hypot(np.diff(track.x), np.diff(track.y))
        assert np.diff(alone[track.id]) == pytest.approx(steps, abs=1e-6)


def test_a_driver_does_not_depend_on_who_came_before() -> None:
    """Its exponent of acceleration is drawn as it comes in; with a third street others come in between."""
    seen: list[dict[str, float]] = []
    for number in (2, 3):
        env, drawn = environment(Streets(parallel(number)), replace(FLOW, share=0.0)), {}
        env.reset(10_000)
        while env.outcome is None:
            drawn.update({vehicle.id: vehicle.DELTA for vehicle in env._traffic.vehicles})
            env.step({})
        seen.append(drawn)
    two, three = seen
    assert len(two) > 5
    assert {name: three[name] for name in two} == two
    assert len(set(two.values())) == len(two)


@pytest.mark.parametrize(("scenario", "lanes"), [("intersection", 4), ("roundabout", 4), ("merge", 3), ("highway", 4)])
def test_all_four_roads_take_flows_on_each_lane_that_leads_in(scenario: str, lanes: int) -> None:
    env = drive(configured(*LEGS, f"scenario={scenario}", "flow.share=0.0"))
    tracks = env.trajectory().tracks
    assert {track.kind for track in tracks} == {Kind.HDV}
    assert {track.id[-1] for track in tracks} == set("abcd"[:lanes])


def test_a_scenario_that_does_not_say_how_vehicles_come_in_is_refused() -> None:
    with pytest.raises(
        ScenarioError,
        match=r"by hand takes no flows: its class has no method arrival\(\); change that, or leave flow out",
    ):
        environment(Silent(NARROW), FLOW)


def test_vehicles_come_in_on_the_ways_that_the_scenario_takes() -> None:
    env = drive(configured(*LEGS, "scenario.turns=[left]", "flow.share=0.0"))
    assert {track.route for track in env.trajectory().tracks} <= {
        "south-west",
        "west-north",
        "north-east",
        "east-south",
    }


@pytest.mark.parametrize("override", ["scenario.pattern=standoff", "scenario.blocked_exit=15"])
def test_what_says_how_an_episode_begins_is_refused(override: str) -> None:
    with pytest.raises(ScenarioError, match="intersection takes no flows: pattern=standoff and blocked_exit say how"):
        configured(override)


def test_the_time_limit_of_episodes_is_none_of_flows() -> None:
    """500 m at 6 m/s take 83 s, alone too."""
    env = configured("scenario.leg_length=500", "scenario.hdv_speed=[6,6]", "scenario.time_limit=5", "flow.share=0.0")
    alone = env.alone(10_000)
    assert len(alone) > 10
    assert all(places[-1] >= 510 for places in alone.values())
    assert max(len(places) for places in alone.values()) * 0.1 > 80
