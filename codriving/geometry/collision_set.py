"""Which places on two paths cannot be taken at the same time (the collision set)."""

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from codriving.geometry.box import Footprint, separation
from codriving.geometry.curve import FloatArray
from codriving.geometry.path import Path

IntArray = NDArray[np.intp]

# Footprints that overlap by no more than this only touch [m]; rounding must not decide over a whole row of cells.
TOUCH = 1e-9

_BLOCK = 8  # Path points that are first compared as one box, so that few cells are looked at one by one

_SAFE = 1e-3  # What is decided without a test is clear by this much [m]; rounding is far less


@dataclass(frozen=True, slots=True, eq=False)
class Cells:
    """Pairs of path points, one on each path."""

    i: IntArray  # Indices on the first path (n,)
    j: IntArray  # Indices on the second path (n,)

    def only(self, chosen: NDArray[np.bool_] | IntArray | slice) -> "Cells":
        """Return the cells that a mask (n,) or their numbers choose."""
        return Cells(self.i[chosen], self.j[chosen])


def collision_set(path_i: Path, path_j: Path, footprint: Footprint) -> Cells:
    """Return all pairs of path points at which two footprints overlap, ordered by j and then by i."""
    return overlapping(path_i, path_j, footprint)[0]


def overlapping(path_i: Path, path_j: Path, footprint: Footprint) -> tuple[Cells, FloatArray]:
    """Return the collision set, and the squared distance between the points of each cell (n,) [m2]."""
    near, square = _near_cells(path_i, path_j, footprint)
    overlap = np.ones(len(square), dtype=np.bool_)
    unsure = np.flatnonzero(square >= surely(footprint, TOUCH))
    overlap[unsure] = cell_separation(path_i, path_j, near.only(unsure), footprint) < -TOUCH
    kept = np.flatnonzero(overlap)
    return near.only(kept), square[kept]


def surely(footprint: Footprint, depth: float) -> float:
    """Return the squared distance [m2] below which boxes overlap by more than a depth [m], however they are turned."""
    return max(min(footprint.length, footprint.width) - depth - _SAFE, 0.0) ** 2


def cell_separation(path_i: Path, path_j: Path, cells: Cells, footprint: Footprint) -> FloatArray:
    """Return the signed separation of the two footprints at every cell (n,) [m]; negative if they overlap."""
    i, j = cells.i, cells.j
    dx, dy = (axis_j.take(j) - axis_i.take(i) for axis_i, axis_j in zip(path_i.axes, path_j.axes, strict=True))
    cos, sin = path_i.directions[0].take(i), path_i.directions[1].take(i)
    turn = path_j.headings.take(j) - path_i.headings.take(i)
    return separation(cos * dx + sin * dy, cos * dy - sin * dx, np.cos(turn), np.sin(turn), footprint)


def components(cells: Cells) -> IntArray:
    """Number the connected parts of a set of cells; cells that touch at a side or a corner are connected."""
    if not len(cells.i):
        return np.empty(0, dtype=np.intp)
    breaks = np.flatnonzero((cells.j[1:] != cells.j[:-1]) | (cells.i[1:] != cells.i[:-1] + 1)) + 1
    first = np.concatenate(([0], breaks))
    last = np.concatenate((breaks, [len(cells.i)])) - 1
    roots = _join_runs(cells.j[first], cells.i[first], cells.i[last])
    number = np.cumsum(roots == np.arange(len(roots))) - 1
    return np.repeat(number[roots], last - first + 1)


def _join_runs(rows: IntArray, starts: IntArray, ends: IntArray) -> IntArray:
    """Return for each run of cells in a row the first run that it is connected with."""
    roots = own = np.arange(len(rows))
    above, here = rows.searchsorted(rows - 1), rows.searchsorted(rows)
    for k in range(int((here - above).max())):
        other = np.minimum(above + k, here - 1)
        touches = (other >= above) & (starts <= ends[other] + 1) & (ends >= starts[other] - 1)
        if (touches & (roots != own)).any():
            return np.array(_join_forks(rows.tolist(), starts.tolist(), ends.tolist()), dtype=np.intp)
        roots = np.where(touches, other, roots)
    # Each run hangs on one above it at most: what that one hangs on, until nothing changes.
    while ((further := roots[roots]) != roots).any():
        roots = further
    return roots


def _join_forks(rows: list[int], starts: list[int], ends: list[int]) -> list[int]:
    """Do the same where several runs lead to one."""
    parent = list(range(len(rows)))

    def root(k: int) -> int:
        while parent[k] != k:
            parent[k] = parent[parent[k]]
            k = parent[k]
        return k

    above = 0
    for k, row in enumerate(rows):
        while rows[above] < row - 1:
            above += 1
        m = above
        while rows[m] == row - 1:
            if starts[m] <= ends[k] + 1 and ends[m] >= starts[k] - 1:
                low, high = sorted((root(m), root(k)))
                parent[high] = low
            m += 1
    return [root(k) for k in range(len(rows))]


