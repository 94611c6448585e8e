"""A better order by local search: who goes earlier or later if that saves everybody together enough time."""

from collections.abc import Mapping

from codriving.datatypes.order import PassingOrder
from codriving.datatypes.ordering_problem import Instance
from codriving.reasoning.ordering.schedule import schedule

SAVES = 0.3
"""Time that another order must save everybody together to be taken [s]."""

SWAP = 1.0
"""Time that it must save for each pair whose order it turns round that has been agreed on [s]."""

TRIES = 600
"""Orders that are tried at most."""


def improve(times: Mapping[str, float], instance: Instance, previous: PassingOrder | None) -> dict[str, float]:
    """Let single vehicles go earlier or later as long as that saves everybody together enough time.

    Args:
        times: The schedule to begin with: when each vehicle passes [s].

    Returns:
        When each vehicle passes, in the order in which they go [s].
    """
    order = sorted(times, key=lambda name: (times[name], name))
    best = schedule(instance, order)
    if best is None:
        return dict(times)
    least, tries = cost(best, instance, previous), 0
    improved = True
    while improved and tries < TRIES:
        improved = False
        for k in range(len(order)):
            for to in range(len(order)):
                if to == k:
                    continue
                tries += 1
                moved = order[:k] + order[k + 1 :]
                moved.insert(to, order[k])
                found = schedule(instance, moved)
                if found is not None and cost(found, instance, previous) < least - SAVES:
                    best, least, order, improved = found, cost(found, instance, previous), moved, True
    return best


def cost(planned: Mapping[str, float], instance: Instance, previous: PassingOrder | None) -> float:
    """Return the time that everybody loses in a schedule, with a surcharge for each agreed pair turned round [s].

    Args:
        planned: When each vehicle passes, in the order in which they go [s].
    """
    changed = 0.0
    if previous is not None:
        place = {name: k for k, name in enumerate(planned)}
        for p in previous.precedences:
            if p.first in place and p.second in place and place[p.first] > place[p.second]:
                changed += SWAP
    return sum(t - max(instance.entrants[name].eta, 0.0) for name, t in planned.items()) + changed
