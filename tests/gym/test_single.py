"""One CAV that learns: the same scenes as ever, with all others human drivers."""

import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

from codriving.config.choices import choices
from codriving.datatypes.world import Kind, WorldState
from codriving.environment.environment import Environment
from codriving.errors import EpisodeError
from codriving.gym.actions import ACTIONS, FIRST_DRAWN
from codriving.gym.configured import configured
from codriving.gym.observation import FloatArray
from codriving.gym.single import OneCav, SingleDriving

SLOWER, IDLE, FASTER, LANE_LEFT = range(4)


class Speedometer:
    """Sees the speeds of each vehicle, as far as there is room."""

    def __init__(self, environment: Environment) -> None:
        self.seen = 0

    def nothing(self) -> FloatArray:
        """Zeros."""
        return np.zeros(3, dtype=np.float32)

    def observe(self, world: WorldState) -> dict[str, FloatArray]:
        """The CAV's speed, the number of the others, and how often this was asked for in the episode."""
        self.seen = 1 if world.step == 0 else self.seen + 1
        row = [world.cavs[0].speed / 40, len(world.hdvs) / 40, self.seen / 1000] if world.cavs else []
        return {v.id: np.array(row, dtype=np.float32) for v in world.cavs}


def make(name: str = "intersection", **settings: object) -> SingleDriving:
    return SingleDriving(name, Speedometer, ACTIONS, **settings)


@pytest.mark.parametrize("name", choices("scenario"))
def test_passes_the_check_of_gymnasium(name: str) -> None:
    env = make(name)
    env.action_space.seed(0)
    check_env(env, skip_render_check=True)


@pytest.mark.parametrize("steady", [False, True])
def test_hold_is_an_action_where_it_is_one_in_a_run(steady: bool) -> None:
    env = SingleDriving("intersection", Speedometer, ACTIONS, [f"environment.steady={str(steady).lower()}"])
    assert env.environment.driving_model.steady is steady
    env.reset(seed=10_000)
    if steady:
        env.step(np.int64(5))
    else:
        with pytest.raises(EpisodeError, match=r"must be one of 0 SLOWER, .*4 LANE_RIGHT; got 5"):
            env.step(np.int64(5))


@pytest.mark.parametrize("name", choices("scenario"))
def test_every_vehicle_starts_where_they_always_do(name: str) -> None:
    scenario = configured(name, (), "full", None, {})[0].scenario
    for seed in range(10_000, 10_005):
        full, one = scenario.scene(seed), OneCav(scenario).scene(seed)
        assert [s.kind for s in one.starts] == [Kind.CAV] + [Kind.HDV] * (len(full.starts) - 1)
        assert len({s.id for s in one.starts}) == len(one.starts)
        assert {(s.route, s.position, s.speed) for s in one.starts} == {
            (s.route, s.position, s.speed) for s in full.starts
        }
        cavs = {(s.route, s.position) for s in full.starts if s.kind is Kind.CAV}
        assert (one.starts[0].route, one.starts[0].position) in cavs, "it is one of the CAVs that is left"


def test_each_cav_is_left_now_and_then_and_the_same_one_for_a_seed() -> None:
    scenario = configured("intersection", (), "full", None, {})[0].scenario
    one = OneCav(scenario)
    assert one.scene(10_000) == one.scene(10_000)
    left = set()
    for seed in range(10_000, 10_040):
        cavs = [s for s in scenario.scene(seed).starts if s.kind is Kind.CAV]
        left.add([s.position for s in cavs].index(one.scene(seed).starts[0].position))
    assert left == {0, 1, 2, 3}


def test_the_episode_ends_when_the_cav_arrives_and_the_reward_says_so() -> None:
    env = make(hdvs=[0, 0], cavs=2)
    env.reset(seed=10_001)
    ended, total = (False, False), 0.0
    while not any(ended):
        seen, reward, *ended, info = env.step(np.int64(FASTER))
        total += reward
    assert ended == [True, False]
    assert info["arrived"]
    assert total > 0.9
    assert not seen.any(), "nothing is observed by who has left"


def test_at_the_time_limit_it_is_truncated() -> None:
    env = make(time_limit=2.0)
    env.reset(seed=10_001)
    ended = [env.step(np.int64(SLOWER))[2:4] for _ in range(4)]
    assert ended == [(False, False)] * 3 + [(False, True)]


def test_what_the_road_forbids_is_idle_and_counted() -> None:
    env = make()
    env.reset(seed=10_001)
    assert env.step(np.int64(LANE_LEFT))[-1]["refused"] == 1


def test_the_same_seed_is_the_same_episode_and_drawn_ones_are_for_training() -> None:
    env, other = make(), make()
    first = [env.reset(seed=10_002)[0].tolist(), env.reset()[1]["seed"]]
    assert first == [other.reset(seed=10_002)[0].tolist(), other.reset()[1]["seed"]]
    assert first[1] >= FIRST_DRAWN
