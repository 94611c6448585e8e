"""The paper's algorithm: share states, share intents, negotiate, check, recall, decide (Algorithm 1)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from codriving.datatypes.action import Action
from codriving.datatypes.conflict import Conflict
from codriving.datatypes.deliberation import ReasonedDeliberation
from codriving.datatypes.order import PassingOrder
from codriving.datatypes.parts import CaseMemory
from codriving.datatypes.scene_description import SceneDescription, TrackedVehicle
from codriving.datatypes.situation import Situation
from codriving.datatypes.world import WorldState
from codriving.geometry.road_map import RoadMap
from codriving.llm.ledger import Ledger
from codriving.reasoning.decision.clear_times import clear_time
from codriving.reasoning.decision.decider import Decider
from codriving.reasoning.ordering.negotiation import Negotiation
from codriving.reasoning.perception import Perception
from codriving.reasoning.prediction.expectation import Expected, Motions, expect, motions_of
from codriving.reasoning.prediction.forecast import Forecast
from codriving.reasoning.safety.assessment import SafetyCheck
from codriving.reasoning.safety.outlook import Outlook, motions


@dataclass(slots=True)
class Pipeline:
    """One episode of the paper's reasoning; an ablation puts another object into a slot.

    Attributes:
        margin: Time that should lie between one vehicle's leaving a zone and the next one's entering it [s].
        memory: Experiences of like situations; None without the memory module.
        ledger: What is asked of a language model; None if none is.
    """

    perception: Perception
    negotiation: Negotiation
    safety: SafetyCheck
    decider: Decider
    margin: float
    memory: CaseMemory | None = None
    ledger: Ledger | None = None

    def act(self, world: WorldState) -> ReasonedDeliberation:
        """Decide for every CAV on the road."""
        moment = self.perception.perceive(world)
        scenes, conflicts, known = moment.scenes, moment.conflicts, moment.vehicles
        orders = self.negotiation.orders(moment)
        expectations = self._expectations(known, orders)
        situations = tuple(
            self._situation(
                scenes[ego], conflicts[ego], orders[ego], known[ego], expectations[ego], world.available[ego]
            )
            for ego in scenes
        )
        situations = self._remembering(situations)
        decisions = tuple(self.decider.decide(situations))
        counts, lines = self.ledger.close_step(world.time) if self.ledger is not None else ({}, [])
        if self.memory is not None:
            counts = {
                **counts,
                "recalled": sum(len(s.memories) for s in situations),
                "reconsidered": sum(bool(d.recalled) for d in decisions),
            }
        return ReasonedDeliberation(world.time, world.step, situations, decisions, counts, tuple(lines))

    def _remembering(self, situations: Sequence[Situation]) -> tuple[Situation, ...]:
        """Put what is remembered of like situations beside each (paper Algorithm 1)."""
        if self.memory is None:
            return tuple(situations)
        found = self.memory.recall(situations)
        return tuple(
            replace(s, memories=memories) if memories else s for s, memories in zip(situations, found, strict=True)
        )

    @property
    def road_map(self) -> RoadMap:
        """The precomputed road."""
        return self.perception.road_map

    @property
    def forecast(self) -> Forecast:
        """Predictions of the present step."""
        return self.perception.forecast

    @property
    def _finds_conflicts(self) -> bool:
        return self.perception.intent_sharing.finds_conflicts

    @property
    def _lag(self) -> int:
        return round(self.margin / self.forecast.sample)

    def _expectations(
        self, known: Mapping[str, dict[str, TrackedVehicle]], orders: Mapping[str, PassingOrder]
    ) -> dict[str, dict[str, tuple[Expected, ...]]]:
        """Expect what follows from each CAV's knowledge and order; those who agree in both share one expectation."""
        done: dict[tuple[int, Motions], dict[str, tuple[Expected, ...]]] = {}
        found = {}
        for ego, vehicles in known.items():
            order = orders[ego]
            key = id(order), motions_of(vehicles)
            if key not in done:
                done[key] = expect(vehicles, order, self.road_map, self.forecast, self._lag, self._finds_conflicts)
            found[ego] = done[key]
        return found

    def _situation(
        self,
        scene: SceneDescription,
        conflicts: tuple[Conflict, ...],
        order: PassingOrder,
        known: dict[str, TrackedVehicle],
        expected: dict[str, tuple[Expected, ...]],
        actions: tuple[Action, ...],
    ) -> Situation:
        stops, goes = motions(scene, actions, self.forecast)
        outlook = Outlook(
            scene,
            conflicts,
            order,
            known,
            expected,
            actions,
            stops,
            goes,
            self.road_map,
            self.forecast,
            self._lag,
            self._finds_conflicts,
        )
        return Situation(
            scene=scene,
            conflicts=conflicts,
            order=order,
            clear_times=tuple(clear_time(outlook, c) for c in conflicts),
            assessments=self.safety.assess(outlook),
        )
