"""A seed determines an episode: whatever else draws random numbers, or drives in the same process."""

import random
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from codriving.datatypes.record import Trajectory
from codriving.datatypes.world import Action, WorldState
from codriving.environment.environment import Environment

Build = Callable[..., Environment]
DECISIONS = 16


def choose(world: WorldState) -> dict[str, Action]:
    """A policy without a memory that differs between vehicles and steps."""
    return {
        cav.id: world.available[cav.id][(world.step * 7 + int(cav.id[3:]) * 5) % 3 if world.step % 2 else 0]
        for cav in world.cavs
    }


def advance(env: Environment, world: WorldState) -> WorldState:
    return world if env.outcome is not None else env.step(choose(world))


def driven(env: Environment, seed: int) -> Trajectory:
    world = env.reset(seed)
    for _ in range(DECISIONS):
        world = advance(env, world)
    return env.trajectory()


def same(one: Trajectory, other: Trajectory) -> bool:
    def bits(trajectory: Trajectory) -> list[tuple[Any, ...]]:
        return [
            (
                t.id,
                t.kind,
                t.route,
                t.action,
                t.arrived,
                *(getattr(t, n).tobytes() for n in ("x", "y", "heading", "speed")),
            )
            for t in trajectory.tracks
        ]

    return bits(one) == bits(other)


def test_same_seed_same_trajectory_and_other_seeds_others(intersection: Build) -> None:
    first = [driven(intersection(), seed) for seed in range(3)]
    env = intersection()
    again = [driven(env, seed) for seed in (2, 1, 0)][::-1]
    assert all(same(*pair) for pair in zip(first, again, strict=True))
    assert not same(first[0], first[1])


def test_global_generators_are_neither_used_nor_advanced(intersection: Build) -> None:
    random.seed(1)
    np.random.seed(1)  # noqa: NPY002  (the global generator is what this test is about)
    first = driven(intersection(), 4)
    states = random.getstate(), np.random.get_state()[1].tobytes()  # type: ignore[index, union-attr]  # noqa: NPY002
    random.seed(2)
    np.random.seed(2)  # noqa: NPY002
    assert same(first, driven(intersection(), 4))
    random.seed(1)
    np.random.seed(1)  # noqa: NPY002
    assert states == (random.getstate(), np.random.get_state()[1].tobytes())  # type: ignore[index, union-attr]  # noqa: NPY002


def test_two_environments_in_turn_do_not_disturb_each_other(intersection: Build) -> None:
    builds = [
        lambda: intersection(),
        lambda: intersection(cavs=2, hdvs=(5, 5), drivers={"jam_distance": 6.0, "headway": 0.8}),
    ]
    alone = [driven(build(), 5) for build in builds]
    envs = [build() for build in builds]
    worlds = [env.reset(5) for env in envs]
    for _ in range(DECISIONS):
        worlds = [advance(env, world) for env, world in zip(envs, worlds, strict=True)]
    assert all(same(env.trajectory(), one) for env, one in zip(envs, alone, strict=True))


def test_drivers_differ_from_each_other(intersection: Build) -> None:
    env = intersection(hdvs=(4, 4))
    env.reset(0)
    assert len({v.DELTA for v in env._traffic.vehicles if hasattr(v, "DELTA")}) == 4


def test_environment_can_be_reset_in_the_middle_of_an_episode(intersection: Build) -> None:
    env = intersection()
    env.step(choose(env.reset(7)))
    assert same(driven(env, 6), driven(intersection(), 6))


@pytest.mark.parametrize("seed", [0, 2**31 - 1])
def test_any_seed_will_do(seed: int, intersection: Build) -> None:
    assert intersection().reset(seed).time == 0.0
