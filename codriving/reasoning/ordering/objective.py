"""What a good order is: the time that everybody loses, and how late the last one is through."""

from collections.abc import Mapping
from math import isfinite

from codriving.datatypes.ordering_problem import Entrant, Instance
from codriving.errors import ConfigError
from codriving.reasoning.ordering.schedule import Times

LONGEST_WAIT = 60.0
"""A wait counts as this much at most, so that one without end does not make all others look alike [s]."""


class Objective:
    """J = D + lambda M: total delay plus a share of the evacuation time.

    Raises:
        ConfigError: If a weight is out of range.
    """

    def __init__(self, evacuation_weight: float = 0.0, fairness: Mapping[str, float] | None = None) -> None:
        self.evacuation_weight, self.fairness = evacuation_weight, dict(fairness or {})
        if not 0 <= evacuation_weight <= 10:
            raise ConfigError(f"evacuation_weight must be 0 to 10, got {evacuation_weight:g}")
        for name, weight in self.fairness.items():
            if not 0 <= weight <= 100:
                raise ConfigError(f"fairness.{name} must be 0 to 100, got {weight:g}")

    @property
    def variant(self) -> str:
        """What tells it from the total delay, in words for tables."""
        named = [f"fairness.{name}={weight:g}" for name, weight in sorted(self.fairness.items()) if weight != 1]
        return ",".join([f"evacuation_weight={self.evacuation_weight:g}"] * (self.evacuation_weight != 0) + named)

    def weight(self, name: str) -> float:
        """Return how much a vehicle's delay counts."""
        return self.fairness.get(name, 1.0)

    def value(self, instance: Instance, times: Times) -> float:
        """Return J of a schedule [s].

        Args:
            times: When each vehicle passes its reference point [s].
        """
        delay = sum(self.weight(name) * waited(instance.entrants[name], t) for name, t in times.items())
        if self.evacuation_weight == 0 or not times:
            return delay
        return delay + self.evacuation_weight * max(left(instance.entrants[name], t) for name, t in times.items())


def waited(entrant: Entrant, time: float) -> float:
    """Return how much later than at the earliest a vehicle passes [s], at most LONGEST_WAIT.

    Args:
        time: When it passes its reference point [s].
    """
    return min(time - entrant.eta, LONGEST_WAIT) if isfinite(entrant.eta) else 0.0


def left(entrant: Entrant, time: float) -> float:
    """Return when a vehicle has left its last conflict zone [s], at most LONGEST_WAIT after it passes.

    Args:
        time: When it passes its reference point [s].
    """
    return min(max(time, -LONGEST_WAIT), LONGEST_WAIT) + entrant.crossing
