"""Decisions as numbers, and which of them the road allows."""

from collections.abc import Collection
from operator import index

import numpy as np
from numpy.typing import NDArray

from codriving.config import LARGEST_SEED
from codriving.datatypes import Action, DrivingModel
from codriving.errors import EpisodeError

# Smallest seed that is drawn; tables use smaller ones, so no training drives the episodes of a table.
FIRST_DRAWN = 1_000_000


def draw_seed(rng: np.random.Generator) -> int:
    """Draw the seed of an episode."""
    return int(rng.integers(FIRST_DRAWN, LARGEST_SEED, endpoint=True))


def _whole(number: object) -> int:
    """Return a whole number as it is, and -1 for all else."""
    try:
        return index(number)  # type: ignore[arg-type]
    except TypeError:
        return -1


def check_seed(seed: object) -> int:
    """Return a seed that was given as a plain number."""
    number = _whole(seed)
    if number < 0:
        raise EpisodeError(f"seed must be a whole number of at least 0, or None to draw one, got {seed!r}")
    return number


ACTIONS = tuple(Action)  # What the numbers mean: 0 to 4, and 5 only where HOLD is an action


def action_count(model: DrivingModel) -> int:
    """Return how many actions there are."""
    return len(ACTIONS) if model.steady else len(ACTIONS) - 1


def action_mask(available: Collection[Action], count: int) -> NDArray[np.int8]:
    """Mark the actions that the road allows."""
    return np.array([action in (available or (Action.IDLE,)) for action in ACTIONS[:count]], dtype=np.int8)


def action_of(agent: str, number: object, count: int) -> Action:
    """Return the action of a number; an action stands for itself."""
    found = ACTIONS.index(number) if isinstance(number, Action) else _whole(number)
    if not 0 <= found < count:
        names = ", ".join(f"{i} {action}" for i, action in enumerate(ACTIONS[:count]))
        raise EpisodeError(f"the action of {agent} must be one of {names}; got {number!r}")
    return ACTIONS[found]
