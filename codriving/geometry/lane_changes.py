"""Lanes side by side: which change a route asks for next, and which lanes a body reaches onto."""

from collections.abc import Mapping, Sequence
from itertools import pairwise

from codriving.datatypes import Action, Lane, LaneId, Route, beside
from codriving.geometry.box import TRUE
from codriving.geometry.lane_path import lane_path
from codriving.geometry.path import Path

_REMEMBERED = 10_000  # Places on lanes that are remembered

# A body that comes this near to a lane counts as reaching onto it [m]; drivers who change lanes are seen early.
_LEANS = 0.6


class LaneChanges:
    """The lane changes that routes ask for, and what lies on the lanes beside them."""

    def __init__(
        self, lanes: Mapping[LaneId, Lane], routes: Mapping[str, Route], starts: Mapping[tuple[str, LaneId], float]
    ) -> None:
        self.lanes, self.routes, self._starts = lanes, routes, starts
        # Lane, arc length at which it has to be begun at the latest and at which it is done [m], of each change.
        self._changes = {
            route.id: [
                (other, starts[route.id, other], starts[route.id, other] + route.taper / 2)
                for lane, other in pairwise(route.lanes)
                if beside(lane, other)
            ]
            for route in routes.values()
        }
        self._lane_paths: dict[LaneId, Path] = {}
        self._on_lanes: dict[tuple[LaneId, float, float], tuple[float, float]] = {}
        self._beside: dict[tuple[str, LaneId], tuple[tuple[str, LaneId], ...]] = {}
        self._along: dict[LaneId, tuple[tuple[str, frozenset[LaneId]], ...]] = {}

    def ahead(self, route_id: str, s: float) -> tuple[LaneId, float, float] | None:
        """Return the next lane change that a route asks for."""
        return next((change for change in self._changes[route_id] if s < change[2]), None)

    def action(self, route_id: str, lane: LaneId) -> Action:
        """Return the action by which a route changes onto one of its lanes."""
        lanes = self.routes[route_id].lanes
        return Action.LANE_LEFT if lane[2] < lanes[lanes.index(lane) - 1][2] else Action.LANE_RIGHT

    def routes_along(self, lane: LaneId) -> tuple[tuple[str, frozenset[LaneId]], ...]:
        """Return each route along a lane, with the lanes before and after it that the route takes without a change."""
        if lane not in self._along:
            self._along[lane] = tuple(
                (route.id, frozenset(_unchanged(route.lanes, lane)))
                for route in self.routes.values()
                if lane in route.lanes
            )
        return self._along[lane]

    def leads_into(self, route_id: str, entry: float, merge: float | None) -> bool:
        """Whether a route gets into a zone, between its entry and where ways merge [m], by changing lanes."""
        route = self.routes[route_id]
        changes = (self._starts[route_id, other] for lane, other in pairwise(route.lanes) if beside(lane, other))
        return merge is not None and any(entry <= start + route.taper and start <= merge for start in changes)

    def routes_beside(self, route_id: str, lane: LaneId) -> tuple[tuple[str, LaneId], ...]:
        """Return the routes along the lanes next to a lane which end where a route does."""
        key = (route_id, lane)
        if key not in self._beside:
            found = []
            for side in ((lane[0], lane[1], lane[2] - 1), (lane[0], lane[1], lane[2] + 1)):
                options = [
                    (_changes(r.lanes[r.lanes.index(side) :]), _changes(r.lanes), r.id)
                    for r in self.routes.values()
                    if side in r.lanes and r.lanes[-1][1] == self.routes[route_id].lanes[-1][1]
                ]
                if options:
                    found.append((min(options)[-1], side))
            self._beside[key] = tuple(found)
        return self._beside[key]

    def covered(self, route_id: str, lane: LaneId, x: float, y: float) -> tuple[tuple[str, float], ...]:
        """Return the routes beside a route onto whose lanes a body still or already reaches."""
        found = []
        for name, other in self.routes_beside(route_id, lane):
            along, lateral = self._on_lane(other, x, y)
            if abs(lateral) < self.lanes[other].width / 2 + TRUE.width / 2 + _LEANS:
                found.append((name, self._starts[name, other] + along))
        return tuple(found)

    def _on_lane(self, lane: LaneId, x: float, y: float) -> tuple[float, float]:
        """Return arc length and lateral offset of a place on a lane [m], each worked out once."""
        key = (lane, x, y)
        found = self._on_lanes.get(key)
        if found is None:
            if lane not in self._lane_paths:
                self._lane_paths[lane] = lane_path(self.lanes[lane])
            if len(self._on_lanes) >= _REMEMBERED:
                self._on_lanes.clear()
            found = self._on_lanes[key] = self._lane_paths[lane].project(x, y)
        return found


def _unchanged(lanes: Sequence[LaneId], lane: LaneId) -> Sequence[LaneId]:
    """The stretch of a route around one of its lanes on which it changes none."""
    first = last = lanes.index(lane)
    while first > 0 and not beside(lanes[first - 1], lanes[first]):
        first -= 1
    while last + 1 < len(lanes) and not beside(lanes[last], lanes[last + 1]):
        last += 1
    return lanes[first : last + 1]


def _changes(lanes: Sequence[LaneId]) -> int:
    return sum(beside(*pair) for pair in pairwise(lanes))
