"""Turn signals: which side a vehicle on a route would signal at a place."""

import math
from collections.abc import Iterable, Mapping, Sequence
from itertools import pairwise

from codriving.datatypes import Lane, LaneId, Route, beside
from codriving.geometry.lane_path import lane_path

# How far before a turn it is signalled [m]; 100 feet, Uniform Vehicle Code 11-604.
BEFORE = 30.0

LEFT, RIGHT, NONE = "left", "right", ""


class Signals:
    """Where each route has to be signalled: where the way divides and the route leaves the way straight on.

    Straight on is the lane of the highest priority, and of several the straightest. So a vehicle signals that it leaves
    a roundabout, and not that it goes round.
    """

    def __init__(
        self, lanes: Mapping[LaneId, Lane], routes: Mapping[str, Route], starts: Mapping[tuple[str, LaneId], float]
    ) -> None:
        after: dict[LaneId, set[LaneId]] = {}
        for route in routes.values():
            for lane, following in pairwise(route.lanes):
                if not beside(lane, following):
                    after.setdefault(lane, set()).add(following)
        bends = {lane: _bend(lanes[lane]) for ways in after.values() if len(ways) > 1 for lane in ways}
        straight = {
            lane: min(ways, key=lambda way: (-lanes[way].priority, abs(bends[way])))
            for lane, ways in after.items()
            if len(ways) > 1
        }
        self._shown: dict[str, list[tuple[float, float, str]]] = {}
        for name, route in routes.items():
            found = self._shown[name] = []
            ends = [*(starts[name, lane] for lane in route.lanes[2:]), math.inf]
            for (lane, way), end in zip(pairwise(route.lanes), ends, strict=False):
                if way != straight.get(lane, way):
                    begin = max(starts[name, lane], starts[name, way] - BEFORE)
                    found.append((begin, end, LEFT if bends[way] < bends[straight[lane]] else RIGHT))

    def shown(self, route: str, s: float) -> str:
        """Return the side that is signalled at an arc length [m]: ``left``, ``right`` or nothing."""
        for begin, end, side in self._shown[route]:
            if begin <= s < end:
                return side
        return NONE

    def agreeing(self, ways: Sequence[tuple[str, float]], signal: str) -> tuple[tuple[str, float], ...]:
        """Return the routes, each with an arc length [m], on which a vehicle would signal as it does."""
        return tuple((route, s) for route, s in ways if self.shown(route, s) == signal)


def _bend(lane: Lane) -> float:
    """Angle by which a lane turns to the right [rad]."""
    path = lane_path(lane)
    turned: Iterable[float] = (float(b - a) for a, b in pairwise(path.headings))
    return sum(math.remainder(angle, math.tau) for angle in turned)
