"""All that geometry knows of a road, worked out once."""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from functools import lru_cache

import numpy as np

from codriving.datatypes import DrivingModel, Lane, LaneId, Road, Route
from codriving.geometry.box import PLANNING, Footprint
from codriving.geometry.curve import FloatArray
from codriving.geometry.find_zones import find_zones
from codriving.geometry.lane_changes import LaneChanges
from codriving.geometry.lane_path import lane_starts, route_path
from codriving.geometry.nearby import Nearby
from codriving.geometry.path import Path
from codriving.geometry.road_check import check_road
from codriving.geometry.sight import Sight
from codriving.geometry.signals import Signals
from codriving.geometry.speed_profile import SpeedProfile, route_curvature, speed_profile
from codriving.geometry.zone import ConflictZone, following_zone

_REMEMBERED = 10_000  # Projections that are remembered; many vehicles need the same ones within a decision step


class RoadMap:
    """Paths of all routes, and the conflict zones between them, which are worked out when they are first needed.

    Raises:
        ScenarioError: If the road is not consistent in itself.
    """

    def __init__(self, road: Road) -> None:
        check_road(road)
        self.road = road
        self.lanes: Mapping[LaneId, Lane] = {lane.id: lane for lane in road.lanes}
        self.routes: Mapping[str, Route] = {route.id: route for route in road.routes}
        self.paths: Mapping[str, Path] = {
            route.id: route_path([self.lanes[lane] for lane in route.lanes], route.taper) for route in road.routes
        }
        # Lanes of each route from its end to its start, to find the one at a place.
        self._backwards: dict[str, tuple[tuple[LaneId, float], ...]] = {}
        for route in road.routes:
            starts = lane_starts([self.lanes[lane] for lane in route.lanes], route.taper)
            self._backwards[route.id] = tuple(zip(reversed(route.lanes), reversed(starts), strict=True))
        self._starts = {(name, lane): start for name, back in self._backwards.items() for lane, start in back}
        self.changes = LaneChanges(self.lanes, self.routes, self._starts)
        self.nearby = Nearby(self.lanes, self.routes, self.paths, self._starts)
        self.sight = Sight(road.buildings) if road.buildings else None
        self.signals = Signals(self.lanes, self.routes, self._starts)
        self._projected: dict[tuple[str, float, float], tuple[float, float]] = {}
        self._zones: dict[Footprint, dict[tuple[str, str], tuple[ConflictZone, ...]]] = {}
        self._planning = self._zones[PLANNING] = {}
        self._profiles: dict[DrivingModel, dict[str, SpeedProfile]] = {}

    @property
    def widest(self) -> float:
        """Width of its widest lane [m]."""
        return max(lane.width for lane in self.lanes.values())

    def speed_limit(self, route_id: str) -> float:
        """Return the highest legal speed on a route [m/s]."""
        return max(self.lanes[lane].speed_limit for lane in self.routes[route_id].lanes)

    def project(self, route_id: str, x: float, y: float) -> tuple[float, float]:
        """Return arc length and lateral offset of a place on a route [m], each worked out once."""
        key = (route_id, x, y)
        found = self._projected.get(key)
        if found is None:
            if len(self._projected) >= _REMEMBERED:
                self._projected.clear()
            found = self._projected[key] = self.paths[route_id].project(x, y)
        return found

    def project_all(self, route_id: str, places: Iterable[tuple[float, float]]) -> None:
        """Work out together what `project` will return for some places, x and y [m]."""
        new = list(dict.fromkeys(place for place in places if (route_id, *place) not in self._projected))
        if not new:
            return
        if len(self._projected) + len(new) > _REMEMBERED:
            self._projected.clear()
        x, y = np.array(new, dtype=np.float64).T
        for place, found in zip(new, self.paths[route_id].project_all(x, y), strict=True):
            self._projected[route_id, *place] = found

    def lane_at(self, route_id: str, s: float) -> LaneId:
        """Return the lane of a route at an arc length [m]; before the start of the route that is the first lane."""
        for lane, start in self._backwards[route_id]:
            if start <= s:
                return lane
        return self.routes[route_id].lanes[0]

    def lane_start(self, route_id: str, lane_id: LaneId) -> float:
        """Return the arc length on a route at which one of its lanes begins [m]."""
        return self._starts[route_id, lane_id]

    def zones(self, route_i: str, route_j: str, footprint: Footprint = PLANNING) -> tuple[ConflictZone, ...]:
        """Return the conflict zones of two routes, seen from the first, in the order in which it meets them."""
        known = self._planning if footprint is PLANNING else self._zones.setdefault(footprint, {})
        found = known.get((route_i, route_j))
        if found is None:
            found = known[route_i, route_j] = self._find(route_i, route_j, footprint)
        return found

    def speed_profiles(self, model: DrivingModel) -> Mapping[str, SpeedProfile]:
        """Return the speed profile of each route, worked out once; none at all where vehicles have no limits."""
        if model.limits is None:
            return {}
        if model not in self._profiles:
            self._profiles[model] = {
                name: speed_profile(path, self._curvature(name), model, model.limits)
                for name, path in self.paths.items()
            }
        return self._profiles[model]

    def _curvature(self, route_id: str) -> FloatArray:
        return route_curvature(self.routes[route_id], self.paths[route_id], self.lanes, self._starts)

    def _find(self, route_i: str, route_j: str, footprint: Footprint) -> tuple[ConflictZone, ...]:
        if route_i == route_j:
            return (following_zone(self.paths[route_i], footprint),)
        if route_i > route_j:
            # Computed in one direction only, so that both vehicles see exactly the same zone.
            mirrored = (zone.mirrored() for zone in self.zones(route_j, route_i, footprint))
            return tuple(sorted(mirrored, key=lambda zone: (zone.entry_i, zone.entry_j)))
        zones = find_zones(self.paths[route_i], self.paths[route_j], footprint)
        return tuple(
            replace(
                zone,
                changes_i=self.changes.leads_into(route_i, zone.entry_i, zone.merge_i),
                changes_j=self.changes.leads_into(route_j, zone.entry_j, zone.merge_j),
            )
            for zone in zones
        )


@lru_cache(maxsize=64)
def road_map(road: Road) -> RoadMap:
    """Return the map of a road; equal roads share one.

    Raises:
        ScenarioError: If the road is not consistent in itself.
    """
    return RoadMap(road)
