"""A route laid out on the road: where a vehicle is along it, and on which of its lanes."""

import math
from bisect import bisect_right
from dataclasses import dataclass
from itertools import pairwise, zip_longest

import numpy as np
from numpy.typing import NDArray

from codriving.datatypes.road import LaneId, Route, beside
from codriving.errors import ScenarioError
from codriving.geometry.path import Path
from codriving.geometry.road_map import RoadMap

SINK_MARGIN = 8.0
"""A vehicle leaves the road this far before the end of its route [m]."""

CELL = 8.0
"""Side of the squares in which a way notes where it passes [m]."""

NEARBY = 10.0
"""From a square that a way does not note, every point of it is farther than this [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class Way:
    """A route, its centre line, and where each of its lanes begins.

    Attributes:
        starts: Arc length at which each lane of the route begins [m].
        x: The points of the centre line (n,) [m].
        y: The same (n,) [m].
        points: The same one by one, which is faster for a few of them [m].
        headings: Heading at each point [rad].
        spacing: Arc length between two points [m].
        lane_end: Arc length at which a lane ends that has to be left before [m]; inf if there is none.
        ending: That lane, or None.
    """

    route: Route
    path: Path
    starts: tuple[float, ...]
    x: NDArray[np.float64]
    y: NDArray[np.float64]
    points: tuple[tuple[float, float], ...]
    headings: tuple[float, ...]
    spacing: float
    cells: frozenset[tuple[int, int]]
    lane_end: float = math.inf
    ending: LaneId | None = None

    @property
    def end(self) -> float:
        """Arc length at which a vehicle leaves the road at the latest [m]."""
        return self.path.length - SINK_MARGIN

    def lane_at(self, s: float) -> LaneId:
        """Return the lane of the route at an arc length.

        Args:
            s: Arc length along the route [m].
        """
        return self.route.lanes[max(0, bisect_right(self.starts, s) - 1)]

    def changes_after(self, s: float) -> int:
        """Return how many lane changes the route still asks for.

        Args:
            s: Arc length along the route [m].
        """
        lanes = self.route.lanes
        return sum(1 for k, (a, b) in enumerate(pairwise(lanes), start=1) if beside(a, b) and self.starts[k] > s)

    def plan(self, s: float) -> list[LaneId]:
        """Return the lanes still to be driven; where a lane change is asked for, the lane beside only.

        Args:
            s: Arc length along the route [m].
        """
        lanes = self.route.lanes[max(0, bisect_right(self.starts, s) - 1) :]
        return [lane for lane, after in zip_longest(lanes, lanes[1:]) if after is None or not beside(lane, after)]

    def is_near(self, x: float, y: float) -> bool:
        """Whether a point may be within 10 m of the centre line; the answer is quick and errs towards yes.

        Args:
            x: Point [m].
            y: Point [m].
        """
        return (x // CELL, y // CELL) in self.cells

    def follow(self, x: float, y: float, near: float) -> tuple[float, float]:
        """Return arc length and lateral offset [m] of a point that has moved on a little.

        The same numbers as ``path.project(x, y, near)``, by walking from the last place instead of searching around it.

        Args:
            x: Point [m].
            y: Point [m].
            near: Arc length at which the point was seen last [m].
        """
        points, last = self.points, len(self.points) - 1
        k = min(max(round(near / self.spacing), 0), last)
        here = _square(points[k], x, y)
        for direction in (1, -1):
            while 0 <= k + direction <= last and (there := _square(points[k + direction], x, y)) < here:
                k, here = k + direction, there
        if k in (0, last):
            return self.path.project_at(k, x, y)
        _, s, lateral = min(self._on_segment(k - 1, x, y), self._on_segment(k, x, y))
        return s, lateral

    def _on_segment(self, k: int, x: float, y: float) -> tuple[float, float, float]:
        """Return squared distance, arc length and lateral offset against the k-th segment."""
        (x0, y0), (x1, y1) = self.points[k], self.points[k + 1]
        dx, dy, px, py = x1 - x0, y1 - y0, x - x0, y - y0
        t = min(max((px * dx + py * dy) / (dx * dx + dy * dy), 0.0), 1.0)
        distance = (px - t * dx) ** 2 + (py - t * dy) ** 2
        return distance, (k + t) * self.spacing, math.copysign(math.sqrt(distance), dx * py - dy * px)


def _square(point: tuple[float, float], x: float, y: float) -> float:
    dx, dy = point[0] - x, point[1] - y
    return dx * dx + dy * dy


def way(road_map: RoadMap, route: str) -> Way:
    """Lay a route out on its road.

    Raises:
        ScenarioError: If the goal lies where vehicles have already left the road.
    """
    found, path = road_map.routes[route], road_map.paths[route]
    if found.goal > path.length - SINK_MARGIN:
        raise ScenarioError(
            f"route {route!r} of road {road_map.road.name!r} must have its goal {SINK_MARGIN:g} m or more before its "
            f"end at {path.length:.2f} m, where vehicles leave the road; got goal {found.goal:g} m"
        )
    starts = tuple(road_map.lane_start(route, lane) for lane in found.lanes)
    x, y = path.points.T.copy()
    points = tuple(zip(x.tolist(), y.tolist(), strict=True))
    left = [k for k, (a, b) in enumerate(pairwise(found.lanes), start=1) if beside(a, b)]
    lane_end = starts[left[0]] + found.taper / 2 if left else math.inf
    ending = found.lanes[left[0] - 1] if left else None
    headings = tuple(path.headings.tolist())
    return Way(found, path, starts, x, y, points, headings, path.spacing, _cells(x, y), lane_end, ending)


def _cells(x: NDArray[np.float64], y: NDArray[np.float64]) -> frozenset[tuple[int, int]]:
    """Return the squares that hold a place at most `NEARBY` from some point, and a few more."""
    around = range(-math.ceil(NEARBY / CELL), math.ceil(NEARBY / CELL) + 1)
    passed = set(zip((x // CELL).astype(int).tolist(), (y // CELL).astype(int).tolist(), strict=True))
    return frozenset((i + di, j + dj) for i, j in passed for di in around for dj in around)
