"""One CAV that learns among human drivers: our environment as a Gymnasium `Env` of a single vehicle."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any, TypeAlias

import numpy as np
from gymnasium.spaces import Box, Discrete

from codriving.datatypes import Action, Kind, Road, Scenario, Scene
from codriving.environment import Environment
from codriving.gym.actions import ACTIONS
from codriving.gym.configured import configured
from codriving.gym.episode import AgentEpisode, Info
from codriving.gym.observation import FloatArray, Observer
from codriving.gym.one_agent import OneAgent
from codriving.gym.reward import RewardWeights, reward_weights

DRAW = 2  # Key of the random numbers that choose the CAV, apart from those of the scene and of the drivers


class OneCav(Scenario):
    """Another scenario with a single CAV among human drivers."""

    def __init__(self, scenario: Scenario) -> None:
        self.scenario, self.name, self.pace = scenario, scenario.name, scenario.pace

    @property
    def road(self) -> Road:
        """The road."""
        return self.scenario.road

    def scene(self, seed: int) -> Scene:
        """Draw the scene, and which of the CAVs is the one that is left; it is called ``CAV1`` always."""
        scene = self.scenario.scene(seed)
        cavs = [start for start in scene.starts if start.kind is Kind.CAV]
        rng = np.random.default_rng(np.random.SeedSequence(entropy=seed, spawn_key=(DRAW,)))
        chosen = cavs[int(rng.integers(len(cavs)))]
        others = [start for start in scene.starts if start is not chosen]
        humans = (replace(start, id=f"HDV{k}", kind=Kind.HDV) for k, start in enumerate(others, 1))
        return Scene(scene.seed, (replace(chosen, id="CAV1"), *humans))


ObserverFactory: TypeAlias = Callable[[Environment], Observer]  # Makes the observer of an environment


class SingleDriving(OneAgent):
    """One agent that drives one CAV; all others are human drivers.

    Args:
        overrides: ``key=value`` tokens, as for ``codriving.parallel_env``.
        **settings: Keys of the scenario; of its ``cavs`` one is left, the others become human drivers.

    Raises:
        ConfigError: If a setting cannot be used.
    """

    def __init__(
        self,
        name: str,
        observer: ObserverFactory,
        actions: Sequence[Action],
        overrides: Sequence[str] = (),
        reward: RewardWeights | Mapping[str, float] | None = None,
        **settings: Any,  # noqa: ANN401 - whatever the scenario's keys take
    ) -> None:
        full, _ = configured(name, overrides, "full", None, settings)
        world = full.control, full.drivers, full.corrections, full.limits
        self.environment = Environment(OneCav(full.scenario), *world, steady=full.driving_model.steady)
        observing = observer(self.environment)
        self._drive = AgentEpisode(self.environment, observing, reward_weights(reward))
        (self._cav,) = self._drive.cavs
        self._numbers = [ACTIONS.index(action) for action in actions]
        self.action_space = Discrete(len(actions))
        self.observation_space = Box(-1.0, 1.0, observing.nothing().shape, np.float32)

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[FloatArray, Info]:
        """Begin an episode.

        Args:
            seed: Seed of the episode, and of the generator from which later ones are drawn; None draws one of
                1,000,000 or more.

        Returns:
            Observation and info.

        Raises:
            EpisodeError: If the seed is not a whole number of at least 0.
            ScenarioError: If the vehicles cannot be placed.
        """
        self._drive.begin(self.seed_of(seed))
        return self._observation(), self._drive.info(self._cav)

    def step(self, action: np.int64) -> tuple[FloatArray, float, bool, bool, Info]:
        """Carry out one decision; what the road does not allow is carried out as IDLE and counted.

        Returns:
            Observation, reward, terminated, truncated, info.

        Raises:
            EpisodeError: If no episode is going on.
        """
        turn = self._drive.step({self._cav: self._numbers[int(action)]})
        ended = turn.terminated[self._cav], turn.truncated[self._cav]
        return self._observation(), turn.rewards[self._cav], *ended, self._drive.info(self._cav)

    def _observation(self) -> FloatArray:
        return self._drive.observations([self._cav])[self._cav]
