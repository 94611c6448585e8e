"""A conflict zone: where two routes meet, and what one vehicle at a place blocks for the other."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from codriving.datatypes import Relation
from codriving.geometry.box import Footprint
from codriving.geometry.curve import FloatArray
from codriving.geometry.path import Path

# What the limit may bulge between two rows beyond both of them [m]; 0.09 m was seen on turns of 9 m radius.
_BULGE = 0.1


@dataclass(frozen=True, eq=False)
class Band:
    """One side of a conflict zone, tabulated over the arc length of one of the two vehicles.

    Between two rows the worse of both holds. A placement that the table calls free is free, but for grazes of less
    than 0.1 m where the zone begins or ends between two rows.
    """

    start: float  # Arc length of the first row [m]
    spacing: float  # Arc length between two rows [m]
    low: FloatArray  # Start of the stretch that is blocked for the other at each row (n,) [m]
    high: FloatArray  # End of that stretch at each row (n,) [m]

    @property
    def begin(self) -> float:
        """A place before which nothing is blocked [m]; a little early, for rounding."""
        return self.start - 1.01 * self.spacing

    def highest(self, s: ArrayLike) -> FloatArray:
        """Return the end of the blocked stretch [m] while one is at s [m]; -inf outside the zone."""
        return np.asarray(self._high.take(self._where(s)))

    def most(self, s: FloatArray) -> FloatArray:
        """Return what `highest` is at most [m] while one is no farther than at s [m]."""
        return np.asarray(self._most)

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
    def _most(self) -> float:
        return float(self._high.max())

    @cached_property
    def _low(self) -> FloatArray:
        padded = np.concatenate(([np.inf], self.low, [np.inf]))
        return _table(padded, np.minimum(padded[:-1], padded[1:])) - _BULGE

    def _where(self, s: ArrayLike) -> NDArray[np.intp]:
        """Return the place of each s in the tables: the numbers of the rows before and after it, added up."""
        # Outside the zone every row is as good as the padding; numpy's clip costs more than these two.
        row = np.asarray(np.subtract(s, self.start, dtype=np.float64))
        row /= self.spacing
        if row.ndim == 0:
            place = min(max(float(row), -1), len(self.high))
            return np.asarray(math.floor(place) + math.ceil(place))
        np.maximum(row, -1, out=row)
        np.minimum(row, len(self.high), out=row)
        before = np.floor(row)
        np.ceil(row, out=row)
        row += before
        return row.astype(np.intp)


def _table(rows: FloatArray, between: FloatArray) -> FloatArray:
    """Put the values between two rows between theirs, from row 0 on; row -1 and what follows it come last."""
    found = np.empty(len(rows) + len(between))
    found[::2], found[1::2] = rows, between
    return np.roll(found, -2)


@dataclass(frozen=True, slots=True)
class FollowingBand:
    """The band of two vehicles on one route: a body length [m] ahead and behind, everywhere."""

    body: float

    @property
    def begin(self) -> float:
        """A place before which nothing is blocked [m]."""
        return -np.inf

    def highest(self, s: ArrayLike) -> FloatArray:
        """Return the place of the leader [m] whose tail touches one's nose at s [m]."""
        return np.asarray(s, dtype=np.float64) + self.body

    def most(self, s: FloatArray) -> FloatArray:
        """Return what `highest` is at most [m] while one is no farther than at s [m]."""
        return self.highest(s)

    def lowest(self, s: ArrayLike) -> FloatArray:
        """Return the place of the follower [m] whose nose touches one's tail at s [m]."""
        return np.asarray(s, dtype=np.float64) - self.body

    def blocked(self, s: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Return `lowest` and `highest` [m] while one is at s [m]."""
        return self.lowest(s), self.highest(s)


@dataclass(frozen=True, slots=True, eq=False)
class ConflictZone:
    """One connected zone of the collision set of two routes, seen from route i; all values are arc lengths [m]."""

    relation: Relation
    entry_i: float  # Where the zone begins on route i; `exit_i` where it ends. The same for route j.
    exit_i: float
    entry_j: float
    exit_j: float
    point_i: float  # Conflict point, where the centre lines are closest
    point_j: float
    merge_i: float | None  # Where the centre lines begin to coincide; None unless converging or weaving
    merge_j: float | None
    split_i: float | None  # Where they stop to coincide; None unless diverging or weaving
    split_j: float | None
    over_i: Band | FollowingBand  # What is blocked on route j, tabulated over route i
    over_j: Band | FollowingBand
    # Whether the vehicle gets into the zone by changing lanes, so that its place does not tell if it is there already.
    changes_i: bool = False
    changes_j: bool = False

    def front(self, s_j: ArrayLike) -> FloatArray:
        """Return the front function [m]: if i goes first, j may be at s_j [m] only while s_i is greater.

        It has the shape of `s_j` and is -inf where j is outside the zone.
        """
        return self.over_j.highest(s_j)

    def back(self, s_j: ArrayLike) -> FloatArray:
        """Return the back function [m]: if i goes second, j may be at s_j [m] only while s_i is smaller.

        It has the shape of `s_j` and is +inf where j is outside the zone.
        """
        return self.over_j.lowest(s_j)

    def blocked(self, s_j: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Return `back` and `front` [m] in one go."""
        return self.over_j.blocked(s_j)

    def mirrored(self) -> "ConflictZone":
        """Return the same zone seen from route j."""
        places = (self.entry_j, self.exit_j, self.entry_i, self.exit_i, self.point_j, self.point_i)
        shared = (self.merge_j, self.merge_i, self.split_j, self.split_i)
        return ConflictZone(self.relation, *places, *shared, self.over_j, self.over_i, self.changes_j, self.changes_i)


def following_zone(path: Path, footprint: Footprint) -> ConflictZone:
    """Return the zone of two vehicles on the same route, which stay a body length apart all along."""
    band = FollowingBand(footprint.length)
    places = (0.0, path.length, 0.0, path.length, 0.0, 0.0)
    return ConflictZone(Relation.FOLLOWING, *places, None, None, None, None, band, band)
