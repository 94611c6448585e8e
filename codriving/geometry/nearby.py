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
from codriving.geometry.path import STRAIGHT, Path, nearest_from, squared_distance

_ROUNDING = 1e-5  # More than what a place beside such a line [m] or a heading against it [rad] may be wrong by

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
        cell = self._around(x, y, tolerance + 1.0)
        found: list[tuple[str, float]] = []
        curved = cell.curved
        for stretch in cell.straight:
            index = stretch.nearest(x, y, heading, tolerance, angle)
            if index is None:
                continue
            if index < 0:
                # Too close to the angle to tell it from one heading.
                curved = cell.all
                found.clear()
                break
            s, lateral = stretch.path.project_at(index, x, y)
            if abs(lateral) <= tolerance and -tolerance <= s <= stretch.path.length + tolerance:
                found.append((stretch.name, s))
        if curved.paths:
            dx, dy = curved.x - x, curved.y - y
            square = dx * dx + dy * dy
            if heading is not None:
                towards = curved.cos * math.cos(heading) + curved.sin * math.sin(heading)
                square[towards < math.cos(angle)] = np.inf
            nearest = np.minimum.reduceat(square, curved.bounds[:-1]).tolist()
            for k, (name, path) in enumerate(curved.paths):
                if nearest[k] > (tolerance + 1.0) ** 2:
                    continue
                first, last = curved.bounds[k : k + 2]
                index = int(curved.numbers[first + int(square[first:last].argmin())])
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
            numbers = rows - self._first[owners]
            straight = {}
            for k in np.unique(owners).tolist():
                name = self._names[k]
                stretch = straight_stretch(name, self._paths[name], numbers[owners == k])
                if stretch is not None:
                    straight[k] = stretch
            curved = ~np.isin(owners, list(straight))
            self._cells[key] = Square(
                tuple(straight.values()), self._points(rows[curved], owners[curved]), self._points(rows, owners)
            )
        return self._cells[key]

    def _points(self, rows: NDArray[np.intp], owners: NDArray[np.intp]) -> "Points":
        names, begins = np.unique(owners, return_index=True)
        paths = tuple((self._names[k], self._paths[self._names[k]]) for k in names.tolist())
        places = self._x[rows], self._y[rows], self._cos[rows], self._sin[rows]
        return Points(paths, (*begins.tolist(), len(rows)), *places, rows - self._first[owners])


@dataclass(frozen=True, slots=True)
class Points:
    """Points of paths, path by path."""

    paths: tuple[tuple[str, Path], ...]
    bounds: tuple[int, ...]  # Where the points of each path begin, and where those of the last one end
    x: FloatArray  # (n,) [m]
    y: FloatArray  # (n,) [m]
    cos: FloatArray  # Of the heading (n,)
    sin: FloatArray  # (n,)
    numbers: NDArray[np.intp]  # What number each is on its path (n,)


@dataclass(frozen=True, slots=True)
class Stretch:
    """Points of a path that lie on a straight line."""

    name: str
    path: Path
    first: int
    places: tuple[tuple[float, float], ...]  # (n,) [m]
    heading: float  # [rad]
    cos: float
    sin: float

    def nearest(self, x: float, y: float, heading: float | None, tolerance: float, angle: float) -> int | None:
        """Return the number of the nearest point; None if the place is too far or turned against it, -1 in doubt."""
        if heading is not None:
            turned = abs(math.remainder(heading - self.heading, math.tau)) - angle
            if turned > _ROUNDING:
                return None
            if turned > -_ROUNDING:
                return -1
        places = self.places
        dx, dy = x - places[0][0], y - places[0][1]
        if abs(dy * self.cos - dx * self.sin) > tolerance + _ROUNDING:
            return None
        k = round((dx * self.cos + dy * self.sin) / self.path.spacing)
        k = nearest_from(places, k, x, y, 0, len(places) - 1)
        return None if squared_distance(places[k], x, y) > (tolerance + 1.0) ** 2 else self.first + k


@dataclass(frozen=True, slots=True)
class Square:
    """The points of paths near a square: those on straight lines, the others, and all."""

    straight: tuple[Stretch, ...]
    curved: Points
    all: Points


def straight_stretch(name: str, path: Path, numbers: NDArray[np.intp]) -> Stretch | None:
    """Return some points of a path as a stretch, or None if they are not one after another on a straight line."""
    first, last = int(numbers[0]), int(numbers[-1])
    points, headings = path.points[first : last + 1], path.headings[first : last + 1]
    if last - first + 1 != len(numbers) or np.ptp(headings) > STRAIGHT:
        return None
    cos, sin = math.cos(headings[0]), math.sin(headings[0])
    along = np.arange(len(numbers))[:, None] * path.spacing * (cos, sin)
    if np.abs(points[0] + along - points).max() > STRAIGHT:
        return None
    return Stretch(name, path, first, tuple((x, y) for x, y in points.tolist()), float(headings[0]), cos, sin)


def _ending_lanes(
    lanes: Mapping[LaneId, Lane], routes: Mapping[str, Route], starts: Mapping[tuple[str, LaneId], float]
) -> Iterator[tuple[str, Path, float, float]]:
    """The lanes that a route has to leave: its id, their centre line, where they begin on it and the taper [m]."""
    for route in routes.values():
        for lane, other in pairwise(route.lanes):
            if beside(lane, other):
                yield route.id, lane_path(lanes[lane]), starts[route.id, lane], route.taper
