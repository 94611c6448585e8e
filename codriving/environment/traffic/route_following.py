"""Route following: a route laid out on the road, and vehicles that know where they are along it."""

import math
from bisect import bisect_right
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise, zip_longest
from typing import Self

import numpy as np
from highway_env.road.lane import AbstractLane
from highway_env.road.road import Road
from highway_env.vehicle.objects import RoadObject
from numpy.typing import NDArray

from codriving.datatypes import Kind, LaneId, Route, Start, beside
from codriving.environment.motion import PlainMotion, move
from codriving.environment.settings import Corrections
from codriving.errors import ScenarioError
from codriving.geometry import Path, RoadMap, SpeedProfile, squared_distance

SINK_MARGIN = 8.0  # A vehicle leaves the road this far before the end of its route [m]

CELL = 8.0  # Side of the squares in which a route notes where it passes [m]

NEARBY = 10.0  # From a square that a route does not note, every point of it is farther than this [m]


@dataclass(frozen=True, slots=True, eq=False)
class RoutePath:
    """A route, its centre line, and where each of its lanes begins."""

    route: Route
    path: Path
    starts: tuple[float, ...]  # Arc length at which each lane of the route begins [m]
    x: NDArray[np.float64]  # The points of the centre line (n,) [m]
    y: NDArray[np.float64]  # The same (n,) [m]
    points: tuple[tuple[float, float], ...]  # The same one by one, which is faster for a few of them [m]
    headings: tuple[float, ...]  # Heading at each point [rad]
    spacing: float  # Arc length between two points [m]
    cells: frozenset[tuple[int, int]]
    directions: tuple[tuple[float, float], ...]  # Cosine and sine of the heading at each point
    is_straight: bool  # Whether the heading is the same everywhere
    lane_end: float = math.inf  # Arc length at which a lane ends that has to be left before [m]; inf if there is none
    ending: LaneId | None = None  # That lane, or None
    profile: SpeedProfile | None = None  # How fast it can be driven, or None if vehicles have no limits

    @property
    def end(self) -> float:
        """Arc length at which a vehicle leaves the road at the latest [m]."""
        return self.path.length - SINK_MARGIN

    def lane_at(self, s: float) -> LaneId:
        """Return the lane of the route at an arc length [m]."""
        return self.route.lanes[max(0, bisect_right(self.starts, s) - 1)]

    def changes_after(self, s: float) -> int:
        """Return how many lane changes the route still needs after an arc length [m]."""
        pairs = zip(pairwise(self.route.lanes), self.starts[1:], strict=True)
        return sum(beside(*pair) and start > s for pair, start in pairs)

    def plan(self, s: float) -> list[LaneId]:
        """Return the lanes still to be driven after an arc length [m]; at a lane change, the lane beside only."""
        lanes = self.route.lanes[max(0, bisect_right(self.starts, s) - 1) :]
        return [lane for lane, after in zip_longest(lanes, lanes[1:]) if after is None or not beside(lane, after)]

    def is_near(self, x: float, y: float) -> bool:
        """Whether a point [m] may be within 10 m of the centre line; the answer is quick and errs towards yes."""
        return (x // CELL, y // CELL) in self.cells

    def follow(self, x: float, y: float, near: float) -> tuple[float, float]:
        """Return arc length and lateral offset [m] of a point that has moved on a little.

        The same numbers as ``path.project(x, y, near)``, by walking from the last arc length.
        """
        points, last = self.points, len(self.points) - 1
        k = min(max(round(near / self.spacing), 0), last)
        here = squared_distance(points[k], x, y)
        for direction in (1, -1):
            while 0 <= k + direction <= last and (there := squared_distance(points[k + direction], x, y)) < here:
                k, here = k + direction, there
        return self.path.project_at(k, x, y)


def route_path(road_map: RoadMap, route: str, profile: SpeedProfile | None = None) -> RoutePath:
    """Lay a route out on its road."""
    found, path = road_map.routes[route], road_map.paths[route]
    if found.goal > path.length - SINK_MARGIN:
        raise ScenarioError(
            f"route {route!r} of road {road_map.road.name!r} must have its goal {SINK_MARGIN:g} m or more before its "
            f"end at {path.length:.2f} m, where vehicles leave the road; got goal {found.goal:g} m"
        )
    starts = tuple(road_map.lane_start(route, lane) for lane in found.lanes)
    x, y = path.points.T.copy()
    points, headings = tuple(zip(x.tolist(), y.tolist(), strict=True)), tuple(path.headings.tolist())
    changes = zip(pairwise(found.lanes), starts[1:], strict=True)
    left: tuple[float, LaneId | None] = next(
        ((s + found.taper / 2, lane) for (lane, other), s in changes if beside(lane, other)), (math.inf, None)
    )
    directions = tuple(zip(np.cos(path.headings).tolist(), np.sin(path.headings).tolist(), strict=True))
    shape = points, headings, path.spacing, _cells(x, y), directions, path.is_straight
    return RoutePath(found, path, starts, x, y, *shape, left[0], left[1], profile)


def _cells(x: NDArray[np.float64], y: NDArray[np.float64]) -> frozenset[tuple[int, int]]:
    """Return the squares that hold a place at most `NEARBY` from some point, and a few more."""
    around = range(-math.ceil(NEARBY / CELL), math.ceil(NEARBY / CELL) + 1)
    passed = set(zip((x // CELL).astype(int).tolist(), (y // CELL).astype(int).tolist(), strict=True))
    return frozenset((i + di, j + dj) for i, j in passed for di in around for dj in around)


def plain(lane: LaneId) -> LaneId:
    """Return a lane id without numpy's integers, which highway-env leaves after a lane change."""
    return lane[0], lane[1], int(lane[2])


class RouteFollower(PlainMotion):
    """Mixin over highway-env's controlled vehicles."""

    kind = Kind.HDV
    by_idm = False  # Whether it is driven by IDM
    target_lane_index: LaneId
    id: str
    route_path: RoutePath
    route_paths: Mapping[str, RoutePath]
    s: float  # Arc length along the route [m]
    offset: float  # Lateral offset from the route [m]
    # Lateral offset of the present lane's centre from the route [m]; 0 on the lane of the route itself.
    shift: float = 0.0
    corrections: Corrections
    style: str = ""  # Style of a human driver, where drivers have one
    signals: bool = True  # Whether it signals its turns

    @property
    def signal(self) -> str:
        """The side that it signals: ``left``, ``right`` or nothing."""
        shown: str = self.road.road_map.signals.shown(self.route_path.route.id, self.s) if self.signals else ""
        return shown

    @classmethod
    def place(
        cls,
        road: Road,
        start: Start,
        route_paths: Mapping[str, RoutePath],
        corrections: Corrections,
        **settings: list[float],
    ) -> Self:
        """Put a vehicle on the road, at the start of its route."""
        route_path = route_paths[start.route]
        x, y = route_path.path.position(start.position)
        heading = float(route_path.path.heading(start.position))
        vehicle = cls(road, [float(x), float(y)], heading, start.speed, **settings)
        vehicle.id, vehicle.route_paths, vehicle.corrections = start.id, route_paths, corrections
        vehicle.route_path, vehicle.s, vehicle.offset = route_path, start.position, 0.0
        vehicle._plan()
        if corrections.route_lane:
            vehicle._find_lane()
            vehicle.target_lane_index = vehicle.lane_index
        return vehicle

    def _plan(self) -> None:
        """Hand the rest of the route to highway-env."""
        # From the present lane on: highway-env takes any other road if the plan does not begin with it or the next one.
        # No number where there are several lanes: it would bind drivers to that lane, and pull back CAVs that left it.
        # Where the route needs a lane change, the lane to change to: there drivers change as soon as it is safe.
        graph = self.road.network.graph
        left = self.route_path.route.lanes if self.route_path.changes_after(self.s) else ()
        self.route = [
            (a, b, k if len(graph[a][b]) == 1 or any(beside((a, b, k), lane) for lane in left) else None)
            for a, b, k in self.route_path.plan(self.s)
        ]

    def follow_target_lane(self) -> None:
        """Take the route along the lane that is steered for, if another lane than that of the route was chosen.

        Of the routes along that lane which end where the present one does, one that needs the fewest further changes,
        and had the fewest before.
        """
        target, present, ending = plain(self.target_lane_index), self.route_path.lane_at(self.s), self.route_path.ending
        leaves = ending is not None and target != ending and self.s < self.route_path.lane_end
        if not (beside(target, present) or (target == present and leaves)):
            return
        x, y = self.position.tolist()
        options = []
        for name, route_path in self.route_paths.items():
            if target in route_path.route.lanes and route_path.route.lanes[-1][1] == self.route_path.route.lanes[-1][1]:
                s, offset = route_path.path.project(x, y)
                if route_path.lane_at(s) == target:
                    options.append((route_path.changes_after(s), route_path.changes_after(-math.inf), name, s, offset))
        if options:
            *_, name, self.s, self.offset = min(options)
            self.route_path = self.route_paths[name]
            self._plan()
            self._find_lane()

    def on_state_update(self) -> None:
        """Update the lane after a change of the place."""
        self.moved_to(*self.position.tolist())

    def moved_to(self, x: float, y: float) -> None:
        """Update place on the route and lane [m]."""
        if not self.corrections.route_lane:
            super().on_state_update()
        self.s, self.offset = self.route_path.follow(x, y, self.s)
        if self.corrections.route_lane:
            self._find_lane()

    def _find_lane(self) -> None:
        start, end, index = self.route_path.lane_at(self.s)
        lanes = self.road.network.graph[start][end]
        self.shift = 0.0
        if len(lanes) > 1:
            sides = [lane.local_coordinates(self.position)[1] for lane in lanes]
            aside = [abs(side) for side in sides]
            index = aside.index(min(aside))
            self.shift = self.offset - sides[index]
        self.lane_index = (start, end, index)
        self.lane = lanes[index]

    def step(self, dt: float) -> None:
        """Move by one simulation step [s], within the limits, and never backwards if that is corrected."""
        self.before_step(dt)
        move((self,), dt)
        self.after_step()

    def before_step(self, dt: float) -> None:
        """Keep what was commanded within the limits."""
        if self.route_path.profile is not None:
            self.hold(self.route_path.profile.acceleration(self.odometer(dt), self.speed), dt)

    def after_step(self) -> None:
        """Correct what the dynamics made of it."""
        if self.corrections.no_reverse and self.speed < 0:
            self.speed = 0.0

    def odometer(self, dt: float) -> float:
        """Return the arc length of which the vehicle thinks that it is there [m], at the beginning of a step [s]."""
        return self.s

    def lane_distance_to(self, other: RoadObject | None, lane: AbstractLane | None = None) -> float:
        """Return the distance to another vehicle, positive if it is ahead [m]; along the route if corrected."""
        if other is None or lane is not None or not self.corrections.route_leader:
            return float(super().lane_distance_to(other, lane))
        return self.route_path.path.project(*other.position.tolist())[0] - self.s
