"""From two paths to the conflict zones between them, and how the two routes meet in each."""

from dataclasses import dataclass

import numpy as np

from codriving.datatypes import Relation
from codriving.geometry.box import Footprint
from codriving.geometry.collision_set import Cells, IntArray, cell_separation, components, overlapping, surely
from codriving.geometry.curve import FloatArray
from codriving.geometry.path import Path
from codriving.geometry.zone import Band, ConflictZone

# A zone in which the footprints overlap by no more than this anywhere is none [m]. Tails swing out on turns: at 6.0 x
# 3.2 m, cars that turn right out of neighbouring legs graze by 3 cm. Whether a grid of 0.5 m sees that is chance, and
# the footprint carries more than half a metre of margin at each side.
_GRAZE = 0.05

_OFFSET = 0.3  # Centre lines closer than this coincide [m]

_ANGLE = np.radians(15.0)  # Centre lines that differ less in heading than this coincide [rad]

_SHORTEST = 5.0  # A shorter common stretch is a mere crossing [m]

_END = 1.0  # A stretch that comes this near to the end of a route touches it [m]


@dataclass(frozen=True, slots=True)
class Coincidence:
    """The stretch on which two centre lines coincide, and what it makes of the conflict."""

    relation: Relation
    merge: tuple[float, float] | None  # Where the centre lines begin to coincide on each route [m], or None
    split: tuple[float, float] | None  # Where they stop on each route [m], or None


def find_zones(path_i: Path, path_j: Path, footprint: Footprint) -> tuple[ConflictZone, ...]:
    """Return every conflict zone of two different routes, in the order in which route i meets them."""
    cells, square = overlapping(path_i, path_j, footprint)
    part = components(cells)
    count = int(part.max(initial=-1)) + 1
    zones = []
    for k in range(count):
        mine = np.flatnonzero(part == k) if count > 1 else slice(None)
        zone, apart = cells.only(mine), square[mine]
        if _meets(path_i, path_j, zone, apart, footprint):
            zones.append(_zone(path_i, path_j, zone, apart, footprint))
    return tuple(sorted(zones, key=lambda zone: (zone.entry_i, zone.entry_j)))


def _meets(path_i: Path, path_j: Path, zone: Cells, square: FloatArray, footprint: Footprint) -> bool:
    """Whether the footprints more than graze in a connected part of the collision set."""
    if square.min() < surely(footprint, _GRAZE):
        return True
    return bool((-cell_separation(path_i, path_j, zone, footprint)).max() > _GRAZE)


def _zone(path_i: Path, path_j: Path, cells: Cells, square: FloatArray, footprint: Footprint) -> ConflictZone:
    over_j = _band(path_i, path_j, *_rows(cells), footprint)
    over_i = _band(path_j, path_i, *_columns(cells, len(path_i.points)), footprint)
    side_by_side = square <= _beside(path_i, path_j) ** 2 + 2 * _OFFSET**2  # These and some more
    coincidence = classify(path_i, path_j, cells.only(np.flatnonzero(side_by_side)))
    merge_i, merge_j = coincidence.merge or (None, None)
    split_i, split_j = coincidence.split or (None, None)
    entry_i, exit_i, entry_j, exit_j = (
        float(s) for s in (over_j.low.min(), over_j.high.max(), over_i.low.min(), over_i.high.max())
    )
    nearest = int(square.argmin())
    point_i = float(cells.i[nearest] * path_i.spacing) if merge_i is None else merge_i
    point_j = float(cells.j[nearest] * path_j.spacing) if merge_j is None else merge_j
    places = (entry_i, exit_i, entry_j, exit_j, point_i, point_j)
    return ConflictZone(coincidence.relation, *places, merge_i, merge_j, split_i, split_j, over_i, over_j)


def _rows(cells: Cells) -> tuple[IntArray, IntArray, IntArray]:
    """Return the points of j in a connected zone, and the first and the last cell on i of each."""
    first = np.concatenate(([0], np.flatnonzero(np.diff(cells.j)) + 1))
    last = np.concatenate((first[1:], [len(cells.i)])) - 1
    return cells.j[first], cells.i[first], cells.i[last]


