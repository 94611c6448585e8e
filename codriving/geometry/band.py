"""For every place of one vehicle, the stretch that the other must not be on."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

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
        return np.asarray(self._high.take(self._where(s)))

    def lowest(self, s: ArrayLike) -> FloatArray:
        """Return the start of the blocked stretch [m] while one is at s [m]; +inf outside the zone."""
        return np.asarray(self._low.take(self._where(s)))

    def blocked(self, s: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Return `lowest` and `highest` [m] while one is at s [m]; the place in the table is looked up once."""
        where = self._where(s)
        return np.asarray(self._low.take(where)), np.asarray(self._high.take(where))

    # Rows -1 and n are the places where the zone has just not begun or has just ended.
    @cached_property
    def _high(self) -> FloatArray:
        padded = np.concatenate(([-np.inf], self.high, [-np.inf]))
        return _table(padded, np.maximum(padded[:-1], padded[1:])) + _BULGE

    @cached_property
    def _low(self) -> FloatArray:
        padded = np.concatenate(([np.inf], self.low, [np.inf]))
        return _table(padded, np.minimum(padded[:-1], padded[1:])) - _BULGE

    def _where(self, s: ArrayLike) -> NDArray[np.intp]:
        """Return the place of each s in the tables: the numbers of the rows before and after it, added up."""
        row = np.subtract(s, self.start, dtype=np.float64) / self.spacing
        # Outside the zone every row is as good as the padding; numpy's clip costs more than these two.
        row = np.minimum(np.maximum(row, -1), len(self.high))
        return (np.floor(row) + np.ceil(row)).astype(np.intp)


def _table(rows: FloatArray, between: FloatArray) -> FloatArray:
    """Put the values between two rows between theirs, from row 0 on; row -1 and what follows it come last."""
    found = np.empty(len(rows) + len(between))
    found[::2], found[1::2] = rows, between
    return np.roll(found, -2)


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

    def blocked(self, s: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Return `lowest` and `highest` [m] while one is at s [m]."""
        return self.lowest(s), self.highest(s)
