"""One CAV in one hand among CAVs that the rules drive: the same episodes as a run, with one decision of one's own."""

from typing import Any

import gymnasium
import numpy as np
import pytest
from choosers import FASTER, HOLD, IDLE, LANE_LEFT, SLOWER
from gymnasium.spaces import Box, Discrete
from gymnasium.utils.env_checker import check_env

from codriving.config.choices import choices
from codriving.config.compose import compose
from codriving.errors import ConfigError, EpisodeError, UserError
from codriving.experiment.objects import make_objects
from codriving.gym.actions import ACTIONS, FIRST_DRAWN
from codriving.gym.ego import EgoDriving


def make(name: str = "intersection", **settings: Any) -> EgoDriving:
    made = gymnasium.make(f"codriving/{name}-ego-v1", **settings).unwrapped
    assert isinstance(made, EgoDriving)
    return made


@pytest.mark.parametrize("name", choices("scenario"))
def test_passes_the_check_of_gymnasium(name: str) -> None:
    """Warnings are errors in these tests."""
    check_env(make(name, hdvs=[1, 1], cavs=3))


def test_spaces_are_those_of_one_cav() -> None:
    env = make(rows=5)
    assert env.action_space == Discrete(6)
    assert isinstance(env.observation_space, Box)
    assert env.observation_space.shape == (5, 6)
    observation, info = env.reset(seed=3)
    assert env.observation_space.contains(observation)
    assert info["action_mask"].tolist() == env.action_masks().tolist() == [1, 1, 1, 0, 0, 1]
    assert make(suite="paper").action_space == Discrete(5)


def test_who_acts_as_the_rules_do_drives_the_episode_of_a_run() -> None:
    """All but the ego vehicle decide as in `codriving run`, also on what the ego vehicle does."""
    env, config = make(cavs=3), compose(["scenario.cavs=3"])
    environment, method, *_ = make_objects(config)
    env.reset(seed=10_004)
    world = environment.reset(10_004)
    method.reset(environment.road_map, environment.driving_model, 0)
    ended = False
    while not ended:
        actions = method.act(world).actions
        world = environment.step(actions)
        *_, terminated, truncated, _ = env.step(np.int64(ACTIONS.index(actions["CAV1"])))
        assert env.parallel.world == world
        ended = terminated or truncated
    assert "CAV1" not in world.available


def test_the_others_answer_to_what_the_ego_vehicle_does() -> None:
    env, speeds = make(cavs=3, ego="CAV2"), []
    for action in (FASTER, SLOWER):
        env.reset(seed=10_000)
        for _ in range(12):
            env.step(np.int64(action))
        speeds.append([(v.id, v.x, v.y) for v in env.parallel.world.vehicles if v.id in ("CAV1", "CAV3")])
    assert speeds[0] != speeds[1]


def test_the_episode_is_over_when_the_ego_vehicle_has_arrived() -> None:
    env = make(cavs=2, hdvs=[0, 0])
    env.reset(seed=10_001)
    ended: tuple[bool, bool] = (False, False)
    while not any(ended):
        observation, reward, *ended_, info = env.step(np.int64(FASTER))
        ended = (ended_[0], ended_[1])
    assert ended == (True, False)
    assert info["arrived"]
    assert reward > 0.9
    assert not observation.any()
    assert env.action_masks().tolist() == [False, True, False, False, False, False]
    with pytest.raises(EpisodeError, match=r"call reset\(\) before step\(action\)"):
        env.step(np.int64(IDLE))


def test_at_the_time_limit_it_is_truncated() -> None:
    env = make(time_limit=2.0)
    env.reset(seed=10_001)
    assert [env.step(np.int64(SLOWER))[2:4] for _ in range(4)] == [(False, False)] * 3 + [(False, True)]
    with pytest.raises(EpisodeError, match="no episode is going on"):
        env.step(np.int64(SLOWER))


def test_what_the_road_forbids_is_idle_and_counted() -> None:
    env = make()
    env.reset(seed=10_001)
    assert env.step(np.int64(LANE_LEFT))[-1]["refused"] == 1
    with pytest.raises(EpisodeError, match="the action of CAV1 must be one of 0 SLOWER"):
        env.step(np.int64(HOLD + 1))


def test_the_same_seed_is_the_same_episode_and_drawn_ones_are_for_training() -> None:
    env, other = make(), make()
    first = [env.reset(seed=10_002)[0].tolist(), env.reset()[1]["seed"]]
    assert first == [other.reset(seed=10_002)[0].tolist(), other.reset()[1]["seed"]]
    assert first[1] >= FIRST_DRAWN


def test_another_method_drives_the_others() -> None:
    found = []
    for others in ("codriving", "random_action", "oracle", "fcfs"):
        env = make(others=others, hdvs=[2, 2])
        env.reset(seed=10_003)
        for _ in range(6):
            env.step(np.int64(SLOWER))
        found.append([(v.x, v.y) for v in env.parallel.world.cavs])
    assert found[0] != found[1]
    assert found[0] != found[3]


@pytest.mark.parametrize(
    ("settings", "why"),
    [
        ({"ego": "CAV9"}, r"ego must be one of CAV1, CAV2, CAV3, CAV4, got 'CAV9'"),
        ({"others": "nothing"}, "unknown method 'nothing'; choices: "),
        ({"others": "idm"}, "others='idm' hands all CAVs over to human drivers"),
        ({"overrides": ["method=fcfs"]}, "'method=fcfs' has no effect on an environment"),
    ],
)
def test_what_cannot_be_used_is_refused(settings: dict[str, Any], why: str) -> None:
    with pytest.raises(ConfigError, match=why):
        make(**settings)


def test_a_method_that_was_not_made_for_the_road_is_refused() -> None:
    with pytest.raises(UserError):
        make(others="madqn", decision_frequency=1)


def test_a_picture_of_it() -> None:
    env = make(render_mode="rgb_array")
    env.reset(seed=1)
    picture = env.render()
    assert picture is not None
    assert picture.shape == (720, 1280, 3)
    env.close()
