"""The unsignalised intersection of the paper: four legs, one lane in each direction."""

from functools import cached_property

import numpy as np

from codriving.datatypes.parts import Scenario
from codriving.datatypes.road import Arc, Lane, LaneId, Line, Point, Road, Route, Straight, Turn
from codriving.datatypes.world import Kind, Scene, Start
from codriving.environment.scenarios.pace import Pace
from codriving.environment.scenarios.placement import Crowd, place
from codriving.environment.scenarios.shapes import turned
from codriving.errors import require_range
from codriving.geometry.lane_path import lane_starts

LEGS = ("south", "west", "north", "east")
LANE_WIDTH = 4.0
RIGHT_TURN_RADIUS = LANE_WIDTH + 5
LEFT_TURN_RADIUS = RIGHT_TURN_RADIUS + LANE_WIDTH
OUTER = RIGHT_TURN_RADIUS + LANE_WIDTH / 2
"""Distance from the centre at which the legs begin [m]."""

SPEED_LIMIT = 10.0
"""Speed limit on every lane [m/s]."""

TURNS = {Turn.RIGHT: -1, Turn.LEFT: 1, Turn.STRAIGHT: 2}
"""Steps round the legs from where a route comes in to where it leaves."""


def _lanes(leg_length: float) -> tuple[Lane, ...]:
    """Build the lanes of highway-env's ``IntersectionEnv``, number for number."""
    none, cont, dash = Line.NONE, Line.CONTINUOUS, Line.STRIPED
    lanes = []
    for corner in range(4):
        angle = float(np.radians(90 * corner))
        priority = 3 if corner % 2 else 1
        half, far = LANE_WIDTH / 2, leg_length + OUTER

        def at(x: float, y: float, angle: float = angle) -> Point:
            return turned((x, y), angle)

        def lane(key: LaneId, shape: Straight | Arc, rank: int, lines: tuple[Line, Line]) -> Lane:
            return Lane(key, shape, LANE_WIDTH, SPEED_LIMIT, rank, lines)

        inner, right, left = f"ir{corner}", f"il{(corner - 1) % 4}", f"il{(corner + 1) % 4}"
        out = f"il{(corner + 2) % 4}"
        approach = Straight(at(half, far), at(half, OUTER))
        turn_right = Arc(
            at(OUTER, OUTER),
            RIGHT_TURN_RADIUS,
            angle + float(np.radians(180)),
            angle + float(np.radians(270)),
        )
        offset = LEFT_TURN_RADIUS - half
        turn_left = Arc(
            at(-offset, offset),
            LEFT_TURN_RADIUS,
            angle + float(np.radians(0)),
            angle + float(np.radians(-90)),
            clockwise=False,
        )
        across = Straight(at(half, OUTER), at(half, -OUTER))
        leave = Straight(at(OUTER, half), at(far, half))
        lanes += [
            lane((f"o{corner}", inner, 0), approach, priority, (dash, cont)),
            lane((inner, right, 0), turn_right, priority, (none, cont)),
            lane((inner, left, 0), turn_left, priority - 1, (none, none)),
            lane((inner, out, 0), across, priority, (dash, none)),
            lane((right, f"o{(corner - 1) % 4}", 0), leave, priority, (none, cont)),
        ]
    return tuple(lanes)


def _routes(lanes: tuple[Lane, ...], exit_distance: float) -> tuple[Route, ...]:
    found = {lane.id: lane for lane in lanes}
    routes = []
    for leg, name in enumerate(LEGS):
        for turn, steps in TURNS.items():
            out = (leg + steps) % 4
            way: tuple[LaneId, ...] = (
                (f"o{leg}", f"ir{leg}", 0),
                (f"ir{leg}", f"il{out}", 0),
                (f"il{out}", f"o{out}", 0),
            )
            _, junction, leaves = lane_starts([found[lane] for lane in way])
            routes.append(Route(f"{name}-{LEGS[out]}", way, turn, entry=junction, goal=leaves + exit_distance))
    return tuple(routes)


class Intersection(Scenario):
    """Several CAVs among human drivers, each with a random leg, destination, place and speed.

    The settings that scenarios share are those of `Crowd` and `Pace`.

    Args:
        leg_length: Length of each leg before the junction [m].
        exit_distance: Distance past the junction at which a vehicle has arrived [m].

    Raises:
        ConfigError: If a setting is out of range.
        ScenarioError: If so many vehicles cannot be placed.
    """

    name = "intersection"

    def __init__(
        self,
        cavs: int,
        hdvs: tuple[int, int],
        leg_length: float,
        start: tuple[float, float],
        cav_speed: tuple[float, float],
        hdv_speed: tuple[float, float],
        spacing: float,
        exit_distance: float,
        simulation_frequency: float,
        decision_frequency: float,
        time_limit: float,
        target_speeds: tuple[float, ...],
        detection_range: float,
    ) -> None:
        require_range("leg_length", leg_length, 40, 500, " m")
        require_range("exit_distance", exit_distance, 5, leg_length - 10, " m")
        self.crowd = Crowd(cavs, hdvs, start, cav_speed, hdv_speed, spacing)
        self.crowd.check(12, 12, leg_length - 15, "15 m before the junction at the latest", SPEED_LIMIT)
        self.crowd.require_room(len(LEGS), f"{len(LEGS)} legs")
        self.leg_length, self.exit_distance = leg_length, exit_distance
        self.pace = Pace(simulation_frequency, decision_frequency, time_limit, tuple(target_speeds), detection_range)

    @cached_property
    def road(self) -> Road:
        """The junction, with the right of way of highway-env: east-west before north-south."""
        lanes = _lanes(self.leg_length)
        return Road("intersection", lanes, _routes(lanes, self.exit_distance), regulated=True)

    def scene(self, seed: int) -> Scene:
        """Draw leg, destination, place and speed of every vehicle.

        Raises:
            ScenarioError: If the vehicles do not fit on the legs.
        """
        routes = self.road.routes

        def draw(rng: np.random.Generator, name: str, kind: Kind) -> Start:
            route = routes[int(rng.integers(len(routes)))]
            return self.crowd.start_on(rng, name, kind, route.id)

        return place(seed, self.crowd, self.road, draw)
