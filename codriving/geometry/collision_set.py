"""Which places on two paths cannot be taken at the same time (the collision set)."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from codriving.geometry.box import Footprint, separation
from codriving.geometry.curve import FloatArray
from codriving.geometry.path import Path

IntArray = NDArray[np.intp]

# Footprints that overlap by no more than this only touch [m]; rounding must not decide over a whole row of cells.
TOUCH = 1e-9

_BLOCK = 16  # Path points that are first compared as one disc, so that long paths need little memory


@dataclass(frozen=True, slots=True, eq=False)
class Cells:
    """Pairs of path points, one on each path."""

    i: IntArray  # Indices on the first path (n,)
    j: IntArray  # Indices on the second path (n,)

    def only(self, mask: NDArray[np.bool_]) -> "Cells":
        """Return the cells for which a mask (n,) is true."""
        return Cells(self.i[mask], self.j[mask])

    def ordered(self, count: int) -> "Cells":
        """Return the cells ordered by j and then by i; the first path has `count` points."""
        j, i = np.divmod(np.sort(self.j * count + self.i), count)
        return Cells(i, j)


def collision_set(path_i: Path, path_j: Path, footprint: Footprint) -> Cells:
    """Return all pairs of path points at which two footprints overlap, ordered by j and then by i."""
    near = _near_cells(path_i.points, path_j.points, float(np.hypot(footprint.length, footprint.width)))
    return near.only(cell_separation(path_i, path_j, near, footprint) < -TOUCH).ordered(len(path_i.points))


def cell_separation(path_i: Path, path_j: Path, cells: Cells, footprint: Footprint) -> FloatArray:
    """Return the signed separation of the two footprints at every cell (n,) [m]; negative if they overlap."""
    heading = path_i.headings[cells.i]
    turn = path_j.headings[cells.j] - heading
    dx, dy = (path_j.points[cells.j] - path_i.points[cells.i]).T
    cos, sin = np.cos(heading), np.sin(heading)
    return separation(cos * dx + sin * dy, cos * dy - sin * dx, np.cos(turn), np.sin(turn), footprint)


def components(cells: Cells) -> IntArray:
    """Number the connected parts of a set of cells; cells that touch at a side or a corner are connected."""
    if not len(cells.i):
        return np.empty(0, dtype=np.intp)
    breaks = np.flatnonzero((np.diff(cells.j) != 0) | (np.diff(cells.i) != 1)) + 1
    first = np.concatenate(([0], breaks))
    last = np.concatenate((breaks, [len(cells.i)])) - 1
    roots = _join_runs(cells.j[first].tolist(), cells.i[first].tolist(), cells.i[last].tolist())
    _, number = np.unique(roots, return_inverse=True)
    return np.repeat(number, last - first + 1)


def _join_runs(rows: list[int], starts: list[int], ends: list[int]) -> list[int]:
    """Return for each run of cells in a row the first run that it is connected with."""
    runs = zip(pairwise(rows), pairwise(starts), pairwise(ends), strict=True)
    if all(r[1] == r[0] + 1 and s[1] <= e[0] + 1 and e[1] >= s[0] - 1 for r, s, e in runs):
        return [0] * len(rows)
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


def _near_cells(points_i: FloatArray, points_j: FloatArray, reach: float) -> Cells:
    """Return all cells whose points are at most `reach` [m] apart."""
    centres_i, radii_i = _discs(points_i)
    centres_j, radii_j = _discs(points_j)
    between = np.hypot(*(centres_i[:, None] - centres_j[None]).transpose(2, 0, 1))
    blocks_i, blocks_j = np.nonzero(between <= radii_i[:, None] + radii_j[None] + reach)
    # Block by block, so that only what is near is ever numbered.
    square = np.zeros((len(blocks_i), _BLOCK, _BLOCK))
    for x_i, x_j in zip(_blocks(points_i), _blocks(points_j), strict=True):
        offset = x_i[blocks_i][:, :, None] - x_j[blocks_j][:, None, :]
        offset *= offset
        square += offset
    block, i, j = np.nonzero(square <= reach**2)
    return Cells(blocks_i[block] * _BLOCK + i, blocks_j[block] * _BLOCK + j)


def _blocks(points: FloatArray) -> FloatArray:
    """Return both coordinates of all points, block by block (2, m, block); where there is no point, not a number."""
    padded = np.full((-(-len(points) // _BLOCK) * _BLOCK, 2), np.nan)
    padded[: len(points)] = points
    return padded.T.reshape(2, -1, _BLOCK)


def _discs(points: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return centre (m, 2) and radius (m,) of a disc around every block of points."""
    short = -len(points) % _BLOCK
    blocks = np.concatenate((points, np.repeat(points[-1:], short, axis=0))).reshape(-1, _BLOCK, 2)
    centres = (blocks.min(axis=1) + blocks.max(axis=1)) / 2
    radii: FloatArray = np.hypot(*(blocks - centres[:, None]).transpose(2, 0, 1)).max(axis=1)
    return centres, radii
