"""What a CAV cannot do of what is proposed, and what has to be instead."""

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise

from codriving.datatypes import Instance, Pair, Precedence, Proposal
from codriving.reasoning import Problem, after_windows, find_circle

HELD_UP = 1.0  # A CAV does not go first if a human driver whom a proposal does not know holds it up longer [s]


def refused(proposal: Proposal, ego: str, problem: Problem) -> list[Precedence]:
    """Return the pairs of a CAV that it cannot keep, each turned round and with the reason."""
    found = []
    for p in (p for p in proposal.pairs if ego in (p.first, p.second)):
        why = fixed(problem.instance, p.second, p.first)
        if not why and p.first == ego:
            why = _held_up(problem, ego, proposal.humans)
        if why:
            found.append(Precedence(p.second, p.first, why))
    return found


def fixed(instance: Instance, first: str, second: str) -> str:
    """Say why one of two CAVs has to go first whatever is agreed on; empty if it has not."""
    if (first, second) not in instance.before:
        return ""
    if instance.vehicles[second].leader == first:
        return f"{first} drives ahead of {second} on the same lane"
    return f"{first} can no longer stop before the conflict zone"


def _held_up(problem: Problem, ego: str, humans: tuple[str, ...]) -> str:
    """Say which human driver, whom a proposal does not know, holds a CAV up that is to go first; empty if none does."""
    if ego not in problem.instance.vehicles:
        return ""
    eta, passages = problem.instance.vehicles[ego].eta, problem.passages.get(ego, {})
    known = after_windows(eta, [span for human, span in passages.items() if human in humans])
    for human, span in sorted(passages.items()):
        if human not in humans and after_windows(known, [span]) > known + HELD_UP:
            return f"{ego} has to let {human} pass, a human driver whom the proposal does not know"
    return ""


def with_given(problem: Problem, pairs: Iterable[Pair]) -> Problem:
    """Return a problem in which the order of some pairs is fixed, as if it were physical."""
    instance = problem.instance
    before = instance.before | set(pairs)
    return problem if before == instance.before else replace(problem, instance=replace(instance, before=before))


def without_circles(
    given: Mapping[Pair, str], instance: Instance, weakest: Callable[[Sequence[Pair]], Pair]
) -> dict[Pair, str]:
    """Leave out the weakest pair of each circle, until what is left and what is physically fixed form none."""
    kept, before = {pair: why for pair, why in given.items() if pair[::-1] not in instance.before}, set(instance.before)
    while (circle := find_circle({*kept, *before})) is not None:
        links = [pair for pair in pairwise(circle) if pair in kept]
        if links:
            del kept[weakest(links)]
        else:
            # Vehicles that overlap already can be fixed in a circle.
            before -= set(pairwise(circle))
    return kept


def not_in(dear: Collection[Pair]) -> Callable[[Sequence[Pair]], Pair]:
    """Let those be the weakest pairs that are not dear."""
    return lambda links: min(links, key=lambda pair: (pair in dear, pair))
