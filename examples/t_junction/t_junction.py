"""A T-junction: three legs with one lane in each direction; the side road gives way to the main road.

It is made of what ``codriving.scenarios`` offers, and of nothing else. docs/own-scenario.md goes through it.
"""

import math
from functools import cached_property

import numpy as np

from codriving.scenarios import (
    Crowd,
    Kind,
    Lane,
    LaneId,
    Line,
    Pace,
    Road,
    Route,
    Scenario,
    Scene,
    Start,
    Straight,
    Turn,
    bend,
    lane_starts,
    place,
    require_range,
    turned,
)

LEGS = {"west": math.pi / 2, "east": -math.pi / 2, "south": 0.0}
"""The legs, and how far each is turned against the one in the south: clockwise, since y points down [rad]."""

TURNS = {
    ("west", "east"): Turn.STRAIGHT,
    ("east", "west"): Turn.STRAIGHT,
    ("west", "south"): Turn.RIGHT,
    ("east", "south"): Turn.LEFT,
    ("south", "east"): Turn.RIGHT,
    ("south", "west"): Turn.LEFT,
}
"""What can be driven, from leg to leg."""

MAIN_ROAD, LEFT_TURN, SIDE_ROAD = 2, 1, 0
"""Priorities: the higher goes first. In the junction, a left turn ranks below who comes towards it."""

WIDTH = 4.0
"""Width of a lane [m]."""

OUTER = 11.0
"""Distance from the middle at which the legs begin [m]."""

SPEED_LIMIT = 10.0
"""Speed limit on every lane [m/s]."""


def _lanes(leg_length: float) -> tuple[Lane, ...]:
    """Lay out a lane to the junction and one away from it on each leg, and one for each turn."""
    side, near, far = WIDTH / 2, OUTER, OUTER + leg_length
    # Where a lane reaches the junction, and where one leaves it; drawn for the leg in the south and turned.
    reaches = {leg: turned((side, near), angle) for leg, angle in LEGS.items()}
    leaves = {leg: turned((-side, near), angle) for leg, angle in LEGS.items()}
    lanes = []
    for leg, angle in LEGS.items():
        rank = SIDE_ROAD if leg == "south" else MAIN_ROAD
        to = Straight(turned((side, far), angle), reaches[leg])
        away = Straight(leaves[leg], turned((-side, far), angle))
        middle, none, kerb = Line.STRIPED, Line.NONE, Line.CONTINUOUS
        lanes.append(Lane((leg, f"{leg} in", 0), to, WIDTH, SPEED_LIMIT, rank, (middle, kerb)))
        lanes.append(Lane((f"{leg} out", f"{leg} end", 0), away, WIDTH, SPEED_LIMIT, rank, (none, kerb)))
    for (leg, out), turn in TURNS.items():
        rank = SIDE_ROAD if leg == "south" else LEFT_TURN if turn is Turn.LEFT else MAIN_ROAD
        outer = Line.CONTINUOUS if turn is Turn.RIGHT or (leg, out) == ("east", "west") else Line.NONE
        shape = bend(reaches[leg], LEGS[leg] - math.pi / 2, leaves[out])
        lanes.append(Lane((f"{leg} in", f"{out} out", 0), shape, WIDTH, SPEED_LIMIT, rank, (Line.NONE, outer)))
    return tuple(lanes)


def _routes(lanes: tuple[Lane, ...], exit_distance: float) -> tuple[Route, ...]:
    """Join the lanes to routes, and say where each begins to be shared and where it is done."""
    found = {lane.id: lane for lane in lanes}
    routes = []
    for (leg, out), turn in TURNS.items():
        begin, end = f"{leg} in", f"{out} out"
        way: tuple[LaneId, ...] = ((leg, begin, 0), (begin, end, 0), (end, f"{out} end", 0))
        _, junction, exit_leg = lane_starts([found[lane] for lane in way])
        routes.append(Route(f"{leg}-{out}", way, turn, entry=junction, goal=exit_leg + exit_distance))
    return tuple(routes)


class TJunction(Scenario):
    """Several CAVs among human drivers; leg, destination, place and speed are drawn.

    Args:
        cavs: Number of CAVs, 2 to 9.
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
    """

    name = "t_junction"

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
        self.crowd.check(9, 9, leg_length - 15, "15 m before the junction at the latest", SPEED_LIMIT)
        self.crowd.require_room(len(LEGS), f"{len(LEGS)} legs")
        self.pace = Pace(simulation_frequency, decision_frequency, time_limit, target_speeds, detection_range)
        self.leg_length, self.exit_distance = leg_length, exit_distance

    @cached_property
    def road(self) -> Road:
        """The junction; drivers of lower priority wait at the entry of their route."""
        lanes = _lanes(self.leg_length)
        return Road("T-junction", lanes, _routes(lanes, self.exit_distance), regulated=True)

    def scene(self, seed: int) -> Scene:
        """Draw who starts where, how fast, and with which destination.

        Args:
            seed: Seed of the episode.
        """
        routes = self.road.routes

        def draw(rng: np.random.Generator, name: str, kind: Kind) -> Start:
            route = routes[int(rng.integers(len(routes)))]
            return self.crowd.start_on(rng, name, kind, route.id)

        return place(seed, self.crowd, self.road, draw)
