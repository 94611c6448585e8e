"""What a CAV remembers of its neighbours from one decision to the next: their possible routes, and if they stand."""

from math import acos, cos, hypot

from codriving.datatypes import Intent, TrackedVehicle
from codriving.geometry import RoadMap

STANDING = 0.5  # Below this speed a vehicle counts as standing [m/s]

# Lateral offset [m] and difference of headings [rad] that count as one step of misfit to a route.
SIDE, TURN = 0.5, 0.15

REACH = 2.0  # How far from the middle of a route a vehicle on it may be [m]

CLEARLY = 2.0  # Steps of misfit by which a route must be worse than the best one to be ruled out; cars do cut corners

Places = tuple[tuple[str, float], ...]  # Routes and the arc length on each [m]

Spot = tuple[float, float, float | None, float]  # Where a vehicle is [m], its heading [rad], how far off it may be [m]


class Tracking:
    """Narrows the possible routes of each vehicle down as it is watched."""

    def __init__(self, road_map: RoadMap) -> None:
        self.road_map = road_map
        self._routes: dict[tuple[str, str], frozenset[str]] = {}
        self._standing: dict[tuple[str, str], float] = {}
        # Only for one step, in which many ask for the same: by place, and what was possible before if that counts.
        self._near: dict[Spot, Places] = {}
        self._shared: dict[tuple[str, float, float], Places] = {}
        self._narrowed: dict[tuple[Spot, frozenset[str] | None, str], tuple[frozenset[str], Places]] = {}

    def begin_step(self) -> None:
        """Forget what was only worked out for the step before."""
        self._near.clear()
        self._shared.clear()
        self._narrowed.clear()

    def places(self, ego: str, seen: TrackedVehicle, intent: Intent | None, signal: str = "") -> Places:
        """Return the routes on which a vehicle may be.

        A shared route is believed. Otherwise every route that fits the position (and the heading, if it is known) and
        has fitted it so far is possible, and of these the ones that agree with a turn signal; without one, all, since
        not every driver signals. After these come the lanes beside onto which the body reaches.
        """
        if intent is not None:
            told = (intent.route, seen.x, seen.y)
            if told not in self._shared:
                s, _ = self.road_map.project(*told)
                self._shared[told] = ((intent.route, s), *self._covered(intent.route, s, seen.x, seen.y))
            return self._shared[told]
        spot, way = (seen.x, seen.y, seen.heading, 0.0), 0.0
        if seen.told is not None and seen.told.since is not None:
            # Which ways it may have taken since is told by where it was.
            spot, way = (*seen.told.since, seen.told.aside), seen.speed * seen.told.age
        key = (spot, self._routes.get((ego, seen.id)), signal)
        if key not in self._narrowed:
            self._narrowed[key] = self._narrow(*key)
        self._routes[ego, seen.id], places = self._narrowed[key]
        return places if not way else tuple((route, s + way) for route, s in places)

    def _narrow(self, spot: Spot, before: frozenset[str] | None, signal: str) -> tuple[frozenset[str], Places]:
        """Return the routes that are still possible, and these with the lanes beside onto which the body reaches."""
        if spot not in self._near:
            self._near[spot] = self._fitting(*spot)
        near = self._near[spot]
        kept = tuple(p for p in near if before is None or p[0] in before) or near
        kept = (self.road_map.signals.agreeing(kept, signal) if signal else ()) or kept
        # A body that reaches onto the lane beside is there as well, whatever its route.
        covered = {p for route, s in kept for p in self._covered(route, s, spot[0], spot[1])}
        beside = sorted(p for p in covered if all(p[0] != route for route, _ in kept))
        return frozenset(route for route, _ in kept), kept + tuple(beside)

    def _covered(self, route: str, s: float, x: float, y: float) -> Places:
        return self.road_map.changes.covered(route, self.road_map.lane_at(route, s), x, y)

    def _fitting(self, x: float, y: float, heading: float | None, aside: float) -> Places:
        """Return the routes near a place, without those that fit position and heading clearly worse than the best."""
        near = self.road_map.nearby.routes(x, y, heading, REACH + aside)
        off = [aside * k / 10 for k in range(-10, 11)] if aside else [0.0]  # Along the route it may be off as well
        misfits = []
        for route, s in near:
            path, turned = self.road_map.paths[route], 0.0
            px, py, _ = path.place(s)
            if heading is not None:
                turned = acos(min(1.0, max(-1.0, *(cos(heading - path.place(s + far)[2]) for far in off))))
            misfits.append(max(hypot(px - x, py - y) - aside, 0.0) / SIDE + turned / TURN)
        return tuple(p for p, misfit in zip(near, misfits, strict=True) if misfit <= min(misfits) + CLEARLY)

    def standing(self, ego: str, seen: TrackedVehicle, time: float) -> float:
        """Return how long ago a vehicle was last seen moving, at a time [s]."""
        if seen.speed >= STANDING:
            self._standing.pop((ego, seen.id), None)
            return 0.0
        return time - self._standing.setdefault((ego, seen.id), time)
