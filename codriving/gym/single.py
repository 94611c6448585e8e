"""One CAV that learns among human drivers: our environment as a Gymnasium `Env` of a single vehicle."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, TypeAlias

import gymnasium
import numpy as np
from gymnasium.spaces import Box, Discrete

from codriving.datatypes.action import Action
from codriving.environment.environment import Environment
from codriving.gym.actions import ACTIONS
from codriving.gym.configured import configured
from codriving.gym.drive import Drive, Eyes
from codriving.gym.layout import FloatArray
from codriving.gym.one_cav import OneCav
from codriving.gym.reward import RewardWeights, reward_weights
from codriving.gym.seeding import check_seed, draw_seed

EyesOf: TypeAlias = Callable[[Environment], Eyes]
"""Gives eyes to whoever drives in an environment."""


class SingleDriving(gymnasium.Env[FloatArray, np.int64]):
    """One agent that drives one CAV; everybody else is a human driver.

    Args:
        overrides: ``key=value`` tokens, as for ``codriving.parallel_env``.
        **settings: Keys of the scenario; of its ``cavs`` one is left, the others become human drivers.

    Raises:
        ConfigError: If a setting cannot be used.
    """

    def __init__(
        self,
        name: str,
        eyes: EyesOf,
        actions: Sequence[Action],
        overrides: Sequence[str] = (),
        reward: RewardWeights | Mapping[str, float] | None = None,
        **settings: Any,  # noqa: ANN401 - whatever the scenario's keys take
    ) -> None:
        full, _ = configured(name, overrides, "full", None, settings)
        self.environment = Environment(OneCav(full.scenario), full.control, full.drivers, full.corrections)
        sees = eyes(self.environment)
        self._drive = Drive(self.environment, sees, reward_weights(reward))
        (self._cav,) = self._drive.cavs
        self._numbers = [ACTIONS.index(action) for action in actions]
        self.action_space = Discrete(len(actions))
        self.observation_space = Box(-1.0, 1.0, sees.nothing().shape, np.float32)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[FloatArray, dict[str, Any]]:
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
        given = None if seed is None else check_seed(seed)
        super().reset(seed=given)
        self._drive.begin(draw_seed(self.np_random) if given is None else given)
        return self._observation(), self._drive.info(self._cav)

    def step(self, action: np.int64) -> tuple[FloatArray, float, bool, bool, dict[str, Any]]:
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
