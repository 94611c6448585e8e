"""An order without cycles: whatever closes a circle of human drivers is taken out again."""

from collections.abc import Mapping, Sequence
from graphlib import CycleError, TopologicalSorter
from itertools import pairwise

from codriving.datatypes.order import Precedence


def without_cycles(
    precedences: Sequence[Precedence], times: Mapping[str, float]
) -> tuple[tuple[Precedence, ...], tuple[str, ...]]:
    """Drop precedences until none of them contradict, and line everybody up accordingly.

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
