"""One episode of the environment for agents, driven by a learner: what each of them goes through."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from codriving.datatypes import Ending, WorldState
from codriving.gym import ACTIONS as NUMBERS
from codriving.methods import ACTIONS, Features, FloatArray, allowed

if TYPE_CHECKING:
    from codriving.gym import ParallelDriving

Masks = NDArray[np.bool_]
# Observations (n, features) and allowed actions (n, actions) to numbers of actions.
Policy = Callable[[FloatArray, Masks], list[int]]


@dataclass(frozen=True, slots=True)
class AgentStep:
    """One decision step of all agents on the road, and what it brought them; a row an agent."""

    agents: list[str]
    observations: FloatArray  # What they observed (n, features)
    masks: Masks  # What they were allowed (n, actions)
    actions: list[int]
    rewards: list[float]
    arrived: frozenset[str]
    failed: frozenset[str]
    ending: Ending | None  # How the episode ended with this step; None if it goes on
    later: dict[str, FloatArray] = field(repr=False)
    allowed: dict[str, Masks] = field(repr=False)


def drive(env: "ParallelDriving", seed: int, features: Features, family: str, policy: Policy) -> Iterator[AgentStep]:
    """Drive one episode."""
    numbers = [NUMBERS.index(action) for action in ACTIONS[family]]
    env.reset(seed=seed)
    features.reset()
    seen, masks = _look(env.world, features, family)
    while env.agents:
        agents = env.agents
        observations = np.stack([seen[name] for name in agents])
        rows = np.stack([masks[name] for name in agents])
        actions = policy(observations, rows)
        _, rewards, *_ = env.step({name: numbers[k] for name, k in zip(agents, actions, strict=True)})
        outcome = env.environment.outcome
        seen, masks = _look(env.world, features, family)
        failed = frozenset(outcome.failed if outcome else ())
        ending = outcome.ending if outcome else None
        arrived = frozenset(agents).difference(seen)
        gains = [rewards[name] for name in agents]
        yield AgentStep(agents, observations, rows, actions, gains, arrived, failed, ending, seen, masks)


def _look(world: WorldState, features: Features, family: str) -> tuple[dict[str, FloatArray], dict[str, Masks]]:
    return features.observe(world), {name: allowed(family, actions) for name, actions in world.available.items()}
