"""The conflict coordinator by rules: arrival order, turning yields to straight, who is committed goes (III-C.3)."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from graphlib import CycleError, TopologicalSorter
from itertools import pairwise, permutations
from math import inf

from codriving.datatypes import YIELDS, Instance, Judgement, Pair, PassingOrder, Precedence
from codriving.reasoning.ordering.problem import Problem, pose
from codriving.reasoning.ordering.schedule import schedule, sequence, start_time
from codriving.reasoning.perception import Moment

TURN_YIELDS = 1.0  # A turning vehicle goes before one that goes straight only if it can do so this much earlier [s]

KEEPS_TURN = 1.0  # An order that has been agreed on is changed only if the other one can go this much earlier [s]

SAVES = 0.3  # Time that another order must save all vehicles together to be taken [s]

SWAP = 1.0  # Time that it must save for each pair whose order it turns round that has been agreed on [s]

TRIES = 600  # Orders that are tried at most


class Coordinator(ABC):
    """Decides who goes first: one call for all vehicles."""

    @abstractmethod
    def negotiate(self, moment: Moment, given: Mapping[Pair, str] | None = None) -> PassingOrder:
        """Return an order without cycles for all conflicts; of some pairs it may be given, each with its reason."""


class RuleCoordinator(Coordinator):
    """Schedules the vehicle that can pass first, again and again, with the traffic rules as handicaps."""

    def __init__(self, binding: bool) -> None:
        self.binding = binding
        self.previous: PassingOrder | None = None

    def negotiate(self, moment: Moment, given: Mapping[Pair, str] | None = None) -> PassingOrder:
        """Return an order without cycles for all conflicts."""
        return self.settle(moment, pose(moment), given or {})

    def settle(self, moment: Moment, problem: Problem, given: Mapping[Pair, str]) -> PassingOrder:
        """Return an order without cycles in which some pairs are given, each with its reason."""
        instance = replace(problem.instance, before=problem.instance.before | given.keys())
        times = improve(self._list_schedule(instance), instance, self.previous)
        if instance.zones:
            # Who comes later in the order may be scheduled before: then it is told to go first.
            times = {name: times[name] for name in sequence(instance, times)}

        def reason(first: str, second: str) -> str:
            known = given.get((first, second))
            return reason_between(instance, first, second) if known is None else known

        self.previous = agreement(moment, problem, times, reason, self.binding)
        return self.previous

    def _list_schedule(self, instance: Instance) -> dict[str, float]:
        """Schedule the vehicle with the smallest start time, handicaps included, until all are scheduled."""
        times: dict[str, float] = {}
        waiting = dict(instance.vehicles)
        while waiting:
            held = {second for first, second in instance.before if first in waiting}
            options = []
            for vehicle in [s for s in waiting.values() if s.id not in held] or list(waiting.values()):
                time = start_time(instance, vehicle.id, times)
                rivals = [k for k in waiting if (k, vehicle.id) in instance.separation]
                handicap = TURN_YIELDS if vehicle.turning else 0.0
                if self.previous is not None and any(self.previous.first_of(k, vehicle.id) == k for k in rivals):
                    handicap += KEEPS_TURN
                stops = all(instance.approach(vehicle.id, k).can_stop for k in rivals)
                options.append((stops, time + handicap, vehicle.id, time))
            _, _, name, time = min(options)
            times[name] = time
            del waiting[name]
        return times


def improve(times: Mapping[str, float], instance: Instance, previous: PassingOrder | None) -> dict[str, float]:
    """Let single vehicles go earlier or later as long as that saves all vehicles together enough time."""
    order = sorted(times, key=lambda name: (times[name], name))
    best = schedule(instance, order)
    if best is None:
        return dict(times)
    least, tries = cost(best, instance, previous), 0
    improved = True
    while improved and tries < TRIES:
        improved = False
        for k, to in permutations(range(len(order)), 2):
            tries += 1
            moved = order[:k] + order[k + 1 :]
            moved.insert(to, order[k])
            found = schedule(instance, moved)
            if found is not None and cost(found, instance, previous) < least - SAVES:
                best, least, order, improved = found, cost(found, instance, previous), moved, True
    return best


def cost(planned: Mapping[str, float], instance: Instance, previous: PassingOrder | None) -> float:
    """Return the time that all vehicles lose in a schedule, with a surcharge for each agreed pair turned round [s]."""
    turned = 0
    if previous is not None:
        place = {name: k for k, name in enumerate(planned)}
        for p in previous.precedences:
            turned += p.first in place and p.second in place and place[p.first] > place[p.second]
    return sum(t - max(instance.vehicles[name].eta, 0.0) for name, t in planned.items()) + SWAP * turned


def reason_between(instance: Instance, one: str, other: str) -> str:
    """Explain why one of two CAVs goes before the other one."""
    first, second = instance.vehicles[one], instance.vehicles[other]
    mine, theirs = instance.approach(one, other), instance.approach(other, one)
    if not mine.can_stop and theirs.can_stop:
        return f"{one} can no longer stop before the conflict zone"
    if second.leader == one:
        return f"{one} drives ahead of {other} on the same lane"
    if second.turning and not first.turning and mine.earliest > theirs.earliest - 2.0:
        return f"{other} turns and yields to {one}, which goes straight"
    if mine.earliest <= theirs.earliest:
        return f"{one} can be there earlier ({mine.earliest:.1f} s against {theirs.earliest:.1f} s)"
    return f"{one} goes first so that the others have to wait less"


def agreement(
    moment: Moment, problem: Problem, times: Mapping[str, float], reason: Callable[[str, str], str], binding: bool
) -> PassingOrder:
    """Write down who goes first in every conflict.

    A human driver goes first unless the CAV is scheduled before the driver can be there.

    Args:
        times: When each CAV passes, in the order in which they go [s].
    """
    rank = {name: k for k, name in enumerate(times)}
    pairs = {(min(c.ego, c.other), max(c.ego, c.other)) for cs in moment.conflicts.values() for c in cs}
    ranked = (sorted(pair, key=rank.__getitem__) for pair in sorted(pairs) if rank.keys() >= set(pair))
    precedences = [Precedence(first, second, reason(first, second)) for first, second in ranked]
    arrivals = dict(times)
    for ego, people in problem.passages.items():
        for human, (begin, end) in people.items():
            human_first = times[ego] > begin
            first, second = (human, ego) if human_first else (ego, human)
            why = reason_human(human_first, begin, end, times[ego], moment.judgements.get((ego, human)))
            precedences.append(Precedence(first, second, why))
            arrivals[human] = min(arrivals.get(human, begin), begin)
    kept, sequence = without_cycles(precedences, arrivals)
    return PassingOrder(sequence, kept, binding)


def reason_human(human_first: bool, begin: float, end: float, time: float, judged: Judgement | None = None) -> str:
    """Explain the order of a CAV and a human driver."""
    if begin == inf and judged is not None and judged.answer == YIELDS:
        return judged.reason
    if human_first:
        return f"a human driver shares no intent and may use the zone until {end:.1f} s from now"
    if begin == inf:
        return "the human driver gives way: it stands, or the CAV has the right of way or is in the junction already"
    return f"the CAV is through ({time:.1f} s) before the human driver can be there"


def without_cycles(
    precedences: Sequence[Precedence], times: Mapping[str, float]
) -> tuple[tuple[Precedence, ...], tuple[str, ...]]:
    """Drop precedences until none of them contradict, and line all vehicles up accordingly.

    CAVs are scheduled one after another, so a circle always runs through a human driver, and one of its links
    contradicts the times; that link is dropped. A CAV that is not told to go first has to be able to wait.
    """
    kept = list(precedences)
    while True:
        ahead: dict[str, set[str]] = {name: set() for name in times}
        for p in kept:
            ahead[p.second].add(p.first)
        try:
            sorter = TopologicalSorter(ahead)
            sorter.prepare()
        except CycleError as error:
            pairs = set(pairwise(error.args[1]))
            links = [p for p in kept if (p.first, p.second) in pairs]
            kept.remove(max(links, key=lambda p: (_gives_up(p, times), p.first, p.second)))
            continue
        sequence: list[str] = []
        ready = list(sorter.get_ready())
        while ready:
            name = min(ready, key=lambda name: (times[name], name))
            sequence.append(name)
            ready.remove(name)
            sorter.done(name)
            ready += sorter.get_ready()
        return tuple(kept), tuple(sequence)


def _gives_up(p: Precedence, times: Mapping[str, float]) -> tuple[bool, float]:
    """Rank a link of a circle: first those that the times contradict most."""
    return times[p.first] > times[p.second], times[p.first] - times[p.second]
