"""The conflict coordinator by rules: arrival order, turning yields to straight, who is committed goes (III-C.3)."""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import replace

from codriving.datatypes.order import PassingOrder
from codriving.datatypes.ordering_problem import ApproachingVehicle, Instance, Pair
from codriving.reasoning.moment import Moment
from codriving.reasoning.ordering.agreement import agreement
from codriving.reasoning.ordering.problem import Problem, pose
from codriving.reasoning.ordering.schedule import schedule, start_time

TURN_YIELDS = 1.0
"""A turning vehicle goes before one that goes straight only if it can do so this much earlier [s]."""

KEEPS_TURN = 1.0
"""An order that has been agreed on is changed only if the other one can go this much earlier [s]."""


SAVES = 0.3
"""Time that another order must save all vehicles together to be taken [s]."""

SWAP = 1.0
"""Time that it must save for each pair whose order it turns round that has been agreed on [s]."""

TRIES = 600
"""Orders that are tried at most."""


class Coordinator(ABC):
    """Decides who goes first: one call for all vehicles."""

    @abstractmethod
    def negotiate(self, moment: Moment) -> PassingOrder:
        """Return an order without cycles for all conflicts."""


class RuleCoordinator(Coordinator):
    """Schedules the vehicle that can pass first, again and again, with the traffic rules as handicaps."""

    def __init__(self, binding: bool) -> None:
        self.binding = binding
        self.previous: PassingOrder | None = None

    def negotiate(self, moment: Moment) -> PassingOrder:
        """Return an order without cycles for all conflicts."""
        return self.settle(moment, pose(moment), {})

    def settle(self, moment: Moment, problem: Problem, given: Mapping[Pair, str]) -> PassingOrder:
        """Return an order without cycles in which some pairs are given, each with its reason."""
        instance = replace(problem.instance, before=problem.instance.before | given.keys())
        times = improve(self._list_schedule(instance), instance, self.previous)

        def reason(first: str, second: str) -> str:
            known = given.get((first, second))
            return reason_between(instance.vehicles[first], instance.vehicles[second]) if known is None else known

        self.previous = agreement(moment, problem, times, reason, self.binding)
        return self.previous

    def _list_schedule(self, instance: Instance) -> dict[str, float]:
        """Schedule the vehicle with the smallest start time, handicaps included, until all are scheduled."""
        times: dict[str, float] = {}
        waiting = dict(instance.vehicles)
        while waiting:
            held = {second for first, second in instance.before if first in waiting}
            ready = [s for s in waiting.values() if s.id not in held] or list(waiting.values())
            options = []
            for vehicle in ready:
                time = start_time(vehicle, times, instance.separation)
                handicap = TURN_YIELDS if vehicle.turning else 0.0
                if any(
                    self._was_first(k, vehicle.id)
                    for k in waiting
                    if (k, vehicle.id) in instance.separation and k != vehicle.id
                ):
                    handicap += KEEPS_TURN
                options.append((not vehicle.committed, time + handicap, vehicle.id, time))
            _, _, name, time = min(options)
            times[name] = time
            del waiting[name]
        return times

    def _was_first(self, one: str, other: str) -> bool:
        return self.previous is not None and self.previous.first_of(one, other) == one


def improve(times: Mapping[str, float], instance: Instance, previous: PassingOrder | None) -> dict[str, float]:
    """Let single vehicles go earlier or later as long as that saves all vehicles together enough time.

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
    """Return the time that all vehicles lose in a schedule, with a surcharge for each agreed pair turned round [s].

    Args:
        planned: When each vehicle passes, in the order in which they go [s].
    """
    changed = 0.0
    if previous is not None:
        place = {name: k for k, name in enumerate(planned)}
        for p in previous.precedences:
            if p.first in place and p.second in place and place[p.first] > place[p.second]:
                changed += SWAP
    return sum(t - max(instance.vehicles[name].eta, 0.0) for name, t in planned.items()) + changed


def reason_between(first: ApproachingVehicle, second: ApproachingVehicle) -> str:
    """Explain the order of two CAVs."""
    if first.committed and not second.committed:
        return f"{first.id} can no longer stop before the conflict zone"
    if second.leader == first.id:
        return f"{first.id} drives ahead of {second.id} on the same lane"
    if second.turning and not first.turning and first.eta > second.eta - 2.0:
        return f"{second.id} turns and yields to {first.id}, which goes straight"
    if first.eta <= second.eta:
        return f"{first.id} can be there earlier ({first.eta:.1f} s against {second.eta:.1f} s)"
    return f"{first.id} goes first so that the others have to wait less"
