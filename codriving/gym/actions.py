"""Decisions as numbers: semantic actions, and which of them the road allows, or acceleration and steering."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Collection
from math import isfinite, nan, pi
from operator import index
from typing import Any

import numpy as np
from gymnasium.spaces import Box, Discrete

from codriving.config import LARGEST_SEED
from codriving.datatypes import Action, ControlInput, DrivingModel
from codriving.errors import ConfigError, EpisodeError

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

STEERING = pi / 4  # Angle of the front wheels at the end of the range [rad]

UNLIMITED = 5.0  # Acceleration and braking at the ends of the range where vehicles have no limits [m/s2]


class ActionType(ABC):
    """What an agent decides, as numbers and as the environment takes it."""

    @abstractmethod
    def space(self) -> Discrete | Box:
        """Return a new space of one CAV."""

    @abstractmethod
    def read(self, agent: str, value: object) -> Action | ControlInput:
        """Return what a value of the space means."""

    def said(self, available: Collection[Action]) -> dict[str, Any]:
        """Return what there is to say of what can be decided now."""
        return {}


class SemanticActions(ActionType):
    """One of the actions of the paper."""

    def __init__(self, model: DrivingModel) -> None:
        self.count = len(ACTIONS) if model.steady else len(ACTIONS) - 1

    def space(self) -> Discrete:
        return Discrete(self.count)

    def read(self, agent: str, value: object) -> Action:
        """Return the action of a number; an action stands for itself."""
        found = ACTIONS.index(value) if isinstance(value, Action) else _whole(value)
        if not 0 <= found < self.count:
            names = ", ".join(f"{i} {action}" for i, action in enumerate(ACTIONS[: self.count]))
            raise EpisodeError(f"the action of {agent} must be one of {names}; got {value!r}")
        return ACTIONS[found]

    def said(self, available: Collection[Action]) -> dict[str, Any]:
        """Return the mask of the actions that the road allows."""
        allowed = available or (Action.IDLE,)
        return {"action_mask": np.array([action in allowed for action in ACTIONS[: self.count]], dtype=np.int8)}


class ContinuousActions(ActionType):
    """Acceleration and steering, each from -1 to 1 of what a vehicle can do."""

    def __init__(self, model: DrivingModel) -> None:
        limits = model.limits
        self.pedal = (UNLIMITED, UNLIMITED) if limits is None else (limits.braking, limits.acceleration)

    def space(self) -> Box:
        return Box(-1.0, 1.0, (2,), np.float32)

    def read(self, agent: str, value: object) -> Action | ControlInput:
        """Return the command of two numbers, those beyond the range at its ends; an action stands for itself."""
        if isinstance(value, Action):
            return value
        try:
            pedal, wheel = (float(number) for number in value)  # type: ignore[attr-defined]
        except (TypeError, ValueError):
            pedal = wheel = nan
        if not (isfinite(pedal) and isfinite(wheel)):
            raise EpisodeError(
                f"the action of {agent} must be two numbers from -1 to 1, acceleration and steering; got {value!r}"
            )
        pedal, wheel = min(max(pedal, -1.0), 1.0), min(max(wheel, -1.0), 1.0)
        return ControlInput(pedal * self.pedal[pedal > 0], wheel * STEERING)


ACTION_TYPES: dict[str, Callable[[DrivingModel], ActionType]] = {
    "semantic": SemanticActions,
    "continuous": ContinuousActions,
}


def action_type(name: object, model: DrivingModel) -> ActionType:
    """Return the action type of a name."""
    if not isinstance(name, str) or name not in ACTION_TYPES:
        raise ConfigError(f"actions must be {' or '.join(ACTION_TYPES)}, got {name!r}")
    return ACTION_TYPES[name](model)
