"""A small road and hand-made tracks on it."""

from collections.abc import Callable

import numpy as np
import pytest

from codriving.datatypes.record import Track
from codriving.datatypes.road import Lane, Road, Route, Straight, Turn
from codriving.datatypes.world import Kind
from codriving.geometry.road_map import RoadMap

STEP = 0.1

LANES = (
    Lane(("w", "m", 0), Straight((-60, 0), (0, 0)), speed_limit=10.0),
    Lane(("m", "e", 0), Straight((0, 0), (60, 0)), speed_limit=12.0),
    Lane(("s", "n", 0), Straight((-30, 60), (-30, -60)), speed_limit=10.0),
    Lane(("d", "m", 0), Straight((-60, 30), (-2, 0)), speed_limit=8.0),
)

ROUTES = (
    Route("east", (("w", "m", 0), ("m", "e", 0)), Turn.STRAIGHT, 20, 110),
    Route("north", (("s", "n", 0),), Turn.STRAIGHT, 50, 110),
    Route("merge", (("d", "m", 0), ("m", "e", 0)), Turn.STRAIGHT, 50, 120),
)

Drive = Callable[..., Track]


@pytest.fixture(scope="session")
def road() -> RoadMap:
    """`east` is crossed by `north` at x = -30 and joined by `merge` near x = 0."""
    return RoadMap(Road("small", LANES, ROUTES))


@pytest.fixture
def drive(road: RoadMap) -> Drive:
    """Make the track of a vehicle whose arc length is given for each row."""

    def track(
        name: str, route: str, s: np.ndarray, kind: Kind = Kind.CAV, arrived: float | None = None, first_step: int = 0
    ) -> Track:
        path = road.paths[route]
        x, y = path.position(s)
        speed = np.gradient(s, STEP)
        return Track(
            name,
            kind,
            route,
            first_step,
            x,
            y,
            path.heading(s),
            speed,
            np.gradient(speed, STEP),
            ("IDLE",) * len(s),
            arrived,
        )

    return track
