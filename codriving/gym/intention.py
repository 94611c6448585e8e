"""What a vehicle means to do next, as one number that works on every road."""

from collections.abc import Mapping
from enum import IntEnum
from itertools import pairwise

from codriving.datatypes.road import LaneId, Route, Turn, beside
from codriving.datatypes.vehicle import Intent


class Intention(IntEnum):
    """Where a vehicle is bound; numbered from left to right."""

    HIDDEN = 0
    LEFT = 1
    STRAIGHT = 2
    RIGHT = 3


_OF_TURN = {Turn.LEFT: Intention.LEFT, Turn.STRAIGHT: Intention.STRAIGHT, Turn.RIGHT: Intention.RIGHT}


def intention(intent: Intent | None, lane: LaneId | None, routes: Mapping[str, Route]) -> Intention:
    """Reduce an intent to one number.

    A lane change under way comes first, then one that the route still asks for (a ramp that ends, say), and then what
    the route does at the junction.
    """
    if intent is None:
        return Intention.HIDDEN
    if lane is not None and beside(lane, intent.target_lane):
        return _side(lane, intent.target_lane)
    route = routes[intent.route]
    for place, (one, other) in enumerate(pairwise(route.lanes)):
        if beside(one, other) and (lane is None or lane in route.lanes[: place + 1]):
            return _side(one, other)
    return _OF_TURN[route.turn]


def _side(lane: LaneId, other: LaneId) -> Intention:
    return Intention.LEFT if other[2] < lane[2] else Intention.RIGHT
