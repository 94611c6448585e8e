"""Acceleration and steering instead of an action: which limits hold, and what the CAV no longer does by itself."""

from collections.abc import Callable
from math import atan, pi, sin, tan

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from codriving.datatypes.world import Action, ControlInput
from codriving.environment.cav import ConnectedVehicle
from codriving.environment.environment import Environment
from codriving.errors import EpisodeError

Build = Callable[..., Environment]

WORLDS = ["scenario=intersection", "scenario=roundabout", "scenario=highway", "scenario=merge"]

numbers = st.floats(-100, 100, allow_nan=False)


@pytest.fixture(scope="module")
def kept() -> dict[str, Environment]:
    return {}


@pytest.mark.parametrize("scenario", WORLDS)
@settings(max_examples=6, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(seed=st.integers(10_000, 10_050), drawn=st.lists(st.tuples(numbers, numbers), min_size=4, max_size=12))
def test_whatever_is_commanded_the_limits_hold(
    configured: Build, kept: dict[str, Environment], scenario: str, seed: int, drawn: list[tuple[float, float]]
) -> None:
    env = kept.setdefault(scenario, configured(scenario, "limits=road") if scenario not in kept else kept[scenario])
    world, top = env.reset(seed), env.driving_model.top_speed
    first = {cav.id: cav.speed for cav in world.cavs}
    for pair in drawn:
        if env.outcome is not None:
            break
        world = env.step({cav.id: ControlInput(*pair) for cav in world.cavs})
    for track in (track for track in env.trajectory().tracks if track.id in first):
        assert track.acceleration.min() >= -8.0
        assert track.acceleration.max() <= 4.0
        assert track.speed.min() >= 0.0
        assert track.speed.max() <= max(top, first[track.id]) + 1e-9
        rate = np.abs(np.diff(np.unwrap(track.heading))) / env.driving_model.step
        assert (rate * np.maximum(track.speed[:-1], track.speed[1:])).max(initial=0.0) <= 4.0 + 1e-9
        assert set(track.action) == {""}, "no action was taken"


def test_a_command_moves_it_as_the_bicycle_model_says(configured: Build) -> None:
    """By hand: v' = a, phi' = v / (l / 2) sin(beta), with beta = arctan(tan(delta) / 2) and 0.1 s a step."""
    env = configured("scenario=intersection", "scenario.hdvs=[0,0]", "scenario.cavs=2")
    world = env.reset(10_000)
    cav = world.cavs[0]
    world = env.step({"CAV1": ControlInput(-1.5, 0.02), "CAV2": ControlInput(0.0, 0.0)})
    after = world.cavs[0]
    assert after.speed == pytest.approx(cav.speed - 5 * 0.1 * 1.5)
    turned = sum((cav.speed - 0.15 * k) * 0.1 / 2.5 * sin(atan(tan(0.02) / 2)) for k in range(5))
    assert after.heading - cav.heading == pytest.approx(turned), "to the right is positive"
    assert world.intents["CAV1"].target_speed == after.speed
    assert world.cavs[1].speed == pytest.approx(world.intents["CAV2"].target_speed)
    assert world.cavs[1].heading == pytest.approx(env.trajectory().tracks[1].heading[0])


def test_it_drives_no_faster_than_the_highest_target_speed(configured: Build) -> None:
    env = configured("scenario=highway", "scenario.hdvs=[0,0]", "scenario.cavs=2", "limits=none")
    world, top = env.reset(10_000), env.driving_model.top_speed
    for _ in range(30):
        world = env.step({cav.id: ControlInput(5.0, 0.0) for cav in world.cavs})
    assert all(top - 0.1 < cav.speed <= top for cav in world.cavs)


def test_nothing_slows_it_down_for_a_bend_nor_keeps_it_on_its_lane(configured: Build) -> None:
    """With IDLE it slows down and follows the bend; a straight command goes off the road there."""
    env = configured("scenario=roundabout", "scenario.hdvs=[0,0]", "scenario.cavs=2")
    ends = []
    for decision in (Action.IDLE, ControlInput(0.0, 0.0)):
        world = env.reset(10_000)
        while env.outcome is None and world.time < 20:
            world = env.step(dict.fromkeys(world.available, decision))
        ends.append("" if env.outcome is None else str(env.outcome.ending))
    assert ends[0] in ("", "success")
    assert ends[1] == "off_road"


def test_by_the_wheel_it_gets_onto_the_lane_beside_and_its_route(configured: Build) -> None:
    env = configured("scenario=highway", "scenario.hdvs=[0,0]", "scenario.cavs=2")
    world = env.reset(10_000)
    cav = world.cavs[0]
    side = 1 if cav.lane[2] == 0 else -1
    for wheel in [0.02 * side] * 3 + [-0.02 * side] * 3:
        world = env.step({"CAV1": ControlInput(0.0, wheel), "CAV2": ControlInput(-1.0, 0.0)})
    assert world.cavs[0].lane[2] == cav.lane[2] + side
    assert world.intents["CAV1"].target_lane == world.cavs[0].lane
    assert world.cavs[0].lane in env.road_map.routes[world.intents["CAV1"].route].lanes
    assert world.intents["CAV1"].route != env.reset(10_000).intents["CAV1"].route


def test_actions_and_commands_take_turns(configured: Build) -> None:
    env = configured("scenario=intersection", "scenario.hdvs=[0,0]", "scenario.cavs=2", "environment.steady=true")
    world = env.reset(10_000)
    env.step(dict.fromkeys(world.available, ControlInput(-2.0, 0.0)))
    world = env.step({"CAV1": Action.HOLD, "CAV2": ControlInput(-2.0, 0.0)})
    held, slower = world.cavs
    world = env.step({"CAV1": Action.IDLE, "CAV2": Action.FASTER})
    assert world.cavs[0].speed == pytest.approx(held.speed)
    assert world.cavs[1].speed > slower.speed


@pytest.mark.parametrize("command", [ControlInput(float("nan"), 0.0), ControlInput(0.0, float("inf"))])
def test_what_is_no_number_is_refused(configured: Build, command: ControlInput) -> None:
    env = configured("scenario=intersection")
    world = env.reset(10_000)
    with pytest.raises(EpisodeError, match="the command of CAV1 must be finite numbers, got ControlInput"):
        env.step(dict.fromkeys(world.available, command))


def test_the_wheels_turn_by_sixty_degrees_at_most() -> None:
    assert pi / 3 == ConnectedVehicle.MAX_STEERING_ANGLE
