"""The merge: a main road and a ramp whose vehicles must change onto it before their lane ends."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from codriving.datatypes import Block, Kind, Lane, LaneId, LaneShape, Line, Road, Route, Sine, Start, Straight, Turn
from codriving.environment.scenarios.placement import PlacedScenario
from codriving.errors import require_range

LANE_WIDTH = 4.0
SPEED_LIMIT = 20.0  # Speed limit on every lane [m/s]

SWAY = 3.25  # Half of what the ramp comes closer while it converges, as in highway-env [m]

TAPER = 40.0  # Length of the last part of the ramp lane, in which a vehicle that is still on it has to be changing [m]

PAST_MERGE = 80.0  # Distance past the end of the ramp lane at which a vehicle has arrived [m]


@dataclass(kw_only=True, eq=False, repr=False)
class Merge(PlacedScenario):
    """Several CAVs on the main road and on the ramp, among human drivers."""

    name = "merge"

    ramp_hdvs: float
    lanes: int
    before: float
    converge: float
    parallel: float
    after: float

    def check(self) -> None:
        require_range("ramp_hdvs", self.ramp_hdvs, 0, 1)
        require_range("lanes", self.lanes, 1, 4)
        require_range("before", self.before, 60, 1000, " m")
        require_range("converge", self.converge, 40, 500, " m")
        require_range("parallel", self.parallel, TAPER + 20, 1000, " m")
        require_range("after", self.after, PAST_MERGE + 20, 1000, " m")
        self.crowd.check(10, 20, self.before - 10, "10 m before the ramp converges at the latest", SPEED_LIMIT)
        self.crowd.require_room(1, "the ramp", self.cavs // 2, 0)
        self.crowd.require_room(self.lanes, f"{self.lanes} main lanes", self.cavs - self.cavs // 2, 0)
        self.crowd.require_room(self.lanes + 1, f"{self.lanes} main lanes and the ramp")

    @cached_property
    def road(self) -> Road:
        """The main lanes, the ramp beside them with highway-env's measures, and a block where its lane ends."""
        opens = self.before + self.converge
        ends = opens + self.parallel
        mains, right, goal = range(self.lanes), self.lanes - 1, ends + PAST_MERGE
        lanes = [self._main(*part, k) for part in (("a", "b", 0.0, opens), ("b", "c", opens, ends)) for k in mains]
        lanes += self._ramp(opens, ends)
        lanes += [self._main("c", "d", ends, ends + self.after, k) for k in mains]
        way: tuple[LaneId, ...]
        ways = [(("a", "b", k), ("b", "c", k), ("c", "d", k)) for k in mains]
        routes = [Route(f"main-{k}", way, Turn.STRAIGHT, opens, goal) for k, way in zip(mains, ways, strict=True)]
        way = (("j", "k", 0), ("k", "b", 0), ("b", "c", self.lanes), ("b", "c", right), ("c", "d", right))
        routes.append(Route("ramp", way, Turn.STRAIGHT, opens, goal, TAPER))
        return Road("merge", tuple(lanes), tuple(routes), blocks=(Block((ends, self.lanes * LANE_WIDTH)),))

    def _main(self, start: str, end: str, x: float, x2: float, k: int) -> Lane:
        left = Line.CONTINUOUS_LINE if k == 0 else Line.NONE
        lines = (left, Line.STRIPED if k < self.lanes - 1 or start == "b" else Line.CONTINUOUS_LINE)
        shape = Straight((x, k * LANE_WIDTH), (x2, k * LANE_WIDTH))
        return Lane((start, end, k), shape, LANE_WIDTH, SPEED_LIMIT, 1, lines)

    def _ramp(self, opens: float, ends: float) -> list[Lane]:
        near = self.lanes * LANE_WIDTH
        far, middle = near + 2 * SWAY, near + SWAY
        bend = Sine((self.before, middle), (opens, middle), SWAY, math.pi / self.converge, math.pi / 2)
        cont, none = Line.CONTINUOUS_LINE, Line.NONE
        shapes: list[tuple[LaneId, LaneShape, tuple[Line, Line]]] = [
            (("j", "k", 0), Straight((0.0, far), (self.before, far)), (cont, cont)),
            (("k", "b", 0), bend, (cont, cont)),
            (("b", "c", self.lanes), Straight((opens, near), (ends, near)), (none, cont)),
        ]
        return [Lane(k, s, LANE_WIDTH, SPEED_LIMIT, 0, lines, forbidden=True) for k, s, lines in shapes]

    def draw(self, rng: np.random.Generator, name: str, kind: Kind) -> Start:
        from_ramp = {f"CAV{k + 1}" for k in range(self.cavs - self.cavs // 2, self.cavs)}
        on_ramp = name in from_ramp if kind is Kind.CAV else float(rng.random()) < self.ramp_hdvs
        return self.crowd.start_on(rng, name, kind, "ramp" if on_ramp else f"main-{int(rng.integers(self.lanes))}")
