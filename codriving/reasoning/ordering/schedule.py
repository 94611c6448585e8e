"""From an order to a schedule, in which all pass as early as those before allow; free slots in it, and its cost."""

from collections.abc import Mapping, Sequence
from itertools import combinations
from math import isfinite

from codriving.datatypes import ApproachingVehicle, Instance
from codriving.errors import require_range

Times = Mapping[str, float]  # When each vehicle passes its reference point, in the order in which they go [s]


def start_time(instance: Instance, name: str, earlier: Times) -> float:
    """Return the earliest time at which a vehicle can pass its reference point, given those already scheduled [s].

    It passes after them, or before them where the instance leaves it open at each zone who is first.
    """
    vehicle, separation, zones = instance.vehicles[name], instance.separation, instance.zones
    after = [t + separation[k, name] for k, t in earlier.items() if (k, name) in separation and (k, name) not in zones]
    shut = [(t - b, t + a) for k, t in earlier.items() for b, a in zones.get((k, name), ())]
    return after_windows(max([vehicle.eta, *after]), [*vehicle.windows, *shut])


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
    place = {name: k for k, name in enumerate(order)}
    if any(place.get(first, len(order)) > place[second] for first, second in instance.before if second in place):
        return None
    return timed(instance, order)


def repaired(instance: Instance, ranking: Sequence[str]) -> list[str]:
    """Turn a ranking into an order that respects what is physically fixed.

    Returns:
        All of them; each time the first of the ranking whose predecessors have gone. Where the fixed pairs form a
        circle, as only vehicles that collide anyway can, the first of the ranking goes.
    """
    waiting, order = list(ranking), []
    while waiting:
        chosen = next((n for n in waiting if not any((other, n) in instance.before for other in waiting)), waiting[0])
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
        times[name] = start_time(instance, name, times)
    return times


# A wait counts as this much at most, so that one without end does not make all others look alike [s].
LONGEST_WAIT = 60.0


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


SLACK = 1e-9  # Times that differ by less are equal [s]


def earliest_slot(instance: Instance, name: str, scheduled: Times) -> float:
    """Return the earliest time at which a vehicle disturbs none that is scheduled [s].

    Each scheduled vehicle shuts out an interval around its own time, each human driver a window.
    """
    vehicle, separation = instance.vehicles[name], instance.separation
    time, shut = vehicle.eta, list(vehicle.windows)
    for other, at in scheduled.items():
        apart = separation.get((other, name))
        if apart is None or (name, other) in instance.before:
            continue
        if (other, name) in instance.before:
            time = max(time, at + apart)
        elif (other, name) in instance.zones:
            shut += [(at - before, at + after) for before, after in instance.zones[other, name]]
        else:
            shut.append((at - separation.get((name, other), 0.0), at + apart))
    return after_windows(time, shut)


def inserted(instance: Instance, ranking: Sequence[str], scheduled: Times) -> dict[str, float]:
    """Give one vehicle after another the earliest slot among those scheduled before it; return the whole schedule."""
    times = dict(scheduled)
    for name in ranking:
        times[name] = earliest_slot(instance, name, times)
    return times


def sequence(instance: Instance, times: Times) -> list[str]:
    """Return the order in which a schedule lets vehicles through their zones.

    Reference points lie at different distances from a shared zone, so the one with the later time may be the one that
    is in the zone first. Of two in conflict it is therefore the separations that tell which goes first, not the times.

    Args:
        times: A schedule; of equal times the one that stands first here goes first [s].

    Returns:
        All vehicles, first to last; it respects what is physically fixed.
    """
    ranking = sorted(times, key=lambda name: times[name])
    place = {name: k for k, name in enumerate(ranking)}
    behind = {
        name: [o for o in ranking if o != name and _is_first(instance, times, o, name, place[o] < place[name])]
        for name in ranking
    }
    order: dict[str, None] = {}
    while ranking:
        free = next((name for name in ranking if all(other in order for other in behind[name])), ranking[0])
        order[free] = None
        ranking.remove(free)
    return repaired(instance, list(order))


def _is_first(instance: Instance, times: Times, one: str, other: str, earlier: bool) -> bool:
    """Whether one of two vehicles is in their zone first; ``earlier``: whether it has the earlier time."""
    if (one, other) in instance.before or (other, one) in instance.before:
        return (one, other) in instance.before
    there, back = instance.separation.get((one, other)), instance.separation.get((other, one))
    if there is None and back is None:
        return False
    fits = there is not None and times[other] - times[one] >= there - SLACK
    fits_back = back is not None and times[one] - times[other] >= back - SLACK
    return fits if fits != fits_back else earlier


def carried_over(instance: Instance, previous: Sequence[str], ranking: Sequence[str]) -> list[str] | None:
    """Bring an order up to date: without vehicles that have gone; new ones get the earliest slot between the others.

    Returns:
        All vehicles; None if none of the order is left, or if it contradicts what is now physically fixed.
    """
    kept = [name for name in previous if name in instance.vehicles]
    if not kept:
        return None
    times = timed(instance, kept)
    new = [name for name in ranking if name not in kept]
    # Of equal times the one that stands first goes first: those that are in the order already.
    order = sequence(instance, inserted(instance, new, times)) if new else repaired(instance, kept)
    place = {name: k for k, name in enumerate(order)}
    turned = (place[one] > place[other] for one, other in combinations(kept, 2) if instance.conflict(one, other))
    return None if any(turned) else order
