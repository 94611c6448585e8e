"""Joint actions, what they cost each vehicle, the one on which all settle, and each vehicle's share (Shapley value)."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import combinations, product
from math import factorial

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Joint = tuple[int, ...]  # Index of the option of each vehicle

ENUMERATED = 3  # Vehicles up to which every joint action is looked at

SWEEPS = 10  # How often each chooses again at most, where they are too many for that

TOLERANCE = 1e-12  # Costs that differ by less are equal


@dataclass(frozen=True, slots=True)
class Costs:
    """What joint actions cost."""

    own: Array  # Cost of each option of each vehicle, whatever the others do (n, options)
    pair: Array  # Cost of each option of the first vehicle for each option of the second (n, options, n, options)

    def of(self, joints: Sequence[Joint]) -> Array:
        """Return what joint actions cost each vehicle."""
        chosen = np.array(joints, dtype=np.intp).reshape(len(joints), -1)
        who = np.arange(chosen.shape[1])
        met = self.pair[who[:, None], chosen[:, :, None], who[None, :], chosen[:, None, :]]
        return np.asarray(self.own[who, chosen] + met.sum(axis=2))


def blended(costs: Array, participation: float) -> Array:
    """Return what counts for each vehicle: its own cost, and that of all to the degree to which it takes part."""
    return np.asarray(participation * costs.mean(axis=1, keepdims=True) + (1 - participation) * costs)


def settle(costs: Costs, options: Sequence[Sequence[int]], participation: float) -> Joint:
    """Return the joint action on which all settle: none would rather change alone, and it costs all least."""
    if not options:
        return ()
    if len(options) > ENUMERATED:
        found = [_arrive(costs, options, participation, start) for start in _starts(options)]
    else:
        every = list(product(*options))
        found = [joint for joint in every if _is_stable(costs, options, participation, joint)] or every
    totals = costs.of(found).sum(axis=1)
    return min(zip(totals.round(9).tolist(), found, strict=True))[1]


def _variants(joint: Joint, i: int, options: Sequence[int]) -> list[Joint]:
    return [(*joint[:i], option, *joint[i + 1 :]) for option in options]


def _is_stable(costs: Costs, options: Sequence[Sequence[int]], participation: float, joint: Joint) -> bool:
    found = (
        blended(costs.of([joint, *_variants(joint, i, mine)]), participation)[:, i] for i, mine in enumerate(options)
    )
    return not any(counts.min() < counts[0] - TOLERANCE for counts in found)


def _starts(options: Sequence[Sequence[int]]) -> list[Joint]:
    """Return joint actions in which all take the same option, as far as there is one for all."""
    most = max(len(mine) for mine in options)
    return list(dict.fromkeys(tuple(mine[min(k, len(mine) - 1)] for mine in options) for k in range(most)))


def _arrive(costs: Costs, options: Sequence[Sequence[int]], participation: float, joint: Joint) -> Joint:
    """Let one vehicle after another take what is best for it, until none changes any more."""
    for _ in range(SWEEPS):
        before = joint
        for i, mine in enumerate(options):
            variants = [joint, *_variants(joint, i, mine)]
            counts = blended(costs.of(variants), participation)[:, i]
            # The first of equal ones is what it does already, so that the sweeps come to an end.
            joint = variants[int(np.argmin(counts - TOLERANCE * (np.arange(len(variants)) == 0)))]
        if joint == before:
            break
    return joint


MOST = 6  # Players for whom the value is worked out; it needs the worth of every coalition, 64 of them


def shapley(players: Sequence[str], worth: Callable[[frozenset[str]], float]) -> dict[str, float]:
    """Share out what a coalition is worth: what each adds to it, averaged over all orders in which they may join."""
    n = len(players)
    members = [frozenset(some) for size in range(n + 1) for some in combinations(players, size)]
    known = {some: worth(some) for some in members}
    shares = {}
    for player in players:
        others = [p for p in players if p != player]
        shares[player] = sum(
            factorial(size) * factorial(n - size - 1) / factorial(n) * (known[joined | {player}] - known[joined])
            for size in range(n)
            for joined in map(frozenset, combinations(others, size))
        )
    return shares
