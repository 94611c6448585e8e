"""The Shapley value: what each player adds to a coalition, averaged over all orders in which they may join it."""

from collections.abc import Callable, Sequence
from itertools import combinations
from math import factorial

MOST = 6
"""Players for whom the value is worked out; it needs the worth of every coalition, 64 of them."""


def shapley(players: Sequence[str], worth: Callable[[frozenset[str]], float]) -> dict[str, float]:
    """Share out what a coalition is worth.

    Returns:
        Share of each player, by id; they add up to the worth of all less that of nobody.

    Raises:
        ValueError: If there are too many players.
    """
    n = len(players)
    if n > MOST:
        raise ValueError(f"shares are worked out for {MOST} players at most, got {n}")
    known = {
        frozenset(members): worth(frozenset(members))
        for size in range(n + 1)
        for members in combinations(players, size)
    }
    shares = {}
    for player in players:
        others = [p for p in players if p != player]
        shares[player] = sum(
            factorial(size) * factorial(n - size - 1) / factorial(n) * (known[joined | {player}] - known[joined])
            for size in range(n)
            for joined in map(frozenset, combinations(others, size))
        )
    return shares
