"""From an order to a schedule: when each vehicle passes if everybody goes as early as those before allow."""

from collections.abc import Mapping, Sequence

from codriving.datatypes.ordering_problem import Entrant, Instance, Pair

Times = Mapping[str, float]
"""When each vehicle passes its reference point, in the order in which they go [s]."""


def start_time(entrant: Entrant, earlier: Times, separation: Mapping[Pair, float]) -> float:
    """Return the earliest time at which a vehicle can pass after those already scheduled.

    Args:
        earlier: Time of each vehicle already scheduled [s].
        separation: Time that must lie between two vehicles, by (first, second) [s].

    Returns:
        Time at its reference point, outside the windows of human drivers [s].
    """
    name = entrant.id
    time = max([entrant.eta] + [t + separation[k, name] for k, t in earlier.items() if (k, name) in separation])
    return after_windows(time, entrant.windows)


def after_windows(time: float, windows: Sequence[tuple[float, float]]) -> float:
    """Move a time behind every window that it falls into.

    Args:
        time: A time [s].
        windows: Open intervals (begin, end) that are blocked [s].

    Returns:
        The earliest time from then on that lies in no window [s].
    """
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
        times[name] = start_time(instance.entrants[name], times, instance.separation)
    return times


def repaired(instance: Instance, ranking: Sequence[str]) -> list[str]:
    """Turn a ranking into an order that respects what is physically fixed.

    Returns:
        Everybody; again and again the first of the ranking whose predecessors have gone. Where the fixed pairs form a
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
    """Return the time that everybody loses together against going at the earliest [s]."""
    return sum(t - instance.entrants[name].eta for name, t in times.items())


def evacuation_time(instance: Instance, times: Times) -> float:
    """Return when the last vehicle has left its conflict zones [s]; 0 if there is nobody."""
    return max((t + instance.entrants[name].crossing for name, t in times.items()), default=0.0)


def timed(instance: Instance, order: Sequence[str]) -> dict[str, float]:
    """Schedule an order as it stands, even one that contradicts what is physically fixed.

    Returns:
        When each vehicle passes, in that order [s].
    """
    times: dict[str, float] = {}
    for name in order:
        times[name] = start_time(instance.entrants[name], times, instance.separation)
    return times
