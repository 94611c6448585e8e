"""Post-encroachment time of two vehicles at the place where they really come together."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from codriving.datatypes import Track
from codriving.geometry import FloatArray, Footprint, separation

# How far a vehicle is on the ground of the other when it counts as being there [m]. Touching would do, but of two
# bodies that only touch it is not defined how long they do.
_DEEP = 0.05


Selection = slice | NDArray[np.intp]


class Way(NamedTuple):
    """Rows of one track that may be on common ground."""

    id: str
    footprint: Footprint
    time: FloatArray  # (n,) [s]
    x: FloatArray  # (n,) [m]
    y: FloatArray  # (n,) [m]
    heading: FloatArray  # (n,) [rad]

    def between(self, row: int, share: float) -> "Way":
        """The place between a row and the one after it."""
        columns = (self.time, self.x, self.y, self.heading)
        there = (a[row : row + 1] + share * (a[row + 1 : row + 2] - a[row : row + 1]) for a in columns)
        return Way(self.id, self.footprint, *there)


def merging_gap(one: Track, other: Track, rows: slice, other_rows: slice, step: float) -> tuple[str, str, float] | None:
    """Return who merged first, who second, and how long the second came after the first [s].

    The second enters the ground that the first drives over; from when the first has left that place until then is the
    value. It is negative if the first is still there. None if one of them does not get there from elsewhere.

    Args:
        rows: Rows of the one that count.
        other_rows: The same for the other.
    """
    return gap(way(one, rows, step), way(other, other_rows, step))


def gap(a: Way, b: Way, laps: bool = False) -> tuple[str, str, float] | None:
    """Return the same of two ways.

    Args:
        laps: Whether a vehicle may come by several times; what counts then is its last time before the other one.
    """
    if not len(a.x) or not len(b.x):
        return None
    apart = _apart(a, b)
    if apart[0].min() < 0 or apart[:, 0].min() < 0:
        return None
    found = [
        (value, first.id, second.id)
        for first, second, m in ((a, b, apart), (b, a, apart.T))
        if (value := _gap(first, second, m, laps)) is not None
    ]
    # If only one of the two left the place of the other, it was first only if it did so before the other came.
    if not found or (not laps and len(found) == 1 and found[0][0] < 0):
        return None
    value, first_id, second_id = max(found)
    return first_id, second_id, value


def way(track: Track, rows: Selection, step: float) -> Way:
    """Choose rows of a track."""
    time = np.asarray(step * (track.first_step + np.arange(len(track.x), dtype=np.float64))[rows], dtype=np.float64)
    footprint = Footprint(track.length, track.width)
    # Recordings have headings from -pi to pi, between which there is no mean where one turns past pi.
    heading = np.unwrap(track.heading)[rows]
    return Way(track.id, footprint, time, track.x[rows], track.y[rows], heading)


def _apart(a: Way, b: Way) -> FloatArray:
    """Separation of the two at every pair of rows (n, m) [m]; inf where they are far from one another."""
    dx, dy = b.x - a.x[:, None], b.y - a.y[:, None]
    square = dx * dx + dy * dy
    stride = max(float(np.hypot(np.diff(w.x), np.diff(w.y)).max(initial=0.0)) for w in (a, b))
    reach = sum(float(np.hypot(w.footprint.length, w.footprint.width)) for w in (a, b)) / 2
    near = np.nonzero(square < (reach + 2 * stride) ** 2)
    apart = np.full(square.shape, np.inf)
    sizes = (a.footprint, b.footprint)
    apart[near] = box_separation(dx[near], dy[near], a.heading[near[0]], b.heading[near[1]], sizes)
    return apart


def box_separation(
    dx: FloatArray, dy: FloatArray, heading: FloatArray, other: FloatArray, sizes: tuple[Footprint, Footprint]
) -> FloatArray:
    """Return how far boxes with these headings are apart [m], negative if they overlap."""
    cos, sin = np.cos(heading), np.sin(heading)
    turn = other - heading
    return separation(cos * dx + sin * dy, cos * dy - sin * dx, np.cos(turn), np.sin(turn), *sizes)


def _gap(first: Way, second: Way, apart: FloatArray, laps: bool) -> float | None:
    """How long after the first has left a place the second enters it [s]; rows of `apart` are those of the first."""
    nearest = apart.min(axis=0)
    inside = np.flatnonzero(nearest < -_DEEP)
    if not len(inside) or (row := int(inside[0])) == 0:
        return None
    before, after = float(nearest[row - 1]), float(nearest[row])
    share = (before + _DEEP) / (before - after) if np.isfinite(before) else 1.0
    there = second.between(row - 1, share)
    over = box_separation(
        there.x - first.x, there.y - first.y, first.heading, there.heading, (first.footprint, second.footprint)
    )
    on_it = over < 0
    if laps:
        # The first row of each visit, and whether that begins before the second is there.
        begins = np.flatnonzero(on_it & ~np.concatenate(([False], on_it[:-1])))
        before_it = begins[first.time[begins] <= there.time[0]]
        if not len(before_it):
            return None
        left_it = np.flatnonzero(~on_it[before_it[-1] :])
        on_it = np.arange(len(on_it)) < (before_it[-1] + left_it[0] if len(left_it) else len(on_it))
    last = int(np.flatnonzero(on_it)[-1]) if on_it.any() else len(over) - 1
    if last == len(over) - 1:
        return None
    if laps:
        return float(there.time[0]) - _left(first, there, last)
    left = first.time[last] + (first.time[last + 1] - first.time[last]) * over[last] / (over[last] - over[last + 1])
    return float(there.time[0] - left)


def _left(first: Way, there: Way, last: int) -> float:
    """When the first leaves a place between two rows [s]; rows of a recording may be metres apart."""
    share = np.linspace(0.0, 1.0, 33)
    x, y, heading = (a[last] + share * (a[last + 1] - a[last]) for a in (first.x, first.y, first.heading))
    over = box_separation(there.x - x, there.y - y, heading, there.heading, (first.footprint, there.footprint))
    k = int(np.flatnonzero(over < 0)[-1])
    return float(first.time[last] + share[k] * (first.time[last + 1] - first.time[last]))
