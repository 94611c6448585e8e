"""One agent for all CAVs, as Gymnasium wants it, in every scenario that there is."""

from collections.abc import Iterator
from typing import Any

import gymnasium
import numpy as np
import pytest
from choosers import FASTER, HOLD, IDLE, LANE_LEFT, SLOWER
from gymnasium.utils.env_checker import check_env

import codriving
from codriving.config.choices import choices
from codriving.errors import ConfigError, EpisodeError
from codriving.gym.joint import JointDriving


def make(name: str = "intersection", **settings: Any) -> JointDriving:
    made = gymnasium.make(f"codriving/{name}-v1", **settings).unwrapped
    assert isinstance(made, JointDriving)
    return made


@pytest.fixture(scope="module")
def joint() -> Iterator[JointDriving]:
    env = make()
    yield env
    env.close()


@pytest.mark.parametrize("name", choices("scenario"))
def test_passes_the_check_of_gymnasium(name: str) -> None:
    """Warnings are errors in these tests."""
    check_env(make(name))


def test_observation_and_action_are_those_of_all_cavs(joint: JointDriving) -> None:
    parallel = codriving.parallel_env("intersection")
    observation, info = joint.reset(seed=4)
    assert joint.observation_space.shape == (4, 8, 6)
    assert joint.action_space.nvec.tolist() == [6, 6, 6, 6]
    observations, _ = parallel.reset(seed=4)
    np.testing.assert_array_equal(observation, np.stack(list(observations.values())))
    numbers = [FASTER, IDLE, SLOWER, LANE_LEFT]
    observation, reward, terminated, truncated, info = joint.step(np.array(numbers))
    observations, rewards, *_ = parallel.step(dict(zip(parallel.agents, numbers, strict=True)))
    np.testing.assert_array_equal(observation, np.stack(list(observations.values())))
    assert reward == pytest.approx(sum(rewards.values()) / 4)
    assert (terminated, truncated) == (False, False)
    assert info["refused"] == 1
    assert info["action_mask"].tolist() == [[1, 1, 1, 0, 0, 1]] * 4
    assert info["arrived"].tolist() == [False] * 4
    assert (info["outcome"], info["seed"]) == ("", 4)
    assert (info["crashed"].tolist(), info["involved"]) == ([False] * 4, ())


def test_masks_serve_to_sample(joint: JointDriving) -> None:
    _, info = joint.reset(seed=4)
    drawn = [joint.action_space.sample(mask=tuple(info["action_mask"])) for _ in range(50)]
    assert set(np.unique(drawn)) == {SLOWER, IDLE, FASTER, HOLD}
    np.testing.assert_array_equal(joint.action_masks().reshape(4, 6), info["action_mask"].astype(bool))
    assert joint.action_masks().dtype == np.bool_


def test_hold_is_the_last_action_where_it_is_one() -> None:
    five = make(overrides=["environment.steady=false"])
    info = five.reset(seed=4)[1]
    assert five.action_space.nvec.tolist() == [5] * 4
    assert info["action_mask"].tolist() == [[1, 1, 1, 0, 0]] * 4
    env = make()
    env.reset(seed=4)
    for _ in range(3):
        env.step([FASTER] * 4)
    before = {v.id: v.speed for v in env.parallel.world.cavs}
    env.step([HOLD] * 4)
    assert {v.id: v.speed for v in env.parallel.world.cavs} == pytest.approx(before)


def test_who_has_arrived_is_zeros_and_its_action_is_ignored() -> None:
    env = make(cavs=2, hdvs=(0, 0), reward={"arrival": 8.0})
    env.reset(seed=0)
    earned = 0.0
    ever = False
    while True:
        arrived = not env.parallel.agents or env.parallel.agents == ["CAV2"]
        observation, reward, terminated, truncated, info = env.step(
            [LANE_LEFT, FASTER] if arrived else [FASTER, SLOWER]
        )
        earned += reward
        if env.parallel.agents == ["CAV2"]:
            ever = True
            assert not observation[0].any()
            assert observation[1, 0].any()
            assert info["arrived"].tolist() == [True, False]
            assert info["action_mask"].tolist() == [[0, 1, 0, 0, 0, 0], [1, 1, 1, 0, 0, 1]]
            assert info["refused"] == 0
            assert not terminated
        if terminated:
            break
    assert ever
    assert not truncated
    assert info["outcome"] == "success"
    assert earned == pytest.approx(8.0, abs=0.5), "the mean of both returns"


def test_the_time_limit_truncates() -> None:
    env = make(time_limit=1.0)
    env.reset(seed=0)
    for expected in ((False, False), (False, True)):
        *_, terminated, truncated, _ = env.step([IDLE] * 4)
        assert (terminated, truncated) == expected
    with pytest.raises(EpisodeError, match="no episode is going on"):
        env.step([IDLE] * 4)


def test_drawn_episodes_follow_the_seed(joint: JointDriving) -> None:
    def drawn(seed: int) -> list[int]:
        joint.reset(seed=seed)
        return [joint.reset()[1]["seed"] for _ in range(3)]

    assert drawn(1) == drawn(1)
    assert drawn(1) != drawn(2)
    assert min(drawn(1)) >= 1_000_000


def test_several_at_once() -> None:
    envs = gymnasium.make_vec("codriving/intersection-v1", num_envs=2, vectorization_mode="sync", cavs=3)
    observation, info = envs.reset(seed=[0, 1])
    assert observation.shape == (2, 3, 8, 6)
    assert info["seed"].tolist() == [0, 1]
    envs.step(np.ones((2, 3), dtype=np.int64))
    envs.close()


def test_settings_and_overrides_reach_the_environment() -> None:
    env = make(overrides=("drivers=simulator", "drivers.headway=1.2"), cavs=3, rows=5, cda="status_sharing")
    assert env.observation_space.shape == (3, 5, 6)
    assert env.parallel.environment.drivers.headway == 1.2
    with pytest.raises(ConfigError, match=r"unknown key scenario\.cvas"):
        make(cvas=3)


@pytest.mark.parametrize("action", [[IDLE] * 3, IDLE, [[IDLE] * 4], [0.5] * 4])
def test_wrong_actions_are_refused(joint: JointDriving, action: Any) -> None:
    joint.reset(seed=0)
    with pytest.raises(EpisodeError, match=r"one action for each of CAV1|the action of CAV1 must be"):
        joint.step(action)
