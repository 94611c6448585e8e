"""From an order to a schedule, in which all pass as early as those before allow, and what it costs."""

from collections.abc import Mapping, Sequence
from math import isfinite

from codriving.datatypes.ordering_problem import ApproachingVehicle, Instance, Pair
from codriving.errors import require_range

Times = Mapping[str, float]
"""When each vehicle passes its reference point, in the order in which they go [s]."""


def start_time(vehicle: ApproachingVehicle, earlier: Times, separation: Mapping[Pair, float]) -> float:
    """Return the earliest time at which a vehicle can pass its reference point after those already scheduled [s]."""
    name = vehicle.id
    time = max([vehicle.eta] + [t + separation[k, name] for k, t in earlier.items() if (k, name) in separation])
    return after_windows(time, vehicle.windows)


def after_windows(time: float, windows: Sequence[tuple[float, float]]) -> float:
    """Return the earliest time from a time on that lies in none of some open intervals (begin, end) [s]."""
    moved = True
    while moved:
        moved = False
        for begin, end in windows:
            if begin < time < end:
                time, moved = end, True
    return time


def schedule(instance: Instance, order: Sequence[str]) -> dict[str, float] | None:
    """Schedule an order, first to last.

    Returns:
        When each vehicle passes, in that order [s]; None if the order contradicts what is physically fixed.
    """
    held: dict[str, set[str]] = {}
    for first, second in instance.before:
        held.setdefault(second, set()).add(first)
    times: dict[str, float] = {}
    for name in order:
        if not held.get(name, set()) <= times.keys():
            return None
        times[name] = start_time(instance.vehicles[name], times, instance.separation)
    return times


def repaired(instance: Instance, ranking: Sequence[str]) -> list[str]:
    """Turn a ranking into an order that respects what is physically fixed.

    Returns:
        All of them; each time the first of the ranking whose predecessors have gone. Where the fixed pairs form a
        circle, as only vehicles that collide anyway can, the first of the ranking goes.
    """
    waiting, order = list(ranking), []
    while waiting:
        free = [n for n in waiting if not any((other, n) in instance.before for other in waiting)]
        chosen = (free or waiting)[0]
        order.append(chosen)
        waiting.remove(chosen)
    return order


def total_delay(instance: Instance, times: Times) -> float:
    """Return the time that all lose together against going at the earliest [s]."""
    return sum(t - instance.vehicles[name].eta for name, t in times.items())


def evacuation_time(instance: Instance, times: Times) -> float:
    """Return when the last vehicle has left its conflict zones [s]; 0 if there is none."""
    return max((t + instance.vehicles[name].crossing for name, t in times.items()), default=0.0)


def timed(instance: Instance, order: Sequence[str]) -> dict[str, float]:
    """Schedule an order as it stands, even one that contradicts what is physically fixed.

    Returns:
        When each vehicle passes, in that order [s].
    """
    times: dict[str, float] = {}
    for name in order:
        times[name] = start_time(instance.vehicles[name], times, instance.separation)
    return times


LONGEST_WAIT = 60.0
"""A wait counts as this much at most, so that one without end does not make all others look alike [s]."""


class Objective:
    """J = D + lambda M: total delay plus a share of the evacuation time.

    Raises:
        ConfigError: If a weight is out of range.
    """

    def __init__(self, evacuation_weight: float = 0.0, fairness: Mapping[str, float] | None = None) -> None:
        self.evacuation_weight, self.fairness = evacuation_weight, dict(fairness or {})
        require_range("evacuation_weight", evacuation_weight, 0, 10)
        for name, weight in self.fairness.items():
            require_range(f"fairness.{name}", weight, 0, 100)

    @property
    def variant(self) -> str:
        """What tells it from the total delay, in words for tables."""
        named = [f"fairness.{name}={weight:g}" for name, weight in sorted(self.fairness.items()) if weight != 1]
        return ",".join([f"evacuation_weight={self.evacuation_weight:g}"] * (self.evacuation_weight != 0) + named)

    def weight(self, name: str) -> float:
        """Return how much a vehicle's delay counts."""
        return self.fairness.get(name, 1.0)

    def value(self, instance: Instance, times: Times) -> float:
        """Return J of a schedule [s]."""
        delay = sum(self.weight(name) * waited(instance.vehicles[name], t) for name, t in times.items())
        if self.evacuation_weight == 0 or not times:
            return delay
        return delay + self.evacuation_weight * max(left(instance.vehicles[name], t) for name, t in times.items())


def waited(vehicle: ApproachingVehicle, time: float) -> float:
    """Return how much later than at the earliest a vehicle passes [s], at most LONGEST_WAIT."""
    return min(time - vehicle.eta, LONGEST_WAIT) if isfinite(vehicle.eta) else 0.0


def left(vehicle: ApproachingVehicle, time: float) -> float:
    """Return when a vehicle that passes at a time [s], at most LONGEST_WAIT, has left its last conflict zone [s]."""
    return min(max(time, -LONGEST_WAIT), LONGEST_WAIT) + vehicle.crossing
