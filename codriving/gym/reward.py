"""What a CAV is rewarded for; every weight can be set."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from math import isfinite
from typing import Any

from codriving.datatypes import Action, ControlInput, VehicleState, beside
from codriving.errors import ConfigError


@dataclass(frozen=True, slots=True)
class RewardWeights:
    """What is added to the reward of a CAV for one decision; the defaults are those of the learning baseline.

    Raises:
        ConfigError: If a weight is not a finite number, or the share is not one.
    """

    arrival: float = 1.0
    collision: float = -3.0
    time: float = -0.025  # For each second on the road [1/s]
    speed: float = 0.0375  # For each second at the highest target speed, in proportion below it [1/s]
    lane_change: float = -0.02
    comfort: float = 0.0  # For each second, times the square of its mean acceleration in the step [s3/m2]
    cooperation: float = 0.0

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if isinstance(value, bool) or not isinstance(value, int | float) or not isfinite(value):
                raise ConfigError(f"reward.{field.name} must be a finite number, got {value!r}")
        if not 0 <= self.cooperation <= 1:
            raise ConfigError(f"reward.cooperation must be 0 to 1, got {self.cooperation:g}")


@dataclass(frozen=True, slots=True)
class CavStep:
    """What one CAV did in one decision step."""

    before: VehicleState
    after: VehicleState | None  # Its state now; None if it has arrived and left the road
    action: Action | ControlInput
    failed: bool

    @property
    def changes_lanes(self) -> bool:
        """Whether it begins a lane change; by a command it does so when it is nearer to the lane beside."""
        if isinstance(self.action, Action):
            return self.action in (Action.LANE_LEFT, Action.LANE_RIGHT)
        return self.after is not None and beside(self.before.lane, self.after.lane)


def reward_weights(given: RewardWeights | Mapping[str, Any] | None) -> RewardWeights:
    """Return the weights, the defaults where nothing is said.

    Raises:
        ConfigError: If there is no such weight, or a value cannot be used.
    """
    if isinstance(given, RewardWeights):
        return given
    if given is not None and not isinstance(given, Mapping):
        raise ConfigError(f"reward must be RewardWeights or a mapping of weights by name, got {given!r}")
    names = [field.name for field in fields(RewardWeights)]
    unknown = [str(name) for name in given or {} if name not in names]
    if unknown:
        raise ConfigError(f"unknown weight reward.{unknown[0]}; weights: {', '.join(names)}")
    return RewardWeights(**(given or {}))


def rewards(weights: RewardWeights, driven: Sequence[CavStep], duration: float, top_speed: float) -> list[float]:
    """Reward one decision step."""
    own = [_reward(weights, one, duration, top_speed) for one in driven]
    if not own or not weights.cooperation:
        return own
    mean = sum(own) / len(own)
    return [(1 - weights.cooperation) * value + weights.cooperation * mean for value in own]


def _reward(weights: RewardWeights, one: CavStep, duration: float, top_speed: float) -> float:
    # Who has left the road is taken to have kept its speed.
    start, end = one.before.speed, (one.after or one.before).speed
    acceleration = (end - start) / duration
    value = duration * (
        weights.time + weights.speed * (start + end) / 2 / top_speed + weights.comfort * acceleration * acceleration
    )
    if one.changes_lanes:
        value += weights.lane_change
    if one.failed:
        value += weights.collision
    elif one.after is None:
        value += weights.arrival
    return value
