"""The highway: parallel lanes one way, faster CAVs among slower human drivers, a finish to reach."""

from functools import cached_property

import numpy as np

from codriving.datatypes.parts import Scenario
from codriving.datatypes.road import Lane, Line, Road, Route, Straight, Turn
from codriving.datatypes.world import Kind, Scene, Start
from codriving.environment.scenarios.pace import Pace
from codriving.environment.scenarios.placement import Crowd, place
from codriving.errors import require_range

LANE_WIDTH = 4.0
SPEED_LIMIT = 30.0
"""Speed limit on every lane [m/s]."""

BEYOND = 60.0
"""Road past the finish [m]."""


def _lines(index: int, lanes: int) -> tuple[Line, Line]:
    left = Line.CONTINUOUS_LINE if index == 0 else Line.NONE
    return left, Line.CONTINUOUS_LINE if index == lanes - 1 else Line.STRIPED


class Highway(Scenario):
    """Several CAVs and human drivers on parallel lanes; all may change lanes.

    The settings that scenarios share are those of `Crowd` and `Pace`.

    Args:
        finish: Distance after which a vehicle has arrived [m].

    Raises:
        ConfigError: If a setting is out of range.
        ScenarioError: If so many vehicles cannot be placed.
    """

    name = "highway"

    def __init__(
        self,
        cavs: int,
        hdvs: tuple[int, int],
        lanes: int,
        finish: float,
        start: tuple[float, float],
        cav_speed: tuple[float, float],
        hdv_speed: tuple[float, float],
        spacing: float,
        simulation_frequency: float,
        decision_frequency: float,
        time_limit: float,
        target_speeds: tuple[float, ...],
        detection_range: float,
    ) -> None:
        require_range("lanes", lanes, 1, 6)
        require_range("finish", finish, 200, 5000, " m")
        self.crowd = Crowd(cavs, hdvs, start, cav_speed, hdv_speed, spacing)
        self.crowd.check(10, 40, finish - 100, "100 m before the finish at the latest", SPEED_LIMIT)
        self.crowd.require_room(lanes, f"{lanes} lanes")
        self.lanes, self.finish = lanes, finish
        self.pace = Pace(simulation_frequency, decision_frequency, time_limit, tuple(target_speeds), detection_range)

    @cached_property
    def road(self) -> Road:
        """Parallel lanes, and a route along each; none has the right of way."""
        lanes, routes = [], []
        length = self.finish + BEYOND
        for k in range(self.lanes):
            shape = Straight((0.0, k * LANE_WIDTH), (length, k * LANE_WIDTH))
            lanes.append(Lane(("begin", "end", k), shape, LANE_WIDTH, SPEED_LIMIT, 0, _lines(k, self.lanes)))
            routes.append(Route(f"lane-{k}", (("begin", "end", k),), Turn.STRAIGHT, self.finish, self.finish))
        return Road("highway", tuple(lanes), tuple(routes))

    def scene(self, seed: int) -> Scene:
        """Draw lane, place and speed of every vehicle.

        Raises:
            ScenarioError: If the vehicles do not fit.
        """

        def draw(rng: np.random.Generator, name: str, kind: Kind) -> Start:
            route = f"lane-{int(rng.integers(self.lanes))}"
            return self.crowd.start_on(rng, name, kind, route)

        return place(seed, self.crowd, self.road, draw)
