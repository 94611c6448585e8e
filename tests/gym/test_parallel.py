"""The environment as PettingZoo wants it, in every scenario that there is."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from choosers import at_random, by_the_rules, episode

import codriving
from codriving.config.choices import choices
from codriving.config.compose import compose
from codriving.datatypes.record import Trajectory
from codriving.environment.environment import Environment
from codriving.experiment.objects import make_objects
from codriving.gym.actions import ACTIONS
from codriving.gym.parallel import ParallelDriving

Make = Callable[..., ParallelDriving]

SCENARIOS = list(choices("scenario"))
KEYS = {"action_mask", "arrived", "crashed", "involved", "outcome", "refused", "seed"}


def tracks(trajectory: Trajectory) -> list[tuple[Any, ...]]:
    return [(t.id, t.action, t.arrived, t.x.tobytes(), t.y.tobytes(), t.speed.tobytes()) for t in trajectory.tracks]


@pytest.mark.parametrize("name", SCENARIOS)
def test_passes_the_tests_of_pettingzoo(name: str, make: Make, pettingzoo_tests: Any) -> None:
    pettingzoo_tests.parallel_api_test(make(name), num_cycles=60)
    pettingzoo_tests.parallel_seed_test(lambda: codriving.parallel_env(name), num_cycles=20)


@pytest.mark.parametrize("name", SCENARIOS)
def test_every_observation_lies_in_a_space_that_is_always_the_same(name: str, make: Make) -> None:
    env = make(name)
    spaces = {agent: env.observation_space(agent) for agent in env.possible_agents}
    for seed in range(3):
        for observations, rewards, terminated, truncated, infos in episode(env, at_random(seed), seed):
            for agent, seen in observations.items():
                assert env.observation_space(agent) is spaces[agent]
                assert spaces[agent].contains(seen), (agent, seen)
                assert set(infos[agent]) == KEYS
                assert infos[agent]["action_mask"].dtype == np.int8
            assert env.state_space.contains(env.state())
            assert all(isinstance(value, float) for value in rewards.values())
            assert all(isinstance(flag, bool) for flag in (*terminated.values(), *truncated.values()))
        assert env.agents == []


@pytest.mark.parametrize("name", SCENARIOS)
def test_same_seed_and_actions_give_the_same_episode(name: str, make: Make) -> None:
    one, other = make(name), codriving.parallel_env(name)
    first, second = (episode(env, at_random(5), 7) for env in (one, other))
    assert len(first) > 2
    np.testing.assert_equal(second, first)
    assert tracks(one.environment.trajectory()) == tracks(other.environment.trajectory())


@pytest.mark.parametrize("name", SCENARIOS)
def test_a_seed_is_the_episode_of_that_number_in_a_run(name: str, make: Make) -> None:
    config = compose([f"scenario={name}"])
    world, driver, *_ = make_objects(config)
    assert isinstance(world, Environment)
    state = world.reset(3)
    driver.reset(world.road_map, world.driving_model, 3)
    env = make(name)
    env.reset(seed=3)
    for _ in range(12):
        actions = driver.act(state).actions
        state = world.step(actions)
        env.step({agent: ACTIONS.index(action) for agent, action in actions.items()})
        if world.outcome is not None:
            break
    assert env.environment.outcome == world.outcome
    assert tracks(env.environment.trajectory()) == tracks(world.trajectory())


@pytest.mark.parametrize("name", SCENARIOS)
def test_who_arrives_is_terminated_and_gone(name: str, make: Make) -> None:
    env = make(name, cavs=2, hdvs=(0, 0), reward={"arrival": 10.0, "collision": -10.0})
    steps = episode(env, by_the_rules(env), seed=0)
    left: set[str] = set()
    for observations, rewards, terminated, truncated, infos in steps[1:]:
        assert set(observations) == set(rewards) == set(terminated) == set(truncated) == set(infos)
        assert not left & set(observations)
        for agent in observations:
            assert terminated[agent] is infos[agent]["arrived"]
            assert truncated[agent] is False
            if terminated[agent]:
                left.add(agent)
                assert rewards[agent] > 9
                assert not observations[agent].any()
                assert infos[agent]["action_mask"].tolist() == [0, 1, 0, 0, 0, 0]
            else:
                assert abs(rewards[agent]) < 1
                assert observations[agent][0].any()
    assert left == set(env.possible_agents)
