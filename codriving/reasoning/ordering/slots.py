"""The earliest free slot: a vehicle goes into a gap between those already scheduled and delays none of them."""

from collections.abc import Sequence
from itertools import combinations

from codriving.datatypes.ordering_problem import Instance
from codriving.reasoning.ordering.schedule import Times, after_windows, repaired, timed

SLACK = 1e-9
"""Times that differ by less are equal [s]."""


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
    behind = {
        name: [
            other
            for k, other in enumerate(ranking)
            if other != name and _is_first(instance, times, other, name, k < place)
        ]
        for place, name in enumerate(ranking)
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
    known = set(kept)
    if not kept:
        return None
    times = timed(instance, kept)
    new = [name for name in ranking if name not in known]
    # Of equal times the one that stands first goes first: those that are in the order already.
    order = sequence(instance, inserted(instance, new, times)) if new else repaired(instance, kept)
    place = {name: k for k, name in enumerate(order)}
    turned = (place[one] > place[other] for one, other in combinations(kept, 2) if instance.conflict(one, other))
    return None if any(turned) else order
