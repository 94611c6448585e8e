"""All that geometry knows of a road, worked out once."""

import math
from collections.abc import Mapping
from functools import lru_cache

import numpy as np

from codriving.datatypes.road import Lane, LaneId, Road, Route
from codriving.geometry.box import PLANNING, Footprint
from codriving.geometry.find_zones import find_zones
from codriving.geometry.lane_path import lane_starts, route_path
from codriving.geometry.path import Path
from codriving.geometry.road_check import check_road
from codriving.geometry.zone import ConflictZone, following_zone


class RoadMap:
    """Paths of all routes, and the conflict zones between them, which are worked out when they are asked for.

    Args:
        road: The road.

    Attributes:
        road: The road.
        lanes: Lanes by id.
        routes: Routes by id.
        paths: Paths by id of the route.

    Raises:
        ScenarioError: If the road is not consistent in itself.
    """

    def __init__(self, road: Road) -> None:
        check_road(road)
        self.road = road
        self.lanes: Mapping[LaneId, Lane] = {lane.id: lane for lane in road.lanes}
        self.routes: Mapping[str, Route] = {route.id: route for route in road.routes}
        self.paths: Mapping[str, Path] = {
            route.id: route_path([self.lanes[lane] for lane in route.lanes]) for route in road.routes
        }
        self._starts = {
            (route.id, lane): start
            for route in road.routes
            for lane, start in zip(route.lanes, lane_starts([self.lanes[k] for k in route.lanes]), strict=True)
        }
        self._zones: dict[tuple[str, str, Footprint], tuple[ConflictZone, ...]] = {}
        self._names = sorted(self.paths)
        ordered = [self.paths[name] for name in self._names]
        self._first = np.cumsum([0] + [len(path.points) for path in ordered[:-1]])
        self._x, self._y = np.concatenate([path.points for path in ordered]).T.copy()
        headings = np.concatenate([path.headings for path in ordered])
        self._cos, self._sin = np.cos(headings), np.sin(headings)

    def lane_start(self, route_id: str, lane_id: LaneId) -> float:
        """Return the arc length on a route at which one of its lanes begins [m].

        Raises:
            KeyError: If the route or the lane on it does not exist.
        """
        return self._starts[route_id, lane_id]

    def zones(self, route_i: str, route_j: str, footprint: Footprint = PLANNING) -> tuple[ConflictZone, ...]:
        """Return the conflict zones of two routes, seen from the first, in the order in which it meets them.

        Args:
            route_i: Id of the first route.
            route_j: Id of the second route; the same one gives a single zone of vehicles that follow one another.
            footprint: Size of both vehicles [m].

        Raises:
            KeyError: If a route does not exist.
        """
        key = (route_i, route_j, footprint)
        if key not in self._zones:
            self._zones[key] = self._find(route_i, route_j, footprint)
        return self._zones[key]

    def _find(self, route_i: str, route_j: str, footprint: Footprint) -> tuple[ConflictZone, ...]:
        if route_i == route_j:
            return (following_zone(self.paths[route_i], footprint),)
        if route_i > route_j:
            # Computed in one direction only, so that both vehicles see exactly the same zone.
            mirrored = (zone.mirrored() for zone in self.zones(route_j, route_i, footprint))
            return tuple(sorted(mirrored, key=lambda zone: (zone.entry_i, zone.entry_j)))
        return find_zones(self.paths[route_i], self.paths[route_j], footprint)

    def routes_near(
        self, x: float, y: float, heading: float | None, tolerance: float = 2.0, angle: float = math.pi / 3
    ) -> tuple[tuple[str, float], ...]:
        """Return the routes that pass by a place, as someone who only sees a vehicle there would guess them.

        Args:
            x: Place [m].
            y: Place [m].
            heading: Heading of the vehicle [rad]; None if any direction will do.
            tolerance: Largest distance of the centre line [m].
            angle: Largest difference of the headings [rad].

        Returns:
            Id of each route and arc length of the place on it [m], in order of id.
        """
        dx, dy = self._x - x, self._y - y
        square = dx * dx + dy * dy
        if heading is not None:
            towards = self._cos * math.cos(heading) + self._sin * math.sin(heading)
            square[towards < math.cos(angle)] = np.inf
        nearest = np.minimum.reduceat(square, self._first)
        found = []
        for k in np.flatnonzero(nearest <= (tolerance + 1.0) ** 2).tolist():
            path = self.paths[self._names[k]]
            first = int(self._first[k])
            index = int(square[first : first + len(path.points)].argmin())
            s, lateral = path.project_at(index, x, y)
            if abs(lateral) <= tolerance and -tolerance <= s <= path.length + tolerance:
                found.append((self._names[k], s))
        return tuple(found)


@lru_cache(maxsize=64)
def road_map(road: Road) -> RoadMap:
    """Return the map of a road; equal roads share one.

    Args:
        road: The road.

    Raises:
        ScenarioError: If the road is not consistent in itself.
    """
    return RoadMap(road)
