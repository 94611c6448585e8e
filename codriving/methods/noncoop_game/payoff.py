"""What a player of a driving game wants, pure Nash equilibria of two players, and what is expected of the other."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from codriving.errors import require_range

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

CRASH = 10.0  # What a predicted collision costs

HARDEST = 4.0  # Acceleration that costs the whole weight of comfort [m/s2]


@dataclass(frozen=True, slots=True)
class Temper:
    """How a player weighs its interests.

    The published game writes the safety term as 1/TTC with a positive sign, which would reward danger; a decreasing
    function of the gap in time is what is meant.
    """

    efficiency: float
    comfort: float
    safety: float
    risk_time: float  # Gap in time at which the risk has fallen to 1/e [s]
    share: float

    def __post_init__(self) -> None:
        for key in ("efficiency", "comfort", "safety"):
            require_range(key, getattr(self, key), 0, 100)
        require_range("risk_time", self.risk_time, 0.05, 20, " s")
        require_range("share", self.share, 0, 1)

    def payoff(self, progress: Array, accelerations: Array, gaps: Array, overlaps: Flags) -> Array:
        """Return the payoff of every outcome of a game."""
        effort = self.comfort * accelerations**2 / HARDEST**2
        risk = self.safety * np.exp(-gaps / self.risk_time)
        return np.asarray(self.efficiency * progress - effort - risk - CRASH * overlaps)


def pure_equilibria(own: Array, other: Array) -> tuple[tuple[int, int], ...]:
    """Return all pairs of actions from which neither gains by changing its own."""
    stable = (own >= own.max(axis=0)) & (other >= other.max(axis=1)[:, None])
    rows, columns = np.nonzero(stable)
    return tuple(zip(rows.tolist(), columns.tolist(), strict=True))


def expected_action(
    own: Array, other: Array, indifference: float, prefer: Callable[[int, int], bool]
) -> tuple[int, int | None]:
    """Return what the second player is expected to do.

    Of several equilibria it is the one with the largest sum of payoffs; of those that are nearly as good, the best one
    that is preferred. Without an equilibrium the second player makes the best of the worst case.
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
    """Return the action of the largest expected payoff, if the other player may be of several types."""
    expected = own[:, list(actions)] @ shares
    return int(np.argmax(expected)), np.asarray(expected)
