"""Roads as data, with the numbers of highway-env's networks."""

import math
from itertools import pairwise

import numpy as np
import pytest

from codriving.datatypes.road import Arc, Lane, LaneId, LaneShape, Road, Route, Sine, Straight, Turn
from codriving.geometry.lane_path import route_path
from codriving.geometry.road_map import RoadMap

TURNS = {1: Turn.LEFT, 2: Turn.STRAIGHT, 3: Turn.RIGHT}


def _route(name: str, ids: tuple[LaneId, ...], lanes: dict[LaneId, LaneShape], turn: Turn) -> Route:
    length = route_path([Lane(k, lanes[k]) for k in ids]).length
    return Route(name, ids, turn, entry=0.0, goal=length)


def _intersection() -> Road:
    """Four legs of 100 m, single lane, as in highway-env's intersection."""
    width, right, left, outer, access = 4.0, 9.0, 13.0, 11.0, 100.0
    shapes: dict[LaneId, LaneShape] = {}
    for corner in range(4):
        angle = math.radians(90 * corner)
        cos, sin = round(math.cos(angle)), round(math.sin(angle))

        def turned(x: float, y: float, cos: int = cos, sin: int = sin) -> tuple[float, float]:
            return cos * x - sin * y, sin * x + cos * y

        o, ir = f"o{corner}", f"ir{corner}"
        shapes[o, ir, 0] = Straight(turned(width / 2, access + outer), turned(width / 2, outer))
        shapes[ir, f"il{(corner - 1) % 4}", 0] = Arc(
            turned(outer, outer), right, angle + math.pi, angle + 1.5 * math.pi
        )
        shapes[ir, f"il{(corner + 1) % 4}", 0] = Arc(
            turned(-left + width / 2, left - width / 2), left, angle, angle - math.pi / 2, clockwise=False
        )
        shapes[ir, f"il{(corner + 2) % 4}", 0] = Straight(turned(width / 2, outer), turned(width / 2, -outer))
        exit_ = (corner - 1) % 4
        shapes[f"il{exit_}", f"o{exit_}", 0] = Straight(turned(outer, width / 2), turned(access + outer, width / 2))
    names = ("south", "west", "north", "east")
    routes = []
    for a in range(4):
        for turn in (1, 2, 3):
            b = (a + turn) % 4
            ids: tuple[LaneId, ...] = ((f"o{a}", f"ir{a}", 0), (f"ir{a}", f"il{b}", 0), (f"il{b}", f"o{b}", 0))
            routes.append(_route(f"{names[a]}-{names[b]}", ids, shapes, TURNS[turn]))
    return Road("intersection", tuple(Lane(k, shape) for k, shape in shapes.items()), tuple(routes))


def _roundabout() -> Road:
    """The inner ring and the four legs of highway-env's roundabout."""
    from highway_env.envs import RoundaboutEnv
    from highway_env.road.lane import CircularLane, SineLane, StraightLane

    env = RoundaboutEnv()
    env.reset(seed=0)
    shapes: dict[LaneId, LaneShape] = {}
    for a, ends in env.road.network.graph.items():
        for b, lanes in ends.items():
            lane = lanes[0]
            if isinstance(lane, SineLane):
                shapes[a, b, 0] = Sine(_point(lane.start), _point(lane.end), lane.amplitude, lane.pulsation, lane.phase)
            elif isinstance(lane, StraightLane):
                shapes[a, b, 0] = Straight(_point(lane.start), _point(lane.end))
            else:
                assert isinstance(lane, CircularLane)
                shapes[a, b, 0] = Arc(
                    _point(lane.center), lane.radius, lane.start_phase, lane.end_phase, lane.clockwise
                )
    env.close()
    legs, ring = "senw", ("se", "ex", "ee", "nx", "ne", "wx", "we", "sx")
    routes = []
    for k, a in enumerate(legs):
        for turn in (3, 2, 1):
            b = legs[(k + 4 - turn) % 4]
            nodes = [f"{a}er", f"{a}es"]
            m = ring.index(f"{a}e")
            while ring[m % 8] != f"{b}x":
                nodes.append(ring[m % 8])
                m += 1
            nodes += [f"{b}x", f"{b}xs", f"{b}xr"]
            ids = tuple((p, q, 0) for p, q in pairwise(nodes))
            routes.append(_route(f"{a}-{b}", ids, shapes, TURNS[turn]))
    return Road("roundabout", tuple(Lane(k, shape) for k, shape in shapes.items()), tuple(routes))


def _point(xy: np.ndarray) -> tuple[float, float]:
    return float(xy[0]), float(xy[1])


@pytest.fixture(scope="session")
def intersection() -> RoadMap:
    """The map of the intersection."""
    return RoadMap(_intersection())


@pytest.fixture(scope="session")
def roundabout() -> RoadMap:
    """The map of the roundabout."""
    return RoadMap(_roundabout())
