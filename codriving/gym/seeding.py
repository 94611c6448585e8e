"""Which episode a reset begins."""

from operator import index

import numpy as np

from codriving.config.schema import LARGEST_SEED
from codriving.errors import EpisodeError

FIRST_DRAWN = 1_000_000
"""Smallest seed that is drawn; tables use smaller ones, so that nobody trains by accident on what is tested."""


def draw_seed(rng: np.random.Generator) -> int:
    """Draw the seed of an episode."""
    return int(rng.integers(FIRST_DRAWN, LARGEST_SEED, endpoint=True))


def check_seed(seed: object) -> int:
    """Return a seed that was given as a plain number.

    Raises:
        EpisodeError: If it is not a whole number of at least 0.
    """
    try:
        number = index(seed)  # type: ignore[arg-type]
    except TypeError:
        number = -1
    if number < 0:
        raise EpisodeError(f"seed must be a whole number of at least 0, or None to draw one, got {seed!r}")
    return number
