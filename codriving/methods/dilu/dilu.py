"""DiLu: each CAV on its own describes what it sees, recalls what was like it, reasons, and learns from its mistakes."""

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from math import ceil, inf
from typing import TYPE_CHECKING

from codriving.datatypes import (
    Account,
    Action,
    ActionAssessment,
    CaseMemory,
    Decision,
    DrivingModel,
    LaneNeighbour,
    Model,
    Outcome,
    PassingOrder,
    ReasonedDeliberation,
    SceneDescription,
    Situation,
    WorldState,
)
from codriving.errors import require_range
from codriving.geometry import RoadMap
from codriving.methods.dilu.collision_log import CollisionLog, Correction, Mistake
from codriving.methods.dilu.rule import correct_by_rule, decide_by_rule
from codriving.methods.experience_log import learn, recall
from codriving.methods.language_model.prompted_model import ModelMethod
from codriving.methods.single_vehicle.demonstrated import CONSTANT
from codriving.methods.single_vehicle.lane_choice import look
from codriving.methods.single_vehicle.method import Driver
from codriving.reasoning import SIDES, Forecast, Moment, single_vehicle_perception

if TYPE_CHECKING:
    from codriving.methods.language_model.model_decider import ModelDecider


class DiLu(ModelMethod):
    """The method; with ``llm=offline`` a rule stands in for its language model, and it is called ``dilu-rule``."""

    asked, reflects = ("dilu",), "dilu_reflect"

    def __init__(self, llm: Model, memory: CaseMemory | None, hold: float, shots: int, rule: Driver) -> None:
        require_range("hold", hold, 0.1, 10, " s")
        require_range("shots", shots, 1, 50)
        super().__init__(llm, memory)
        self.hold, self.shots, self.rule = hold, shots, rule
        # What answers without a model is not DiLu.
        self.name = "dilu-rule" if llm.chat() is None else "dilu"

    def corrects(self) -> bool:
        """Whether a model is asked about mistakes: always if the memory learns, whatever ``memory.reflection`` is."""
        return self.memory is not None and self.memory.learns

    def reset(self, road_map: RoadMap, model: DrivingModel, seed: int) -> None:
        """Begin an episode."""
        super().reset(road_map, model, seed)
        self._steps = max(1, ceil(self.hold / model.decision_interval - 1e-6))
        # A CAV that decides every second predicts what follows from deciding every second.
        held = replace(model, decision_interval=self._steps * model.decision_interval)
        self._perception = single_vehicle_perception(road_map, Forecast(held, CONSTANT, road_map))
        self._held: dict[str, tuple[Situation, Decision]] = {}
        self._decided = 0
        self._decider: ModelDecider | None = None
        correct: Callable[[Sequence[Mistake]], list[Correction]] = correct_by_rule
        if self._model is None:
            self.rule.reset()
        else:
            # pydantic is needed only if a model is asked.
            from codriving.methods.dilu.model import SightDecider, correct_by_model

            self._decider = SightDecider(self._model, road_map, held)
            correct = partial(correct_by_model, self._model, road_map, held)
        self._log = CollisionLog(correct) if self.memory is not None and self.memory.learns else None

    def act(self, world: WorldState) -> ReasonedDeliberation:
        """Decide for every CAV on the road, one by one; between decisions hold what was decided."""
        names = [cav.id for cav in world.cavs]
        if all(name in self._held for name in names) and world.step < self._decided + self._steps:
            based_on = tuple(self._held[name][0] for name in names)
            held = tuple(_holds(self._held[name][1]) for name in names)
            return ReasonedDeliberation(world.time, world.step, based_on, held, {})
        moment = self._perception.perceive(world)
        situations = recall(self.memory, [describe_alone(moment, ego) for ego in moment.scenes], self.shots)
        given, counts = situations, Counter[str]()
        if self._decider is not None:
            decisions = self._decider.decide(situations)
        else:
            given, decisions, counts = decide_by_rule(self.rule, moment, situations)
        self._held = {d.ego: (s, d) for s, d in zip(given, decisions, strict=True)}
        self._decided = world.step
        if self._log is not None:
            self._log.note(world, situations, decisions)
        if self.memory is not None:
            counts["recalled"] += sum(len(situation.memories) for situation in situations)
            counts["reconsidered"] += sum(bool(decision.recalled) for decision in decisions)
        model_counts, lines = self.unfinished_step(world.time)
        counted = {**counts, **model_counts}
        return ReasonedDeliberation(world.time, world.step, tuple(given), tuple(decisions), counted, tuple(lines))

    def conclude(self, world: WorldState, outcome: Outcome) -> Account:
        if self._log is None or self.memory is None:
            return {}, []
        experiences = self._log.conclude(world, outcome)
        learnt = learn(self.memory, experiences)
        model_counts, lines = self.unfinished_step(world.time)
        return {**model_counts, **learnt}, lines


def _holds(decision: Decision) -> Decision:
    """Leave targets as the last decision has set them, as highway-env does between two decisions a second apart."""
    return Decision(decision.ego, Action.IDLE, f"holds {decision.action}: {decision.reason}")


def describe_alone(moment: Moment, ego: str) -> Situation:
    """Describe what one CAV sees, without an order and without a check of the actions."""
    conflicts = moment.conflicts[ego]
    assessments = tuple(ActionAssessment(action, True, (), (), None) for action in moment.available[ego])
    # Which vehicle passes when is for the reasoner to find out.
    return Situation(placed(moment, ego), conflicts, PassingOrder((), ()), (inf,) * len(conflicts), assessments)


def placed(moment: Moment, ego: str) -> SceneDescription:
    """Return the scene with those next ahead and behind on the lanes beside.

    That is read off where they are and what the map says, since other vehicles share no lane with a vehicle on its own.
    """
    scene = moment.scenes[ego]
    sides = [side for a in SIDES if a in moment.available[ego] and (side := look(moment, ego, a, 0.0)) is not None]
    beside = tuple(
        LaneNeighbour(n.id, side.lane, n.role, max(n.gap or 0.0, 0.0))
        for side in sides
        for n in (side.ahead, side.behind)
        if n is not None
    )
    return replace(scene, beside=beside)
