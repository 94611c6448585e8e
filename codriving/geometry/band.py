"""For every place of one vehicle, the stretch that the other must not be on."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from codriving.geometry.curve import FloatArray

_BULGE = 0.1
"""What the limit may bulge between two rows beyond both of them [m]; 0.09 m was seen on turns of 9 m radius."""


@dataclass(frozen=True, eq=False)
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
        return np.asarray(np.maximum(*self._neighbours(s, self._padded_high)) + _BULGE)

    def lowest(self, s: ArrayLike) -> FloatArray:
        """Return the start of the blocked stretch [m] while one is at s [m]; +inf outside the zone."""
        return np.asarray(np.minimum(*self._neighbours(s, self._padded_low)) - _BULGE)

    # Rows -1 and n are the places where the zone has just not begun or has just ended.
    @cached_property
    def _padded_high(self) -> FloatArray:
        return np.concatenate(([-np.inf], self.high, [-np.inf]))

    @cached_property
    def _padded_low(self) -> FloatArray:
        return np.concatenate(([np.inf], self.low, [np.inf]))

    def _neighbours(self, s: ArrayLike, padded: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the values at the row before and the row after each s."""
        row = (np.asarray(s, dtype=np.float64) - self.start) / self.spacing
        # Outside the zone every row is as good as the padding; numpy's clip costs more than these two.
        row = np.minimum(np.maximum(row, -1), len(padded) - 2)
        return padded[np.floor(row).astype(np.intp) + 1], padded[np.ceil(row).astype(np.intp) + 1]


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
