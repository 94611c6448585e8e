"""How two routes meet, told from the stretch on which their centre lines coincide."""

from dataclasses import dataclass

import numpy as np

from codriving.datatypes.conflict import Relation
from codriving.geometry.collision_set import Cells
from codriving.geometry.path import Path

_OFFSET = 0.3
"""Centre lines closer than this coincide [m]."""

_ANGLE = np.radians(15.0)
"""Centre lines that differ less in heading than this coincide [rad]."""

_SHORTEST = 5.0
"""A shorter common stretch is a mere crossing [m]."""

_END = 1.0
"""A stretch that comes this near to the end of a route touches it [m]."""


@dataclass(frozen=True, slots=True)
class Coincidence:
    """The stretch on which two centre lines coincide, and what it makes of the conflict.

    Attributes:
        merge: Where the centre lines begin to coincide on each route [m], or None.
        split: Where they stop on each route [m], or None.
    """

    relation: Relation
    merge: tuple[float, float] | None
    split: tuple[float, float] | None


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
    # The two grids are shifted against each other by up to half a spacing.
    return parallel.only((along <= 0.55 * max(path_i.spacing, path_j.spacing)) & (across < _OFFSET))
