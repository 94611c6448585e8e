"""For every place of one vehicle, the stretch that the other must not be on."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from codriving.geometry.curve import FloatArray

_BULGE = 0.1
"""What the limit may bulge between two rows beyond both of them [m]; 0.09 m was seen on turns of 9 m radius."""


@dataclass(frozen=True, slots=True, eq=False)
class Band:
    """One side of a conflict zone, tabulated over the arc length of one of the two vehicles.

    Between two rows the worse of both holds. A placement that the table calls free is free, but for grazes of less
    than 0.1 m where the zone begins or ends between two rows.

    Attributes:
        start: Arc length of the first row [m].
        spacing: Arc length between two rows [m].
        low: Start of the stretch that is blocked for the other at each row (n,) [m].
        high: End of that stretch at each row (n,) [m].
    """

    start: float
    spacing: float
    low: FloatArray
    high: FloatArray

    def highest(self, s: ArrayLike) -> FloatArray:
        """Return the end of the blocked stretch [m] while one is at s [m]; -inf outside the zone."""
        return np.maximum(*self._neighbours(s, self.high, -np.inf)) + _BULGE

    def lowest(self, s: ArrayLike) -> FloatArray:
        """Return the start of the blocked stretch [m] while one is at s [m]; +inf outside the zone."""
        return np.minimum(*self._neighbours(s, self.low, np.inf)) - _BULGE

    def _neighbours(self, s: ArrayLike, values: FloatArray, outside: float) -> tuple[FloatArray, FloatArray]:
        """Return the values at the row before and the row after each s."""
        row = (np.asarray(s, dtype=np.float64) - self.start) / self.spacing
        # Rows -1 and n are the places where the zone has just not begun or has just ended.
        padded = np.concatenate(([outside], values, [outside]))
        before = np.clip(np.floor(row) + 1, 0, len(values) + 1).astype(np.intp)
        after = np.clip(np.ceil(row) + 1, 0, len(values) + 1).astype(np.intp)
        return padded[before], padded[after]


@dataclass(frozen=True, slots=True)
class FollowingBand:
    """The band of two vehicles on one route: a body length ahead and behind, everywhere.

    Attributes:
        body: Body length [m].
    """

    body: float

    def highest(self, s: ArrayLike) -> FloatArray:
        """Return the place of the leader [m] whose tail touches one's nose at s [m]."""
        return np.asarray(s, dtype=np.float64) + self.body

    def lowest(self, s: ArrayLike) -> FloatArray:
        """Return the place of the follower [m] whose nose touches one's tail at s [m]."""
        return np.asarray(s, dtype=np.float64) - self.body
