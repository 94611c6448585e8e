"""Who drives in these tests, and what every step of an episode returned."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from codriving.config.compose import compose
from codriving.experiment.objects import make_objects
from codriving.gym.actions import ACTIONS
from codriving.gym.parallel import ParallelDriving

SLOWER, IDLE, FASTER, LANE_LEFT, LANE_RIGHT, HOLD = range(6)

Chooser = Callable[[ParallelDriving, Mapping[str, Any]], dict[str, int]]


def always(*numbers: int) -> Chooser:
    """Each vehicle takes the first of these actions that is allowed."""

    def choose(env: ParallelDriving, infos: Mapping[str, Any]) -> dict[str, int]:
        return {agent: next(n for n in numbers if infos[agent]["action_mask"][n]) for agent in env.agents}

    return choose


def at_random(seed: int) -> Chooser:
    """Each vehicle draws one of the allowed actions."""
    rng = np.random.default_rng(seed)

    def choose(env: ParallelDriving, infos: Mapping[str, Any]) -> dict[str, int]:
        return {agent: int(rng.choice(np.flatnonzero(infos[agent]["action_mask"]))) for agent in env.agents}

    return choose


def by_the_rules(env: ParallelDriving) -> Chooser:
    """The built-in rules drive; made anew for every episode."""
    method = make_objects(compose([])).method
    method.reset(env.environment.road_map, env.environment.driving_model, 0)
    return lambda env, _: {agent: ACTIONS.index(action) for agent, action in method.act(env.world).actions.items()}


def episode(env: ParallelDriving, choose: Chooser, seed: int | None, longest: int = 300) -> list[tuple[Any, ...]]:
    """What every step returned; the reset comes first, with nothing for rewards, terminations and truncations."""
    observations, infos = env.reset(seed=seed)
    steps: list[tuple[Any, ...]] = [(observations, {}, {}, {}, infos)]
    while env.agents and len(steps) <= longest:
        steps.append(env.step(choose(env, steps[-1][4])))
    return steps
