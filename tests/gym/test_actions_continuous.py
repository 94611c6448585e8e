"""Acceleration and steering as actions, for all three kinds of environment."""

from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.spaces import Box
from gymnasium.utils.env_checker import check_env
from hypothesis import given
from hypothesis import strategies as st

import codriving
from codriving.config.choices import choices
from codriving.datatypes.world import Action, ControlInput, DrivingModel
from codriving.errors import ConfigError, EpisodeError
from codriving.gym.actions import STEERING, ContinuousActions
from codriving.gym.parallel import ParallelDriving


def make(**settings: Any) -> ParallelDriving:
    return codriving.parallel_env("intersection", actions="continuous", **settings)


@pytest.fixture(scope="module")
def model() -> DrivingModel:
    return make().environment.driving_model


@pytest.mark.parametrize("face", ["", "-ego"])
def test_passes_the_check_of_gymnasium(face: str) -> None:
    env = gymnasium.make(f"codriving/merge{face}-v1", actions="continuous", hdvs=[1, 1], cavs=3).unwrapped
    check_env(env)
    assert "action_mask" not in env.reset(seed=1)[1]
    with pytest.raises(EpisodeError, match="continuous actions have no masks"):
        env.action_masks()  # type: ignore[attr-defined]


def test_passes_the_check_of_pettingzoo(pettingzoo_tests: Any) -> None:
    pettingzoo_tests.parallel_api_test(make(cavs=3, hdvs=(1, 1)), num_cycles=60)


def test_spaces_are_two_numbers_a_cav() -> None:
    assert make().action_space("CAV1") == Box(-1.0, 1.0, (2,), np.float32)
    joint = gymnasium.make("codriving/intersection-v1", actions="continuous")
    assert joint.action_space == Box(-1.0, 1.0, (4, 2), np.float32)


def test_the_ends_of_the_range_are_what_a_vehicle_can_do(model: DrivingModel) -> None:
    read = ContinuousActions(model).read
    assert read("CAV1", np.array([1, -1], np.float32)) == ControlInput(4.0, -STEERING)
    assert read("CAV1", (-1.0, 1.0)) == ControlInput(-8.0, STEERING)
    assert read("CAV1", (-0.5, 0.0)) == ControlInput(-4.0, 0.0)
    assert read("CAV1", (7.0, -7.0)) == ControlInput(4.0, -STEERING)
    assert read("CAV1", Action.IDLE) is Action.IDLE
    unlimited = codriving.parallel_env("intersection", "limits=none", actions="continuous").environment.driving_model
    assert ContinuousActions(unlimited).read("CAV1", (-1, 1)) == ControlInput(-5.0, STEERING)


@given(one=st.floats(-2, 2), other=st.floats(-2, 2))
def test_more_of_it_is_never_less(model: DrivingModel, one: float, other: float) -> None:
    read = ContinuousActions(model).read
    low, high = (read("CAV1", (value, value)) for value in sorted((one, other)))
    assert isinstance(low, ControlInput)
    assert isinstance(high, ControlInput)
    assert low.acceleration <= high.acceleration
    assert low.steering <= high.steering
    assert read("CAV1", (0.0, 0.0)) == ControlInput(0.0, 0.0)


@pytest.mark.parametrize("value", [3, (1.0,), (1.0, 2.0, 3.0), (float("nan"), 0.0), "ab", None])
def test_what_is_no_pair_of_numbers_is_refused(model: DrivingModel, value: object) -> None:
    with pytest.raises(EpisodeError, match="the action of CAV2 must be two numbers from -1 to 1"):
        ContinuousActions(model).read("CAV2", value)


def test_another_action_type_is_refused() -> None:
    with pytest.raises(ConfigError, match="actions must be semantic or continuous, got 'discrete'"):
        codriving.parallel_env("intersection", actions="discrete")


@pytest.mark.parametrize("name", choices("scenario"))
def test_a_driver_at_the_wheel_arrives(name: str) -> None:
    """Steers for a point of the route ahead, at a speed that the bends allow."""
    env = codriving.parallel_env(name, actions="continuous", cavs=2, hdvs=(0, 0), time_limit=120)
    env.reset(seed=10_000)
    road_map, top = env.environment.road_map, env.environment.driving_model.top_speed
    while env.agents:
        wheels = {}
        for cav in env.world.cavs:
            path = road_map.paths[env.world.intents[cav.id].route]
            s, _ = path.project(cav.x, cav.y)
            x, y = path.position(s + 3.0 + 0.5 * cav.speed)
            turn = float(np.angle(np.exp(1j * (np.arctan2(y - cav.y, x - cav.x) - cav.heading))))
            # CAV2 lets CAV1 go first.
            wanted = 0.6 * top if cav.id == "CAV1" or "CAV1" not in env.agents else 0.0
            wheels[cav.id] = np.array([(wanted - cav.speed) / 4, turn / STEERING], np.float32)
        *_, infos = env.step(wheels)
    assert {info["outcome"] for info in infos.values()} == {"success"}


def test_a_lane_change_by_the_wheel_costs_what_any_does() -> None:
    """Twice the same drive, with and without the weight: the one difference is when the lane beside is nearer."""
    paid = []
    for weight in (0.0, -0.5):
        env = codriving.parallel_env(
            "highway", actions="continuous", cavs=2, hdvs=(0, 0), reward={"lane_change": weight}
        )
        env.reset(seed=10_000)
        side = 1 if env.world.cavs[0].lane[2] == 0 else -1
        wheel = 0.02 * side / STEERING
        steps = [env.step({"CAV1": (0, w), "CAV2": (-0.2, 0)})[1]["CAV1"] for w in [wheel] * 3 + [-wheel] * 3]
        paid.append(steps)
    differences = sorted(two - one for one, two in zip(*paid, strict=True))
    assert differences == pytest.approx([-0.5, 0, 0, 0, 0, 0])
