"""What the Gymnasium environments share: the seed of an episode, and what is left to the environment of all CAVs."""

from typing import Any

import gymnasium
import numpy as np
from numpy.typing import NDArray

from codriving.gym.actions import check_seed, draw_seed
from codriving.gym.observation import FloatArray
from codriving.gym.parallel import METADATA, ParallelDriving


class OneAgent(gymnasium.Env[FloatArray, Any]):
    """An environment of one agent."""

    def seed_of(self, seed: int | None) -> int:
        """Return the seed of the next episode: the one given, which begins the generator anew, or one drawn from that.

        Raises:
            EpisodeError: If the seed is not a whole number of at least 0.
        """
        given = None if seed is None else check_seed(seed)
        gymnasium.Env.reset(self, seed=given)
        return draw_seed(self.np_random) if given is None else given


class OverParallel(OneAgent):
    """An environment of one agent over that of all CAVs."""

    metadata = METADATA

    def __init__(self, parallel: ParallelDriving) -> None:
        self.parallel = parallel
        self.render_mode, self.metadata = parallel.render_mode, parallel.metadata

    def render(self) -> NDArray[np.uint8] | None:
        """Draw the world as it is now."""
        return self.parallel.render()

    def close(self) -> None:
        """Let go of the picture; there is nothing else to close."""
        self.parallel.close()
