"""The negotiation sub-module: one order for all, or each CAV's own in one of three readings (III-C.3 and IV-B)."""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from math import exp
from zlib import crc32

import numpy as np

from codriving.datatypes import PassingOrder, Precedence, SceneDescription, TrackedVehicle, Turn
from codriving.reasoning.conflicts import ttcp
from codriving.reasoning.ordering.coordinator import TURN_YIELDS, Coordinator, without_cycles
from codriving.reasoning.ordering.problem import passes_first
from codriving.reasoning.perception import Moment
from codriving.reasoning.sharing.sharing import OwnOrder

DOUBT = 1.0  # Difference of arrival times at which a guess is right in about three of four cases [s]


class Negotiation(ABC):
    """Gives every CAV the order that it goes by."""

    @abstractmethod
    def orders(self, moment: Moment) -> Mapping[str, PassingOrder]:
        """Return the passing order of each CAV, by id."""


class AgreedOrder(Negotiation):
    """Agreement-seeking (class C) and prescriptive (class D): all CAVs go by the coordinator's order."""

    def __init__(self, coordinator: Coordinator) -> None:
        self.coordinator = coordinator

    def orders(self, moment: Moment) -> Mapping[str, PassingOrder]:
        """Return the same order for every CAV."""
        return dict.fromkeys(moment.scenes, self.coordinator.negotiate(moment))


class OwnOrders(Negotiation):
    """Every CAV orders its own conflicts by what it knows.

    ``own_view`` estimates the others' arrival at their present speed and decides ties for itself; ``same_rule`` applies
    the coordinator's rule to the shared speeds; ``independent`` guesses once for each conflict, more likely right the
    clearer the difference is.
    """

    def __init__(self, reading: OwnOrder, seed: int) -> None:
        self.reading, self.seed = reading, seed
        self._guesses: dict[tuple[str, str], bool] = {}

    def orders(self, moment: Moment) -> Mapping[str, PassingOrder]:
        """Return each CAV's own order, by id."""
        return {ego: self._own(moment, ego) for ego in moment.scenes}

    def _own(self, moment: Moment, ego: str) -> PassingOrder:
        scene, conflicts = moment.scenes[ego], moment.conflicts[ego]
        precedences: list[Precedence] = []
        times: dict[str, float] = {}
        for other in dict.fromkeys(c.other for c in conflicts):
            n = scene.neighbour(other)
            if n is None:
                continue
            shared = [c for c in conflicts if c.other == other]
            c, forecast = shared[0], moment.forecast
            mine = forecast.time_to(c.distances[0], forecast.reach(scene.ego.speed, True, scene.where).most)
            if self.reading == "own_view" or n.intent is None:
                theirs = ttcp(c.distances[1], n.speed)
            else:
                theirs = forecast.time_to(c.distances[1], forecast.reach(n.speed, True, n.routes[0]).most)
            times[ego], times[other] = min(mine, times.get(ego, mine)), theirs
            if n.intent is None:
                first = passes_first(moment, ego, n, shared)
                reason = "through before the human driver can be there" if first else "a human driver may come first"
            else:
                first, reason = self._compare(moment, scene, n, mine, theirs)
            pair = (ego, other) if first else (other, ego)
            precedences.append(Precedence(*pair, f"own estimate: {reason}"))
        kept, sequence = without_cycles(precedences, times)
        return PassingOrder(sequence, kept)

    def _compare(
        self, moment: Moment, scene: SceneDescription, n: TrackedVehicle, mine: float, theirs: float
    ) -> tuple[bool, str]:
        lead = theirs - mine - (_handicap(moment, scene.intent.route) - _handicap(moment, n.routes[0][0]))
        said = f"{mine:.1f} s against {theirs:.1f} s for {n.id}"
        if self.reading == "independent":
            pair = (scene.ego.id, n.id)
            if pair not in self._guesses:
                draw = np.random.default_rng((self.seed, crc32("|".join(pair).encode()))).random()
                self._guesses[pair] = bool(draw < 1 / (1 + exp(-max(min(lead / DOUBT, 50.0), -50.0))))
            return self._guesses[pair], f"a guess at {said}"
        if self.reading == "same_rule" and abs(lead) < 1e-9:
            return scene.ego.id < n.id, said
        return lead >= 0, said


def _handicap(moment: Moment, route: str) -> float:
    return 0.0 if moment.road_map.routes[route].turn is Turn.STRAIGHT else TURN_YIELDS
