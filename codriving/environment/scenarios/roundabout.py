"""The roundabout: one ring lane, four legs that meet it tangentially, one lane in each direction."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from codriving.datatypes import (
    Arc,
    Kind,
    Lane,
    LaneId,
    LaneShape,
    Line,
    Point,
    Road,
    Route,
    Scene,
    Start,
    Straight,
    Turn,
)
from codriving.environment.scenarios.junction import JunctionScenario
from codriving.environment.scenarios.placement import Suits, place
from codriving.environment.scenarios.shapes import turned
from codriving.errors import require, require_range
from codriving.geometry import PLANNING

LEGS = ("south", "east", "north", "west")  # The legs in the order in which the ring passes them

LANE_WIDTH = 4.0
SPEED_LIMIT = 10.0  # Speed limit on every lane [m/s]

TURNS = {Turn.RIGHT: 1, Turn.STRAIGHT: 2, Turn.LEFT: 3}  # Legs that a route passes until it leaves

# Least length of the ring between an entry and the next exit [m]; with less, those that come and go would cross.
TOGETHER = 3.0


class Ring:
    """The measures of the ring and of the arcs that lead to it and away from it.

    Highway-env's own legs meet the ring at an angle of 66 degrees; these touch it, as built roundabouts do.

    The settings that scenarios share are those of `Crowd` and `Pace`.

    Attributes:
        touch: Angle between the end of the ring at a leg and the perpendicular to that leg [rad].
        bend: Length of the arc between a leg and the ring [m].
        around: Length of the ring [m].
        clear: Distance before the ring at which a vehicle on the arc still keeps clear of all on the ring, the
            footprints of both as large as reasoning plans with [m].
    """

    def __init__(self, radius: float, entry_radius: float, leg_length: float) -> None:
        self.radius, self.entry_radius, self.leg_length = radius, entry_radius, leg_length
        self.touch = math.acos((LANE_WIDTH / 2 + entry_radius) / (radius + entry_radius))
        self.bend = entry_radius * self.touch
        self.around = 2 * math.pi * radius
        # The front corner of a vehicle coming in, seen from the middle of the arc, against the outermost on the ring.
        ahead, aside = PLANNING.length / 2, PLANNING.width / 2
        corner, on_ring = math.hypot(entry_radius + aside, ahead), math.hypot(radius + aside, ahead)
        apart = radius + entry_radius
        cosine = (apart**2 + corner**2 - on_ring**2) / (2 * apart * corner)
        self.clear = entry_radius * (math.atan2(ahead, entry_radius + aside) + math.acos(cosine))

    def lanes(self) -> tuple[Lane, ...]:
        """Build all lanes."""
        none, cont, dash = Line.NONE, Line.CONTINUOUS, Line.STRIPED
        half, far = LANE_WIDTH / 2, self.entry_radius + LANE_WIDTH / 2
        deep = math.sqrt((self.radius + self.entry_radius) ** 2 - far**2)
        lanes = []
        for leg in range(4):
            quarter = -math.pi / 2 * leg

            def at(x: float, y: float, quarter: float = quarter) -> Point:
                return turned((x, y), quarter)

            def lane(start: str, end: str, shape: LaneShape, rank: int, lines: tuple[Line, Line]) -> None:
                lanes.append(Lane((start, end, 0), shape, LANE_WIDTH, SPEED_LIMIT, rank, lines))

            begin, arc_begin, entry = f"from{leg}", f"bend{leg}", f"in{leg}"
            leaves, arc_end, end = f"out{leg}", f"straight{leg}", f"to{leg}"
            lane(begin, arc_begin, Straight(at(half, deep + self.leg_length), at(half, deep)), 0, (dash, cont))
            bend_in = Arc(at(far, deep), self.entry_radius, math.pi + quarter, math.pi + self.touch + quarter)
            lane(arc_begin, entry, bend_in, 0, (none, cont))
            bend_out = Arc(at(-far, deep), self.entry_radius, quarter - self.touch, quarter)
            lane(leaves, arc_end, bend_out, 0, (none, cont))
            lane(arc_end, end, Straight(at(-half, deep), at(-half, deep + self.leg_length)), 0, (none, cont))
            touches = self.touch + quarter
            lane(entry, f"out{(leg + 1) % 4}", self._arc(touches, math.pi / 2 - self.touch + quarter), 1, (cont, cont))
            lane(leaves, entry, self._arc(math.pi - self.touch + quarter, touches), 1, (cont, dash))
        return tuple(lanes)

    def routes(self, exit_distance: float) -> tuple[Route, ...]:
        """Build the twelve routes that do not turn back."""
        routes = []
        for leg, name in enumerate(LEGS):
            for turn, steps in TURNS.items():
                lanes: list[LaneId] = [(f"from{leg}", f"bend{leg}", 0), (f"bend{leg}", f"in{leg}", 0)]
                for k in range(leg, leg + steps):
                    if k > leg:
                        lanes.append((f"out{k % 4}", f"in{k % 4}", 0))
                    lanes.append((f"in{k % 4}", f"out{(k + 1) % 4}", 0))
                out = (leg + steps) % 4
                lanes += [(f"out{out}", f"straight{out}", 0), (f"straight{out}", f"to{out}", 0)]
                entry = self.leg_length + self.bend - math.ceil(2 * self.clear) / 2
                goal = self.leg_length + self.bend + self.on_ring(steps) + exit_distance
                routes.append(Route(f"{name}-{LEGS[out]}", tuple(lanes), turn, entry, goal))
        return tuple(routes)

    def on_ring(self, steps: int) -> float:
        """Return how far a route drives on the ring [m]."""
        return self.radius * (steps * math.pi / 2 - (math.pi - 2 * self.touch))

    def _arc(self, start: float, end: float) -> Arc:
        return Arc((0.0, 0.0), self.radius, start, end, clockwise=False)


@dataclass(kw_only=True, eq=False, repr=False)
class Roundabout(JunctionScenario):
    """Several CAVs among human drivers, some of whom are on the ring already."""

    name = "roundabout"

    on_ring: float
    radius: float
    entry_radius: float
    leg_length: float

    def check(self) -> None:
        require_range("on_ring", self.on_ring, 0, 1)
        require_range("radius", self.radius, 12, 60, " m")
        require_range("entry_radius", self.entry_radius, 10, 40, " m")
        require_range("leg_length", self.leg_length, 40, 500, " m")
        self._ring = Ring(self.radius, self.entry_radius, self.leg_length)
        require(
            self._ring.on_ring(1) >= TOGETHER,
            f"entry_radius {self.entry_radius:g} m is too large for a ring of radius {self.radius:g} m: entries and "
            "exits would overlap; use a smaller entry_radius or a larger radius",
        )
        require_range("exit_distance", self.exit_distance, 5, self._ring.bend + self.leg_length - 10, " m")
        self.crowd.check(12, 12, self.leg_length - 15, "15 m before the end of the leg at the latest", SPEED_LIMIT)
        self.crowd.require_room(len(LEGS), f"{len(LEGS)} legs", hdvs=None if self.on_ring < 1 else 0)
        self.check_scene()

    @cached_property
    def road(self) -> Road:
        """The ring and its legs; vehicles on the ring go first."""
        return Road("roundabout", self._ring.lanes(), self._ring.routes(self.exit_distance), True)

    def placed(self, seed: int, suits: Suits | None = None) -> Scene:
        before = self.leg_length + self._ring.bend

        def spot(start: Start) -> tuple[str, float]:
            leg = start.route.split("-")[0]
            if start.position < before:
                return leg, start.position
            return "ring", LEGS.index(leg) * self._ring.around / 4 + start.position - before

        return place(seed, self.crowd, self.road, self.draw, spot, {"ring": self._ring.around}, suits)

    def between(self, rng: np.random.Generator, name: str, kind: Kind, route: Route) -> tuple[float, float] | None:
        before = self.leg_length + self._ring.bend
        if kind is Kind.HDV and float(rng.random()) < self.on_ring:
            return before, before + self._ring.on_ring(TURNS[route.turn])
        return super().between(rng, name, kind, route)