def _near_cells(path_i: Path, path_j: Path, footprint: Footprint) -> tuple[Cells, FloatArray]:
    """Return the cells that may overlap, ordered by j and then by i, and the squared distances of their points [m2]."""
    blocks_i, blocks_j = _blocks(path_i), _blocks(path_j)
    many_j, many_i = _near_blocks(blocks_j, blocks_i, footprint)
    # Each point of j with the blocks of i that are near its block, in the order of the points.
    rows = (many_j[:, None] * _BLOCK + np.arange(_BLOCK)).ravel()
    order = rows.argsort(kind="stable")
    rows, many_i = rows[order], many_i[order // _BLOCK]
    square = np.zeros((len(rows), _BLOCK))
    for axis_i, axis_j in zip(blocks_i.points, blocks_j.points, strict=True):
        offset = axis_i.take(many_i, axis=0)
        offset -= axis_j.take(rows)[:, None]
        offset *= offset
        square += offset
    flat = square.ravel()
    near = np.flatnonzero(flat <= footprint.length**2 + footprint.width**2 + _SAFE)
    row = near // _BLOCK
    return Cells(near + ((many_i - np.arange(len(rows))) * _BLOCK).take(row), rows.take(row)), flat.take(near)


def _near_blocks(one: "_Blocks", other: "_Blocks", footprint: Footprint) -> tuple[IntArray, IntArray]:
    """Return the pairs of blocks in which footprints may overlap, in order."""
    half_long, half_wide = footprint.length / 2, footprint.width / 2
    # Squared distance of two centres less the square of what their discs reach, as one product.
    (x_a, y_a, r_a), (x_b, y_b, r_b) = (
        (*blocks.boxes[:2], blocks.radii + math.hypot(half_long, half_wide) + _SAFE) for blocks in (one, other)
    )
    ones_a, ones_b = np.ones(len(r_a)), np.ones(len(r_b))
    left = np.stack((-2 * x_a, -2 * y_a, -2 * r_a, x_a * x_a + y_a * y_a - r_a * r_a, ones_a), axis=1)
    right = np.stack((x_b, y_b, r_b, ones_b, x_b * x_b + y_b * y_b - r_b * r_b))
    a, b = np.divmod(np.flatnonzero(left @ right <= 0), len(r_b))
    x_a, y_a, cos_a, sin_a, long_a, wide_a, swing_a = one.boxes.take(a, axis=1)
    x_b, y_b, cos_b, sin_b, long_b, wide_b, swing_b = other.boxes.take(b, axis=1)
    # A footprint that is turned against the box around the points reaches out less than this.
    for long, wide, swing in ((long_a, wide_a, swing_a), (long_b, wide_b, swing_b)):
        long += half_long + _SAFE + half_wide * swing
        wide += half_wide + _SAFE + half_long * swing
    dx, dy = x_b - x_a, y_b - y_a
    c, s = np.abs(cos_a * cos_b + sin_a * sin_b), np.abs(cos_a * sin_b - sin_a * cos_b)
    meet = np.abs(cos_a * dx + sin_a * dy) <= long_a + long_b * c + wide_b * s
    meet &= np.abs(cos_a * dy - sin_a * dx) <= wide_a + wide_b * c + long_b * s
    meet &= np.abs(cos_b * dx + sin_b * dy) <= long_b + long_a * c + wide_a * s
    meet &= np.abs(cos_b * dy - sin_b * dx) <= wide_b + wide_a * c + long_a * s
    kept = np.flatnonzero(meet)
    return a.take(kept), b.take(kept)


@dataclass(frozen=True, slots=True, eq=False)
class _Blocks:
    """Stretches of a path and the boxes around their points."""

    points: FloatArray  # x and y of the points, block by block (2, m, block) [m]; where there is none, not a number
    # Of each box the centre, the unit vector along it, half its length and width, and the sine of the largest turn of
    # the path against it (7, m) [m].
    boxes: FloatArray
    radii: FloatArray  # Half the diagonal of each box (m,) [m]


@lru_cache(maxsize=64)
def _blocks(path: Path) -> _Blocks:
    """Divide a path into blocks, once."""
    count = len(path.headings)
    numbers = np.arange(-(-count // _BLOCK) * _BLOCK).reshape(-1, _BLOCK)
    inside = np.minimum(numbers, count - 1)
    points, headings = path.axes[:, inside], path.headings[inside]
    middle = headings[:, _BLOCK // 2]
    swing = np.sin(np.minimum(np.abs(headings - middle[:, None]).max(axis=1), np.pi / 2))
    cos, sin = np.cos(middle), np.sin(middle)
    x, y = points.transpose(0, 2, 1)
    places = np.array((cos * x + sin * y, cos * y - sin * x))
    low, high = places.min(axis=1), places.max(axis=1)
    (along, across), (long, wide) = (low + high) / 2, (high - low) / 2
    points[:, numbers >= count] = np.nan
    boxes = np.array((cos * along - sin * across, sin * along + cos * across, cos, sin, long, wide, swing))
    return _Blocks(points, boxes, np.hypot(long, wide))
