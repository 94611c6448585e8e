"""From a schedule to the passing order that everybody is told: the pairs in conflict, each with its reason."""

from collections.abc import Callable, Mapping

from codriving.datatypes.order import PassingOrder, Precedence
from codriving.reasoning.ordering.acyclic import without_cycles
from codriving.reasoning.ordering.negotiated_reasons import reason_human
from codriving.reasoning.ordering.problem import Conflicts, Problem


def agreement(
    problem: Problem,
    times: Mapping[str, float],
    conflicts: Conflicts,
    reason: Callable[[str, str], str],
    binding: bool,
) -> PassingOrder:
    """Write down who goes first in every conflict.

    A human driver goes first unless the CAV is scheduled before the driver can be there.

    Args:
        times: When each CAV passes, in the order in which they go [s].
    """
    rank = {name: k for k, name in enumerate(times)}
    pairs = {(min(c.ego, c.other), max(c.ego, c.other)) for cs in conflicts.values() for c in cs}
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
