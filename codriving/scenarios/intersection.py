"""The unsignalised intersection of the paper: four legs, one lane in each direction."""

from functools import cached_property

import numpy as np

from codriving.datatypes.road import Arc, Lane, LaneId, Line, Point, Road, Route, Straight, Turn
from codriving.datatypes.scene import Scene, Start
from codriving.datatypes.vehicle import Kind
from codriving.errors import ScenarioError
from codriving.scenarios.pace import Pace, require_interval, require_range
from codriving.scenarios.placement import place, room_on_lane

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


def _point(rotation: np.ndarray, x: float, y: float) -> Point:
    px, py = rotation @ np.array([x, y])
    return float(px), float(py)


def _lanes(leg_length: float) -> tuple[Lane, ...]:
    """Build the lanes of highway-env's ``IntersectionEnv``, number for number."""
    none, cont, dash = Line.NONE, Line.CONTINUOUS, Line.STRIPED
    lanes = []
    for corner in range(4):
        angle = float(np.radians(90 * corner))
        rotation = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        priority = 3 if corner % 2 else 1
        half, far = LANE_WIDTH / 2, leg_length + OUTER

        def lane(key: LaneId, shape: Straight | Arc, rank: int, lines: tuple[Line, Line]) -> Lane:
            return Lane(key, shape, LANE_WIDTH, SPEED_LIMIT, rank, lines)

        inner, right, left = f"ir{corner}", f"il{(corner - 1) % 4}", f"il{(corner + 1) % 4}"
        out = f"il{(corner + 2) % 4}"
        approach = Straight(_point(rotation, half, far), _point(rotation, half, OUTER))
        turn_right = Arc(
            _point(rotation, OUTER, OUTER),
            RIGHT_TURN_RADIUS,
            angle + float(np.radians(180)),
            angle + float(np.radians(270)),
        )
        offset = LEFT_TURN_RADIUS - half
        turn_left = Arc(
            _point(rotation, -offset, offset),
            LEFT_TURN_RADIUS,
            angle + float(np.radians(0)),
            angle + float(np.radians(-90)),
            clockwise=False,
        )
        across = Straight(_point(rotation, half, OUTER), _point(rotation, half, -OUTER))
        leave = Straight(_point(rotation, OUTER, half), _point(rotation, far, half))
        lanes += [
            lane((f"o{corner}", inner, 0), approach, priority, (dash, cont)),
            lane((inner, right, 0), turn_right, priority, (none, cont)),
            lane((inner, left, 0), turn_left, priority - 1, (none, none)),
            lane((inner, out, 0), across, priority, (dash, none)),
            lane((right, f"o{(corner - 1) % 4}", 0), leave, priority, (none, cont)),
        ]
    return tuple(lanes)


def _routes(leg_length: float, exit_distance: float) -> tuple[Route, ...]:
    middle = {
        Turn.RIGHT: RIGHT_TURN_RADIUS * np.pi / 2,
        Turn.LEFT: LEFT_TURN_RADIUS * np.pi / 2,
        Turn.STRAIGHT: 2 * OUTER,
    }
    routes = []
    for leg, name in enumerate(LEGS):
        for turn, steps in TURNS.items():
            out = (leg + steps) % 4
            lanes: tuple[LaneId, ...] = (
                (f"o{leg}", f"ir{leg}", 0),
                (f"ir{leg}", f"il{out}", 0),
                (f"il{out}", f"o{out}", 0),
            )
            goal = leg_length + float(middle[turn]) + exit_distance
            routes.append(Route(f"{name}-{LEGS[out]}", lanes, turn, entry=leg_length, goal=goal))
    return tuple(routes)


class Intersection:
    """Several CAVs among human drivers, each with a random leg, destination, place and speed.

    Args:
        cavs: Number of CAVs, 2 to 12.
        hdvs: Smallest and largest number of HDVs; the number is drawn from the seed.
        leg_length: Length of each leg before the junction [m].
        start: Nearest and farthest start along a leg [m].
        cav_speed: Lowest and highest start speed of CAVs [m/s].
        hdv_speed: Lowest and highest start speed of HDVs, which is also the speed they want [m/s].
        spacing: Smallest distance between two starts on one leg [m].
        exit_distance: Distance past the junction at which a vehicle has arrived [m].
        simulation_frequency: Simulation steps per second [Hz].
        decision_frequency: Decisions per second [Hz].
        time_limit: Longest duration of an episode [s].
        target_speeds: Speeds that FASTER and SLOWER step through [m/s].
        detection_range: Radius of perception of a CAV [m].

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
        require_range("cavs", cavs, 2, 12)
        require_interval("hdvs", hdvs, 0, 12)
        require_range("leg_length", leg_length, 40, 500, " m")
        require_interval("start", start, 0, leg_length - 15, " m (15 m before the junction at the latest)")
        require_interval("cav_speed", cav_speed, 0, SPEED_LIMIT, " m/s")
        require_interval("hdv_speed", hdv_speed, 1, SPEED_LIMIT, " m/s")
        require_range("spacing", spacing, 6, 100, " m")
        require_range("exit_distance", exit_distance, 5, leg_length - 10, " m")
        room = len(LEGS) * room_on_lane(start[1] - start[0], min(cav_speed[0], hdv_speed[0]), spacing)
        if cavs + hdvs[1] > room:
            raise ScenarioError(
                f"{cavs} CAVs and up to {hdvs[1]} HDVs cannot start within {start[0]:g} to {start[1]:g} m along "
                f"{len(LEGS)} legs, where {room} vehicles have {spacing:g} m and a braking gap between them at most; "
                "use fewer vehicles or a longer start interval"
            )
        self.cavs, self.hdvs = cavs, hdvs
        self.leg_length, self.start, self.exit_distance = leg_length, start, exit_distance
        self.cav_speed, self.hdv_speed, self.spacing = cav_speed, hdv_speed, spacing
        self.pace = Pace(simulation_frequency, decision_frequency, time_limit, tuple(target_speeds), detection_range)

    @cached_property
    def road(self) -> Road:
        """The junction, with the right of way of highway-env: east-west before north-south."""
        return Road("intersection", _lanes(self.leg_length), _routes(self.leg_length, self.exit_distance), True)

    def scene(self, seed: int) -> Scene:
        """Draw leg, destination, place and speed of every vehicle.

        Args:
            seed: Seed of the episode.

        Raises:
            ScenarioError: If the vehicles do not fit on the legs.
        """
        routes = self.road.routes

        def draw(rng: np.random.Generator, name: str, kind: Kind) -> Start:
            route = routes[int(rng.integers(len(routes)))]
            position = float(rng.uniform(*self.start))
            speed = float(rng.uniform(*(self.cav_speed if kind is Kind.CAV else self.hdv_speed)))
            return Start(name, kind, route.id, position, speed)

        def spot(start: Start) -> tuple[str, float]:
            return start.route.split("-")[0], start.position

        what = f"intersection with starts {self.start[0]:g} to {self.start[1]:g} m along its legs"
        return place(seed, self.cavs, self.hdvs, draw, spot, self.spacing, what)
