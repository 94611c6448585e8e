"""The routes that pass by a place."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from codriving.datatypes import Lane, LaneId, Route, beside
from codriving.geometry.curve import FloatArray
from codriving.geometry.lane_path import lane_path
from codriving.geometry.path import Path

CELL = 8.0  # Side of the squares in which it is remembered which points are near [m]


class Nearby:
    """Looks up the routes that pass by a place, all of them at once."""

    def __init__(
        self,
        lanes: Mapping[LaneId, Lane],
        routes: Mapping[str, Route],
        paths: Mapping[str, Path],
        starts: Mapping[tuple[str, LaneId], float],
    ) -> None:
        self._paths = paths
        self._ending = tuple(_ending_lanes(lanes, routes, starts))
        self._names = sorted(paths)
        ordered = [paths[name] for name in self._names]
        self._first = np.cumsum([0] + [len(path.points) for path in ordered[:-1]])
        self._x, self._y = np.concatenate([path.points for path in ordered]).T.copy()
        headings = np.concatenate([path.headings for path in ordered])
        self._cos, self._sin = np.cos(headings), np.sin(headings)
        self._cells: dict[tuple[float, float, float], Square] = {}

    def routes(
        self, x: float, y: float, heading: float | None, tolerance: float = 2.0, angle: float = math.pi / 3
    ) -> tuple[tuple[str, float], ...]:
        """Return the routes that pass by a place, as far as the place and heading of a vehicle tell."""
        cell, found = self._around(x, y, tolerance + 1.0), []
        if cell.paths:
            dx, dy = cell.x - x, cell.y - y
            square = dx * dx + dy * dy
            if heading is not None:
                towards = cell.cos * math.cos(heading) + cell.sin * math.sin(heading)
                square[towards < math.cos(angle)] = np.inf
            nearest = np.minimum.reduceat(square, cell.bounds[:-1]).tolist()
            for k, (name, path) in enumerate(cell.paths):
                if nearest[k] > (tolerance + 1.0) ** 2:
                    continue
                first, last = cell.bounds[k : k + 2]
                index = int(cell.numbers[first + int(square[first:last].argmin())])
                s, lateral = path.project_at(index, x, y)
                if abs(lateral) <= tolerance and -tolerance <= s <= path.length + tolerance:
                    found.append((name, s))
        for name, lane, start, taper in self._ending:
            # A vehicle that has not changed lanes yet is beside the taper, but still on this route.
            s, lateral = lane.project(x, y)
            if abs(lateral) <= tolerance and lane.length - taper <= s <= lane.length + tolerance:
                turned = 0.0 if heading is None else math.remainder(heading - float(lane.heading(s)), math.tau)
                if abs(turned) <= angle and all(name != route for route, _ in found):
                    found.append((name, start + s))
        return tuple(sorted(found))

    def _around(self, x: float, y: float, reach: float) -> "Square":
        """Return the points that may be within reach [m] of a place; worked out once a square."""
        key = (x // CELL, y // CELL, reach)
        if key not in self._cells:
            dx, dy = self._x - (key[0] + 0.5) * CELL, self._y - (key[1] + 0.5) * CELL
            rows = np.flatnonzero(np.hypot(dx, dy) <= reach + CELL)
            owners = np.searchsorted(self._first, rows, side="right") - 1
            numbers, begins = np.unique(owners, return_index=True)
            paths = tuple((self._names[k], self._paths[self._names[k]]) for k in numbers.tolist())
            places = self._x[rows], self._y[rows], self._cos[rows], self._sin[rows]
            bounds = (*begins.tolist(), len(rows))
            self._cells[key] = Square(paths, bounds, *places, rows - self._first[owners])
        return self._cells[key]


@dataclass(frozen=True, slots=True)
class Square:
    """The points of paths near a square, path by path."""

    paths: tuple[tuple[str, Path], ...]
    bounds: tuple[int, ...]  # Where the points of each path begin, and where those of the last one end
    x: FloatArray  # (n,) [m]
    y: FloatArray  # (n,) [m]
    cos: FloatArray  # Of the heading (n,)
    sin: FloatArray  # (n,)
    numbers: NDArray[np.intp]  # What number each is on its path (n,)


def _ending_lanes(
    lanes: Mapping[LaneId, Lane], routes: Mapping[str, Route], starts: Mapping[tuple[str, LaneId], float]
) -> Iterator[tuple[str, Path, float, float]]:
    """The lanes that a route has to leave: its id, their centre line, where they begin on it and the taper [m]."""
    for route in routes.values():
        for lane, other in pairwise(route.lanes):
            if beside(lane, other):
                yield route.id, lane_path(lanes[lane]), starts[route.id, lane], route.taper
