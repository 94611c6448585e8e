"""The highway: parallel lanes one way, faster CAVs among slower human drivers, a finish to reach."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from codriving.datatypes import Kind, Lane, Line, Road, Route, Start, Straight, Turn
from codriving.environment.scenarios.placement import PlacedScenario
from codriving.errors import require_range

LANE_WIDTH = 4.0
SPEED_LIMIT = 30.0  # Speed limit on every lane [m/s]

BEYOND = 60.0  # Road past the finish [m]


def _lines(index: int, lanes: int) -> tuple[Line, Line]:
    left = Line.CONTINUOUS_LINE if index == 0 else Line.NONE
    return left, Line.CONTINUOUS_LINE if index == lanes - 1 else Line.STRIPED


@dataclass(kw_only=True, eq=False, repr=False)
class Highway(PlacedScenario):
    """Several CAVs and human drivers on parallel lanes; all may change lanes."""

    name = "highway"

    lanes: int
    finish: float

    def check(self) -> None:
        require_range("lanes", self.lanes, 1, 6)
        require_range("finish", self.finish, 200, 5000, " m")
        self.crowd.check(10, 40, self.finish - 100, "100 m before the finish at the latest", SPEED_LIMIT)
        self.crowd.require_room(self.lanes, f"{self.lanes} lanes")

    @cached_property
    def road(self) -> Road:
        """Parallel lanes, and a route along each; none has the right of way."""
        lanes, routes = [], []
        for k in range(self.lanes):
            shape = Straight((0.0, k * LANE_WIDTH), (self.finish + BEYOND, k * LANE_WIDTH))
            lanes.append(Lane(("begin", "end", k), shape, LANE_WIDTH, SPEED_LIMIT, 0, _lines(k, self.lanes)))
            routes.append(Route(f"lane-{k}", (("begin", "end", k),), Turn.STRAIGHT, self.finish, self.finish))
        return Road("highway", tuple(lanes), tuple(routes))

    def draw(self, rng: np.random.Generator, name: str, kind: Kind) -> Start:
        return self.crowd.start_on(rng, name, kind, f"lane-{int(rng.integers(self.lanes))}")
