"""What a negotiated order rests on; as long as that holds, no new one is needed."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from graphlib import CycleError, TopologicalSorter

from codriving.datatypes import Instance, Pair

CHANGES = 1.0  # Time by which the one that could be there later must have become the earlier one [s]


@dataclass(frozen=True, slots=True)
class Premise:
    """What was true when an order was agreed on."""

    # By how much the first of each open pair could be there earlier than the second, by their ids [s].
    leads: Mapping[Pair, float]
    held: frozenset[str]
    cannot_stop: frozenset[Pair]  # Pairs the first of which can no longer stop before their zone

    def still_holds(self, now: "Premise") -> bool:
        """Whether an order that was agreed on under this premise can be kept.

        It can if every pair that is open now has been asked about, if in none of them the earlier one has become the
        later one by more than 1 s, and if the same CAVs of these pairs are held up and can no longer stop. Pairs may
        have fallen away.
        """
        if not now.leads.keys() <= self.leads.keys():
            return False
        if any(not _same_side(self.leads[pair], lead) for pair, lead in now.leads.items()):
            return False
        concerned = {name for pair in now.leads for name in pair}
        known = {pair for pair in self.cannot_stop if now.leads.keys() & {pair, pair[::-1]}}
        return self.held & concerned == now.held and known == now.cannot_stop


def premise(instance: Instance, pairs: Iterable[Pair]) -> Premise:
    """Return what an order of some pairs rests on."""
    pairs, vehicles = list(pairs), instance.vehicles
    concerned = [vehicles[name] for name in sorted({name for pair in pairs for name in pair})]
    return Premise(
        leads={
            (one, other): instance.approach(other, one).earliest - instance.approach(one, other).earliest
            for one, other in pairs
        },
        held=frozenset(e.id for e in concerned if any(begin < e.eta < end for begin, end in e.windows)),
        cannot_stop=frozenset(
            pair
            for one, other in pairs
            for pair in ((one, other), (other, one))
            if not instance.approach(*pair).can_stop
        ),
    )


def open_pairs(instance: Instance, pairs: Iterable[Pair]) -> list[Pair]:
    """Return the pairs whose order does not follow from what is physically fixed."""
    after: dict[str, set[str]] = {}
    for first, second in instance.before:
        after.setdefault(first, set()).add(second)
    reached = {name: _reachable(name, after) for name in after}
    return [(a, b) for a, b in pairs if b not in reached.get(a, ()) and a not in reached.get(b, ())]


def find_circle(pairs: Iterable[Pair]) -> list[str] | None:
    """Return a circle of an order, or None if it has none.

    Returns:
        The vehicles of the circle, each before the next one; the first one again at the end.
    """
    sorter: TopologicalSorter[str] = TopologicalSorter()
    for first, second in sorted(pairs):
        sorter.add(second, first)
    try:
        sorter.prepare()
    except CycleError as error:
        return list(error.args[1])
    return None


def _reachable(name: str, after: Mapping[str, set[str]]) -> set[str]:
    found: set[str] = set()
    waiting = [name]
    while waiting:
        new = after.get(waiting.pop(), set()) - found
        found |= new
        waiting += new
    return found


def _same_side(then: float, now: float) -> bool:
    return (then >= 0 and now >= -CHANGES) or (then <= 0 and now <= CHANGES)
