"""Post-encroachment time of two vehicles whose routes merge, at the place where they really come together."""

from typing import NamedTuple

import numpy as np

from codriving.datatypes import Track
from codriving.geometry import TRUE, FloatArray, separation

# How far a vehicle is on the ground of the other when it counts as being there [m]. Touching would do, but of two
# bodies that only touch it is not defined how long they do.
_DEEP = 0.05


class _Way(NamedTuple):
    """Rows of one track that may be on common ground."""

    id: str
    time: FloatArray  # (n,) [s]
    x: FloatArray  # (n,) [m]
    y: FloatArray  # (n,) [m]
    heading: FloatArray  # (n,) [rad]

    def between(self, row: int, share: float) -> "_Way":
        """The place between a row and the one after it."""
        return _Way(self.id, *(a[row : row + 1] + share * (a[row + 1 : row + 2] - a[row : row + 1]) for a in self[1:]))


def merging_gap(one: Track, other: Track, rows: slice, other_rows: slice, step: float) -> tuple[str, str, float] | None:
    """Return who merged first, who second, and how long the second came after the first [s].

    The second enters the ground that the first drives over; from when the first has left that place until then is the
    value. It is negative if the first is still there. None if one of them does not get there from elsewhere.

    Args:
        rows: Rows of the one that count.
        other_rows: The same for the other.
    """
    a, b = _way(one, rows, step), _way(other, other_rows, step)
    if not len(a.x) or not len(b.x):
        return None
    apart = _apart(a, b)
    if apart[0].min() < 0 or apart[:, 0].min() < 0:
        return None
    found = [
        (gap, first.id, second.id)
        for first, second, m in ((a, b, apart), (b, a, apart.T))
        if (gap := _gap(first, second, m)) is not None
    ]
    # If only one of the two left the place of the other, it was first only if it did so before the other came.
    if not found or (len(found) == 1 and found[0][0] < 0):
        return None
    value, first_id, second_id = max(found)
    return first_id, second_id, value


def _way(track: Track, rows: slice, step: float) -> _Way:
    time: FloatArray = step * (track.first_step + np.arange(len(track.x), dtype=np.float64))
    return _Way(track.id, np.asarray(time[rows], dtype=np.float64), track.x[rows], track.y[rows], track.heading[rows])


def _apart(a: _Way, b: _Way) -> FloatArray:
    """Separation of the two at every pair of rows (n, m) [m]; inf where they are far from one another."""
    dx, dy = b.x - a.x[:, None], b.y - a.y[:, None]
    square = dx * dx + dy * dy
    stride = max(float(np.hypot(np.diff(w.x), np.diff(w.y)).max(initial=0.0)) for w in (a, b))
    near = np.nonzero(square < (np.hypot(TRUE.length, TRUE.width) + 2 * stride) ** 2)
    apart = np.full(square.shape, np.inf)
    apart[near] = _separation(dx[near], dy[near], a.heading[near[0]], b.heading[near[1]])
    return apart


def _separation(dx: FloatArray, dy: FloatArray, heading: FloatArray, other: FloatArray) -> FloatArray:
    cos, sin = np.cos(heading), np.sin(heading)
    turn = other - heading
    return separation(cos * dx + sin * dy, cos * dy - sin * dx, np.cos(turn), np.sin(turn), TRUE)


def _gap(first: _Way, second: _Way, apart: FloatArray) -> float | None:
    """How long after the first has left a place the second enters it [s]; rows of `apart` are those of the first."""
    nearest = apart.min(axis=0)
    inside = np.flatnonzero(nearest < -_DEEP)
    if not len(inside) or (row := int(inside[0])) == 0:
        return None
    before, after = float(nearest[row - 1]), float(nearest[row])
    share = (before + _DEEP) / (before - after) if np.isfinite(before) else 1.0
    there = second.between(row - 1, share)
    over = _separation(there.x - first.x, there.y - first.y, first.heading, there.heading)
    last = int(np.flatnonzero(over < 0)[-1]) if (over < 0).any() else len(over) - 1
    if last == len(over) - 1:
        return None
    left = first.time[last] + (first.time[last + 1] - first.time[last]) * over[last] / (over[last] - over[last + 1])
    return float(there.time[0] - left)
