"""Without negotiation each CAV makes up its own passing order (paper Section IV-B), in one of three readings."""

from collections.abc import Mapping
from math import exp
from zlib import crc32

import numpy as np

from codriving.datatypes.conflict import Conflict
from codriving.datatypes.order import PassingOrder, Precedence
from codriving.datatypes.road import Turn
from codriving.datatypes.scene_description import SceneDescription, TrackedVehicle
from codriving.geometry.road_map import RoadMap
from codriving.reasoning.ordering.acyclic import without_cycles
from codriving.reasoning.ordering.coordinator import TURN_YIELDS
from codriving.reasoning.ordering.human_windows import passes_first
from codriving.reasoning.ordering.problem import Conflicts, Scenes
from codriving.reasoning.prediction.forecast import Forecast
from codriving.reasoning.severity import ttcp
from codriving.reasoning.sharing.cda import OwnOrder

DOUBT = 1.0
"""Difference of arrival times at which a guess is right in about three of four cases [s]."""


class OwnOrders:
    """Every CAV orders its own conflicts by what it knows.

    ``own_view`` estimates the others' arrival at their present speed and decides ties for itself; ``same_rule`` applies
    the coordinator's rule to the shared speeds; ``independent`` guesses once for each conflict, more likely right the
    clearer the difference is.
    """

    def __init__(self, road_map: RoadMap, forecast: Forecast, reading: OwnOrder, seed: int) -> None:
        self.road_map, self.forecast, self.reading, self.seed = road_map, forecast, reading, seed
        self._guesses: dict[tuple[str, str], bool] = {}

    def orders(self, scenes: Scenes, conflicts: Conflicts) -> Mapping[str, PassingOrder]:
        """Return each CAV's own order, by id."""
        return {ego: self._own(scenes[ego], conflicts[ego]) for ego in scenes}

    def _own(self, scene: SceneDescription, conflicts: tuple[Conflict, ...]) -> PassingOrder:
        ego = scene.ego.id
        precedences: list[Precedence] = []
        times: dict[str, float] = {}
        for other in dict.fromkeys(c.other for c in conflicts):
            n = scene.neighbour(other)
            if n is None:
                continue
            shared = [c for c in conflicts if c.other == other]
            mine, theirs = self._arrival(scene, shared[0]), self._other_arrival(n, shared[0])
            times[ego], times[other] = min(mine, times.get(ego, mine)), theirs
            if n.intent is None:
                first = passes_first(scene, n, shared, self.road_map, self.forecast)
                reason = "through before the human driver can be there" if first else "a human driver may come first"
            else:
                first, reason = self._compare(scene, n, mine, theirs)
            pair = (ego, other) if first else (other, ego)
            precedences.append(Precedence(*pair, f"own estimate: {reason}"))
        kept, sequence = without_cycles(precedences, times)
        return PassingOrder(sequence, kept)

    def _compare(self, scene: SceneDescription, n: TrackedVehicle, mine: float, theirs: float) -> tuple[bool, str]:
        handicap = self._handicap(scene.intent.route) - self._handicap(n.routes[0][0])
        lead = theirs - mine - handicap
        said = f"{mine:.1f} s against {theirs:.1f} s for {n.id}"
        if self.reading == "independent":
            pair = (scene.ego.id, n.id)
            if pair not in self._guesses:
                entropy = (self.seed, crc32("|".join(pair).encode()))
                draw = np.random.default_rng(np.random.SeedSequence(entropy)).random()
                self._guesses[pair] = bool(draw < 1 / (1 + exp(-max(min(lead / DOUBT, 50.0), -50.0))))
            return self._guesses[pair], f"a guess at {said}"
        if self.reading == "same_rule" and abs(lead) < 1e-9:
            return scene.ego.id < n.id, said
        return lead >= 0, said

    def _arrival(self, scene: SceneDescription, c: Conflict) -> float:
        return self.forecast.time_to(c.distances[0], self.forecast.reach(scene.ego.speed, True).most)

    def _other_arrival(self, n: TrackedVehicle, c: Conflict) -> float:
        if self.reading == "own_view" or n.intent is None:
            return ttcp(c.distances[1], n.speed)
        return self.forecast.time_to(c.distances[1], self.forecast.reach(n.speed, True).most)

    def _handicap(self, route: str) -> float:
        return 0.0 if self.road_map.routes[route].turn is Turn.STRAIGHT else TURN_YIELDS
