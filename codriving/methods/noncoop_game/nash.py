"""Pure Nash equilibria of games of two players, and what is expected of the other one."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def pure_equilibria(own: Array, other: Array) -> tuple[tuple[int, int], ...]:
    """Return all pairs of actions from which neither gains by changing its own.

    Args:
        own: Payoff of the first player, by its action and the other's (n, m).
        other: Payoff of the second player, likewise (n, m).

    Returns:
        Action of the first and of the second player, row by row.
    """
    stable = (own >= own.max(axis=0)) & (other >= other.max(axis=1)[:, None])
    rows, columns = np.nonzero(stable)
    return tuple(zip(rows.tolist(), columns.tolist(), strict=True))


def expected_action(
    own: Array, other: Array, indifference: float, prefer: Callable[[int, int], bool]
) -> tuple[int, int | None]:
    """Return what the second player is expected to do.

    Of several equilibria it is the one with the largest sum of payoffs; of those that are nearly as good, the best one
    that is preferred. Without an equilibrium the second player makes the best of the worst case.

    Args:
        own: Payoff of the first player, by its action and the other's (n, m).
        other: Payoff of the second player, likewise (n, m).

    Returns:
        Action of the second player, and that of the first one in the equilibrium; None if there is none.
    """
    found = pure_equilibria(own, other)
    if not found:
        return int(np.argmax(other.min(axis=0))), None
    total = own + other
    best = max(float(total[pair]) for pair in found)
    good = [pair for pair in found if total[pair] >= best - indifference]
    row, column = max(good, key=lambda pair: (prefer(*pair), float(total[pair]), -pair[0], -pair[1]))
    return column, row


def best_answer(own: Array, actions: tuple[int, ...], shares: Array) -> tuple[int, Array]:
    """Return the action of the largest expected payoff, if the other player may be of several types.

    Args:
        own: Payoff of the first player, by its action and the other's (n, m).

    Returns:
        The action, the first of several that are equally good, and the expected payoff of each (n,).
    """
    expected = own[:, list(actions)] @ shares
    return int(np.argmax(expected)), np.asarray(expected)
