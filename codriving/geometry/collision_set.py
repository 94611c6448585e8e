"""Which places on two paths cannot be taken at the same time (the collision set)."""

from dataclasses import dataclass

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


def collision_set(path_i: Path, path_j: Path, footprint: Footprint) -> Cells:
    """Return all pairs of path points at which two footprints overlap, ordered by j and then by i."""
    near = _near_cells(path_i.points, path_j.points, float(np.hypot(footprint.length, footprint.width)))
    found = near.only(cell_separation(path_i, path_j, near, footprint) < -TOUCH)
    order = np.lexsort((found.i, found.j))
    return Cells(found.i[order], found.j[order])


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
    inside = np.arange(_BLOCK)
    i = (blocks_i[:, None, None] * _BLOCK + inside[None, :, None]).repeat(_BLOCK, axis=2).ravel()
    j = (blocks_j[:, None, None] * _BLOCK + inside[None, None, :]).repeat(_BLOCK, axis=1).ravel()
    exists = (i < len(points_i)) & (j < len(points_j))
    i, j = i[exists], j[exists]
    offset = points_i[i] - points_j[j]
    near = np.einsum("nc,nc->n", offset, offset) <= reach**2
    return Cells(i[near], j[near])


def _discs(points: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return centre (m, 2) and radius (m,) of a disc around every block of points."""
    short = -len(points) % _BLOCK
    blocks = np.concatenate((points, np.repeat(points[-1:], short, axis=0))).reshape(-1, _BLOCK, 2)
    centres = (blocks.min(axis=1) + blocks.max(axis=1)) / 2
    radii: FloatArray = np.hypot(*(blocks - centres[:, None]).transpose(2, 0, 1)).max(axis=1)
    return centres, radii
