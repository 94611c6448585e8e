"""How an episode begins and ends for its agents, and what is refused."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pytest
from choosers import FASTER, IDLE, LANE_LEFT, SLOWER, always, episode

from codriving.config.schema import LARGEST_SEED
from codriving.datatypes.world import Action
from codriving.errors import EpisodeError
from codriving.gym.actions import draw_seed
from codriving.gym.parallel import ParallelDriving

Make = Callable[..., ParallelDriving]


def test_agents_leave_one_by_one(make: Make) -> None:
    env = make(cavs=2, hdvs=(0, 0))

    def one_at_a_time(env: ParallelDriving, infos: Mapping[str, Any]) -> dict[str, int]:
        """The second one waits until the first has left; who has left may still be given an action."""
        return {"CAV1": FASTER, "CAV2": SLOWER if "CAV1" in env.agents else FASTER}

    steps = episode(env, one_at_a_time, seed=0)
    names = [tuple(step[0]) for step in steps]
    assert names[0] == names[1] == ("CAV1", "CAV2")
    assert names[-1] == ("CAV2",)
    leaving = names.index(("CAV2",)) - 1
    assert steps[leaving][2] == {"CAV1": True, "CAV2": False}
    assert env.state()[0].sum() == 0
    assert steps[-1][4]["CAV2"]["outcome"] == "success"
    assert env.agents == []


def test_a_collision_terminates_all_agents_and_names_who_took_part(make: Make) -> None:
    env = make(cavs=8, reward={"collision": -50.0})
    for seed in range(20):
        observations, rewards, terminated, truncated, infos = episode(env, always(FASTER), seed)[-1]
        outcome = env.environment.outcome
        assert outcome is not None
        if outcome.collision is not None and len(observations) > 2:
            break
    else:
        pytest.fail("eight CAVs that only accelerate should have crashed")
    assert all(terminated.values())
    assert not any(truncated.values())
    assert {info["outcome"] for info in infos.values()} == {"collision"}
    crashed = {outcome.collision.striker, outcome.collision.struck} & set(rewards)
    assert crashed
    assert crashed == {agent for agent, reward in rewards.items() if reward < -40}
    assert crashed == {agent for agent, info in infos.items() if info["crashed"]}
    assert {info["involved"] for info in infos.values()} == {(outcome.collision.striker, outcome.collision.struck)}
    assert env.agents == []


def test_the_time_limit_truncates_all_agents(make: Make) -> None:
    env = make(time_limit=4.0, cav_speed=(5.0, 5.0), hdvs=(0, 0))
    observations, _, terminated, truncated, infos = episode(env, always(SLOWER), seed=0)[-1]
    assert truncated == dict.fromkeys(env.possible_agents, True)
    assert not any(terminated.values())
    assert all(seen[0].any() for seen in observations.values()), "a learner values the state that was cut off"
    assert {info["outcome"] for info in infos.values()} == {"timeout"}
    assert not any(info["crashed"] or info["involved"] for info in infos.values())
    assert env.agents == []


def test_what_the_road_does_not_allow_is_carried_out_as_idle_and_counted(make: Make) -> None:
    env, other = make(), make(rows=8)
    env.reset(seed=1)
    other.reset(seed=1)
    for count in (1, 2, 3):
        *_, infos = env.step(dict.fromkeys(env.agents, LANE_LEFT))
        other.step(dict.fromkeys(other.agents, IDLE))
        assert {info["refused"] for info in infos.values()} == {count}
    np.testing.assert_array_equal(env.state(), other.state())
    track = env.environment.trajectory().tracks[0]
    assert set(track.action[1:]) == {Action.IDLE}
    _, infos = env.reset(seed=1)
    assert infos["CAV1"]["refused"] == 0


def test_observations_are_the_learners_own(make: Make) -> None:
    env = make()
    observations, _ = env.reset(seed=1)
    before = env.state()
    observations["CAV1"][:] = 0
    np.testing.assert_array_equal(env.state(), before)


def test_numbers_of_numpy_are_actions_too(make: Make) -> None:
    env = make()
    env.reset(seed=1)
    env.step({agent: env.action_space(agent).sample() for agent in env.agents})
    env.step({agent: np.array(IDLE) for agent in env.agents})
    env.reset(seed=np.int64(1))


def test_seeds_are_drawn_apart_from_those_of_tables_and_repeatably(make: Make) -> None:
    env = make()

    def drawn() -> list[int]:
        return [env.reset()[1]["CAV1"]["seed"] for _ in range(4)]

    assert env.reset(seed=5)[1]["CAV1"]["seed"] == 5
    first = drawn()
    assert len(set(first)) == 4
    env.reset(seed=5)
    assert drawn() == first
    env.reset(seed=6)
    assert drawn() != first


@pytest.mark.parametrize(
    ("actions", "said"),
    [
        ({"CAV1": 1}, "one action for each of CAV1, CAV2, CAV3, CAV4 is needed, got none for CAV2, CAV3, CAV4"),
        ({f"CAV{i}": 1 for i in range(1, 6)}, "got one for CAV5"),
        ({f"CAV{i}": 6 for i in range(1, 5)}, "the action of CAV1 must be one of 0 SLOWER, .*; got 6"),
        ({f"CAV{i}": -1 for i in range(1, 5)}, "4 LANE_RIGHT, 5 HOLD; got -1"),
        ({f"CAV{i}": 1.0 for i in range(1, 5)}, "got 1.0"),
        ({f"CAV{i}": "IDLE" for i in range(1, 5)}, "got 'IDLE'"),
    ],
)
def test_wrong_actions_are_refused_and_nothing_moves(make: Make, actions: dict[str, Any], said: str) -> None:
    env = make()
    env.reset(seed=0)
    before = env.state()
    with pytest.raises(EpisodeError, match=said):
        env.step(actions)
    np.testing.assert_array_equal(env.state(), before)
    assert env.agents == env.possible_agents


def test_calls_out_of_order_are_refused(make: Make) -> None:
    env = make(time_limit=1.0)
    with pytest.raises(EpisodeError, match="call reset"):
        env.step({})
    for call in (env.state, lambda: env.world):
        with pytest.raises(EpisodeError, match="call reset"):
            call()
    episode(env, always(IDLE), seed=0)
    with pytest.raises(EpisodeError, match="no episode is going on"):
        env.step(dict.fromkeys(env.possible_agents, IDLE))


def test_drawn_seeds_are_never_those_of_a_small_table() -> None:
    class Extreme:
        """Draws the smallest or the largest number that it may."""

        def __init__(self, largest: bool) -> None:
            self.largest = largest

        def integers(self, low: int, high: int, endpoint: bool) -> int:
            return high - (not endpoint) if self.largest else low

    assert draw_seed(Extreme(largest=False)) == 1_000_000
    assert draw_seed(Extreme(largest=True)) == LARGEST_SEED


@pytest.mark.parametrize("seed", [-1, 1.5, "7"])
def test_what_is_no_seed_is_refused(make: Make, seed: Any) -> None:
    with pytest.raises(EpisodeError, match="seed must be a whole number of at least 0"):
        make().reset(seed=seed)
