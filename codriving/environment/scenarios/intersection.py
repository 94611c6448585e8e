"""The unsignalised intersection of the paper: four legs, one lane in each direction."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from codriving.datatypes import Arc, Block, Lane, LaneId, Line, Point, Road, Route, Straight, Turn
from codriving.environment.scenarios.junction import JunctionScenario
from codriving.environment.scenarios.shapes import turned
from codriving.errors import require_range
from codriving.geometry import lane_starts

LEGS = ("south", "west", "north", "east")
LANE_WIDTH = 4.0
RIGHT_TURN_RADIUS = LANE_WIDTH + 5
LEFT_TURN_RADIUS = RIGHT_TURN_RADIUS + LANE_WIDTH
OUTER = RIGHT_TURN_RADIUS + LANE_WIDTH / 2  # Distance from the centre at which the legs begin [m]

NEAREST = 7.0  # Buildings as near as this to the middles of the roads leave a metre beside right turns [m]

SPEED_LIMIT = 10.0  # Speed limit on every lane [m/s]

# Steps round the legs from where a route comes in to where it leaves.
TURNS = {Turn.RIGHT: -1, Turn.LEFT: 1, Turn.STRAIGHT: 2}


def _lanes(leg_length: float) -> tuple[Lane, ...]:
    """Build the lanes of highway-env's ``IntersectionEnv``, number for number."""
    none, cont, dash = Line.NONE, Line.CONTINUOUS, Line.STRIPED
    half, far = LANE_WIDTH / 2, leg_length + OUTER
    lanes = []
    for corner in range(4):
        angle, priority = float(np.radians(90 * corner)), 3 if corner % 2 else 1

        def at(x: float, y: float, angle: float = angle) -> Point:
            return turned((x, y), angle)

        def lane(key: LaneId, shape: Straight | Arc, rank: int, lines: tuple[Line, Line]) -> Lane:
            return Lane(key, shape, LANE_WIDTH, SPEED_LIMIT, rank, lines)

        inner = f"ir{corner}"
        right, left, out = (f"il{(corner + steps) % 4}" for steps in TURNS.values())
        turn_right = Arc(
            at(OUTER, OUTER), RIGHT_TURN_RADIUS, angle + float(np.radians(180)), angle + float(np.radians(270))
        )
        offset = LEFT_TURN_RADIUS - half
        turn_left = Arc(at(-offset, offset), LEFT_TURN_RADIUS, angle, angle + float(np.radians(-90)), clockwise=False)
        lanes += [
            lane((f"o{corner}", inner, 0), Straight(at(half, far), at(half, OUTER)), priority, (dash, cont)),
            lane((inner, right, 0), turn_right, priority, (none, cont)),
            lane((inner, left, 0), turn_left, priority - 1, (none, none)),
            lane((inner, out, 0), Straight(at(half, OUTER), at(half, -OUTER)), priority, (dash, none)),
            lane((right, f"o{(corner - 1) % 4}", 0), Straight(at(OUTER, half), at(far, half)), priority, (none, cont)),
        ]
    return tuple(lanes)


def _routes(lanes: tuple[Lane, ...], exit_distance: float) -> tuple[Route, ...]:
    found = {lane.id: lane for lane in lanes}
    routes = []
    for leg, name in enumerate(LEGS):
        for turn, steps in TURNS.items():
            out = (leg + steps) % 4
            way = ((f"o{leg}", f"ir{leg}", 0), (f"ir{leg}", f"il{out}", 0), (f"il{out}", f"o{out}", 0))
            _, junction, leaves = lane_starts([found[lane] for lane in way])
            routes.append(Route(f"{name}-{LEGS[out]}", way, turn, entry=junction, goal=leaves + exit_distance))
    return tuple(routes)


@dataclass(kw_only=True, eq=False, repr=False)
class Intersection(JunctionScenario):
    """Several CAVs among human drivers, each with a random leg, destination, place and speed."""

    name = "intersection"

    leg_length: float
    blind: float | None = None

    def check(self) -> None:
        require_range("leg_length", self.leg_length, 40, 500, " m")
        require_range("exit_distance", self.exit_distance, 5, self.leg_length - 10, " m")
        self.crowd.check(12, 12, self.leg_length - 15, "15 m before the junction at the latest", SPEED_LIMIT)
        self.crowd.require_room(len(LEGS), f"{len(LEGS)} legs")
        self.check_scene()
        if self.blind is not None:
            require_range("blind", self.blind, NEAREST, self.leg_length, " m")

    @cached_property
    def road(self) -> Road:
        """The junction, with the right of way of highway-env: east-west before north-south."""
        lanes = _lanes(self.leg_length)
        return Road("intersection", lanes, _routes(lanes, self.exit_distance), True, buildings=self._buildings())

    def _buildings(self) -> tuple[Block, ...]:
        """One at each corner, as long as the legs."""
        if self.blind is None:
            return ()
        side, middle = OUTER + self.leg_length - self.blind, (OUTER + self.leg_length + self.blind) / 2
        return tuple(Block((x * middle, y * middle), side, side) for x in (-1, 1) for y in (-1, 1))
