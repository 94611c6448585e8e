"""From two paths to the conflict zones between them."""

import numpy as np

from codriving.geometry.band import Band
from codriving.geometry.box import Footprint
from codriving.geometry.coincidence import classify
from codriving.geometry.collision_set import Cells, IntArray, cell_separation, collision_set, components
from codriving.geometry.curve import FloatArray
from codriving.geometry.path import Path
from codriving.geometry.zone import ConflictZone

_GRAZE = 0.05
"""A zone in which the footprints overlap by no more than this anywhere is none [m].

Tails swing out on turns: at 6.0 x 3.2 m, cars that turn right out of neighbouring legs graze by 3 cm. Whether a grid
of 0.5 m sees that is chance, and the footprint carries more than half a metre of margin at each side.
"""


def find_zones(path_i: Path, path_j: Path, footprint: Footprint) -> tuple[ConflictZone, ...]:
    """Return every conflict zone of two different routes, in the order in which route i meets them.

    Args:
        footprint: Size of both vehicles [m].
    """
    cells = collision_set(path_i, path_j, footprint)
    depth = -cell_separation(path_i, path_j, cells, footprint)
    part = components(cells)
    zones = [
        _zone(path_i, path_j, cells.only(part == k), footprint)
        for k in range(int(part.max(initial=-1)) + 1)
        if depth[part == k].max() > _GRAZE
    ]
    return tuple(sorted(zones, key=lambda zone: (zone.entry_i, zone.entry_j)))


def _zone(path_i: Path, path_j: Path, cells: Cells, footprint: Footprint) -> ConflictZone:
    over_j = _band(path_i, path_j, cells, footprint)
    order = np.lexsort((cells.j, cells.i))
    over_i = _band(path_j, path_i, Cells(cells.j[order], cells.i[order]), footprint)
    offset = path_i.points[cells.i] - path_j.points[cells.j]
    nearest = int(np.einsum("nc,nc->n", offset, offset).argmin())
    coincidence = classify(path_i, path_j, cells)
    merge_i, merge_j = coincidence.merge or (None, None)
    split_i, split_j = coincidence.split or (None, None)
    return ConflictZone(
        relation=coincidence.relation,
        entry_i=float(over_j.low.min()),
        exit_i=float(over_j.high.max()),
        entry_j=float(over_i.low.min()),
        exit_j=float(over_i.high.max()),
        point_i=float(cells.i[nearest] * path_i.spacing) if merge_i is None else merge_i,
        point_j=float(cells.j[nearest] * path_j.spacing) if merge_j is None else merge_j,
        merge_i=merge_i,
        merge_j=merge_j,
        split_i=split_i,
        split_j=split_j,
        over_i=over_i,
        over_j=over_j,
    )


def _band(path_i: Path, path_j: Path, cells: Cells, footprint: Footprint) -> Band:
    """Tabulate over path j what a connected zone, ordered by j and then by i, blocks on path i."""
    first = np.concatenate(([0], np.flatnonzero(np.diff(cells.j)) + 1))
    last = np.concatenate((first[1:], [len(cells.i)])) - 1
    rows = cells.j[first]
    return Band(
        start=float(rows[0] * path_j.spacing),
        spacing=path_j.spacing,
        low=_limit(path_i, path_j, cells.i[first], rows, -1, footprint),
        high=_limit(path_i, path_j, cells.i[last], rows, 1, footprint),
    )


def _limit(path_i: Path, path_j: Path, i: IntArray, j: IntArray, step: int, footprint: Footprint) -> FloatArray:
    """Return the arc length on path i at which the overlap ends [m], interpolated beyond the last overlapping point."""
    beyond = np.clip(i + step, 0, len(path_i.points) - 1)
    inner = cell_separation(path_i, path_j, Cells(i, j), footprint)
    outer = cell_separation(path_i, path_j, Cells(beyond, j), footprint)
    # At the end of the path there is nothing beyond: the last point itself is the limit.
    share = np.where(beyond == i, 0.0, inner / np.where(beyond == i, 1.0, inner - outer))
    limit: FloatArray = (i + step * share) * path_i.spacing
    return limit
