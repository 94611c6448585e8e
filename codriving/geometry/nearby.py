"""The routes that pass by a place."""

import math
from collections.abc import Iterator, Mapping
from itertools import pairwise

import numpy as np

from codriving.datatypes import Lane, LaneId, Route, beside
from codriving.geometry.lane_path import lane_path
from codriving.geometry.path import Path


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

    def routes(
        self, x: float, y: float, heading: float | None, tolerance: float = 2.0, angle: float = math.pi / 3
    ) -> tuple[tuple[str, float], ...]:
        """Return the routes that pass by a place, as far as the place and heading of a vehicle tell."""
        dx, dy = self._x - x, self._y - y
        square = dx * dx + dy * dy
        if heading is not None:
            towards = self._cos * math.cos(heading) + self._sin * math.sin(heading)
            square[towards < math.cos(angle)] = np.inf
        nearest = np.minimum.reduceat(square, self._first)
        found = []
        for k in np.flatnonzero(nearest <= (tolerance + 1.0) ** 2).tolist():
            path = self._paths[self._names[k]]
            first = int(self._first[k])
            index = int(square[first : first + len(path.points)].argmin())
            s, lateral = path.project_at(index, x, y)
            if abs(lateral) <= tolerance and -tolerance <= s <= path.length + tolerance:
                found.append((self._names[k], s))
        for name, lane, start, taper in self._ending:
            # A vehicle that has not changed lanes yet is beside the taper, but still on this route.
            s, lateral = lane.project(x, y)
            if abs(lateral) <= tolerance and lane.length - taper <= s <= lane.length + tolerance:
                turned = 0.0 if heading is None else math.remainder(heading - float(lane.heading(s)), math.tau)
                if abs(turned) <= angle and all(name != route for route, _ in found):
                    found.append((name, start + s))
        return tuple(sorted(found))


def _ending_lanes(
    lanes: Mapping[LaneId, Lane], routes: Mapping[str, Route], starts: Mapping[tuple[str, LaneId], float]
) -> Iterator[tuple[str, Path, float, float]]:
    """The lanes that a route has to leave: its id, their centre line, where they begin on it and the taper [m]."""
    for route in routes.values():
        for lane, other in pairwise(route.lanes):
            if beside(lane, other):
                yield route.id, lane_path(lanes[lane]), starts[route.id, lane], route.taper
