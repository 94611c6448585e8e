"""What a player of a driving game wants: to get on, smoothly, and at a time gap from others."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from codriving.errors import ConfigError

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Temper:
    """How a player weighs its interests.

    The published game writes the safety term as 1/TTC with a positive sign, which would reward danger; a decreasing
    function of the gap in time is what is meant.

    Attributes:
        risk_time: Gap in time at which the risk has fallen to 1/e [s].

    Raises:
        ConfigError: If a number is out of range.
    """

    efficiency: float
    comfort: float
    safety: float
    risk_time: float
    share: float

    def __post_init__(self) -> None:
        for key in ("efficiency", "comfort", "safety"):
            if not 0 <= getattr(self, key) <= 100:
                raise ConfigError(f"{key} must be 0 to 100, got {getattr(self, key):g}")
        if not 0.05 <= self.risk_time <= 20:
            raise ConfigError(f"risk_time must be 0.05 to 20 s, got {self.risk_time:g}")
        if not 0 <= self.share <= 1:
            raise ConfigError(f"share must be 0 to 1, got {self.share:g}")

    def payoff(self, progress: Array, accelerations: Array, gaps: Array, overlaps: NDArray[np.bool_]) -> Array:
        """Return the payoff of every outcome of a game.

        Args:
            accelerations: Acceleration [m/s2], likewise.
            gaps: Gap in time between the two, 0 or more (n, m) [s].
            overlaps: Whether the two collide (n, m).
        """
        risk = np.exp(-gaps / self.risk_time)
        return np.asarray(
            self.efficiency * progress
            - self.comfort * accelerations**2 / HARDEST**2
            - self.safety * risk
            - CRASH * overlaps
        )


CRASH = 10.0
"""What a predicted collision costs."""

HARDEST = 4.0
"""Acceleration that costs the whole weight of comfort [m/s2]."""
