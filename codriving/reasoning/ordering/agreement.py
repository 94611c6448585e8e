"""From a schedule to the passing order: the pairs in conflict, each with its reason, and no cycle among them."""

from collections.abc import Callable, Mapping, Sequence
from graphlib import CycleError, TopologicalSorter
from itertools import pairwise
from math import inf

from codriving.datatypes.order import PassingOrder, Precedence
from codriving.reasoning.moment import Moment
from codriving.reasoning.ordering.problem import Problem


def agreement(
    moment: Moment,
    problem: Problem,
    times: Mapping[str, float],
    reason: Callable[[str, str], str],
    binding: bool,
) -> PassingOrder:
    """Write down who goes first in every conflict.

    A human driver goes first unless the CAV is scheduled before the driver can be there.

    Args:
        times: When each CAV passes, in the order in which they go [s].
    """
    rank = {name: k for k, name in enumerate(times)}
    pairs = {(min(c.ego, c.other), max(c.ego, c.other)) for cs in moment.conflicts.values() for c in cs}
    precedences = []
    for pair in sorted(pairs):
        if rank.keys() >= set(pair):
            first, second = sorted(pair, key=rank.__getitem__)
            precedences.append(Precedence(first, second, reason(first, second)))
    arrivals = dict(times)
    for ego, people in problem.passages.items():
        for human, (begin, end) in people.items():
            human_first = times[ego] > begin
            first, second = (human, ego) if human_first else (ego, human)
            precedences.append(Precedence(first, second, reason_human(human_first, begin, end, times[ego])))
            arrivals[human] = min(arrivals.get(human, begin), begin)
    kept, sequence = without_cycles(precedences, arrivals)
    return PassingOrder(sequence, kept, binding)


def reason_human(human_first: bool, begin: float, end: float, time: float) -> str:
    """Explain the order of a CAV and a human driver.

    Args:
        begin: Time from which the CAV could no longer pass in front [s].
        end: Time from which the CAV can pass behind [s].
        time: When the CAV will pass [s].
    """
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

    Args:
        times: When each vehicle is expected to pass [s]; settles what the pairs leave open.

    Returns:
        The precedences that are kept, and all vehicles from first to last.
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
            circle = error.args[1]
            pairs = set(pairwise(circle))
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