def _columns(cells: Cells, count: int) -> tuple[IntArray, IntArray, IntArray]:
    """Return the points of i, of which there are `count`, and the first and the last cell on j of each."""
    first, last = np.full(count, -1), np.empty(count, dtype=np.intp)
    # Cells are ordered by j, and of several values that are assigned to one place the last one stays.
    first[cells.i[::-1]] = cells.j[::-1]
    last[cells.i] = cells.j
    columns = np.flatnonzero(first >= 0)
    return columns, first[columns], last[columns]


def _band(path_i: Path, path_j: Path, j: IntArray, first: IntArray, last: IntArray, footprint: Footprint) -> Band:
    """Tabulate over path j what a connected zone blocks on path i, from the first to the last cell of each point."""
    # Where the overlap ends, interpolated between the last overlapping point and the one beyond.
    i, step = np.concatenate((first, last)), np.repeat((-1, 1), len(j))
    beyond = np.clip(i + step, 0, len(path_i.points) - 1)
    cells = Cells(np.concatenate((i, beyond)), np.concatenate((j, j, j, j)))
    inner, outer = cell_separation(path_i, path_j, cells, footprint).reshape(2, -1)
    # At the end of the path there is nothing beyond: the last point itself is the limit.
    share = np.where(beyond == i, 0.0, inner / np.where(beyond == i, 1.0, inner - outer))
    low, high = ((i + step * share) * path_i.spacing).reshape(2, -1)
    return Band(float(j[0] * path_j.spacing), path_j.spacing, low, high)


def classify(path_i: Path, path_j: Path, zone: Cells) -> Coincidence:
    """Tell the kind of a conflict zone.

    The routes follow one another where the stretch touches their starts and ends, converge where it touches an
    end only, diverge where it touches a start only, and weave where it touches neither. A stretch that stops because
    one of the two routes stops counts as touching the end: they stay together for as long as both exist.
    """
    cells = _coincident(path_i, path_j, zone)
    if not len(cells.i):
        return Coincidence(Relation.CROSSING, None, None)
    s_i, s_j = cells.i * path_i.spacing, cells.j * path_j.spacing
    begin, end = (float(s_i.min()), float(s_j.min())), (float(s_i.max()), float(s_j.max()))
    if min(end[0] - begin[0], end[1] - begin[1]) < _SHORTEST:
        return Coincidence(Relation.CROSSING, None, None)
    at_start = min(begin) <= _END
    at_end = min(path_i.length - end[0], path_j.length - end[1]) <= _END
    if at_start:
        return Coincidence(Relation.FOLLOWING if at_end else Relation.DIVERGING, None, None if at_end else end)
    return Coincidence(Relation.CONVERGING if at_end else Relation.WEAVING, begin, None if at_end else end)


def _coincident(path_i: Path, path_j: Path, zone: Cells) -> Cells:
    """Return the cells whose points lie side by side on a common centre line."""
    difference = path_j.headings[zone.j] - path_i.headings[zone.i]
    difference = np.abs(np.remainder(difference + np.pi, 2 * np.pi) - np.pi)
    parallel = zone.only(difference < _ANGLE)
    heading = path_i.headings[parallel.i]
    dx, dy = (path_j.points[parallel.j] - path_i.points[parallel.i]).T
    along = np.abs(np.cos(heading) * dx + np.sin(heading) * dy)
    across = np.abs(np.cos(heading) * dy - np.sin(heading) * dx)
    return parallel.only((along <= _beside(path_i, path_j)) & (across < _OFFSET))


def _beside(path_i: Path, path_j: Path) -> float:
    """How far apart two points are at most along the road that lie side by side [m]."""
    # The two grids are shifted against each other by up to half a spacing.
    return 0.55 * max(path_i.spacing, path_j.spacing)
