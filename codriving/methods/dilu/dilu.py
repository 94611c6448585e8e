"""DiLu: each CAV on its own describes what it sees, recalls what was like it, reasons, and learns from its mistakes."""

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from math import ceil
from pathlib import Path
from typing import TYPE_CHECKING

from codriving.datatypes.parts import Account, CaseMemory, Method, Model
from codriving.datatypes.record import Outcome
from codriving.datatypes.road import Road
from codriving.datatypes.situation import Decision, ReasonedDeliberation, Situation
from codriving.datatypes.world import Action, DrivingModel, WorldState
from codriving.errors import ConfigError
from codriving.geometry.road_map import RoadMap
from codriving.methods.dilu.collision_log import CollisionLog, Correction, Mistake
from codriving.methods.dilu.description import describe_alone
from codriving.methods.dilu.rule import correct_by_rule, decide_by_rule
from codriving.methods.experience_log import learn, recall
from codriving.methods.language_model.prompted_model import check_model, prompt_files, prompted
from codriving.methods.single_vehicle.demonstrated import CONSTANT
from codriving.methods.single_vehicle.method import Driver
from codriving.reasoning.perception import single_vehicle_perception
from codriving.reasoning.prediction.forecast import Forecast

if TYPE_CHECKING:
    from codriving.methods.language_model.model_decider import ModelDecider


class DiLu(Method):
    """The method; with ``llm=offline`` a rule stands in for its language model, and it is called ``dilu-rule``.

    Args:
        memory: What was like it before, and perhaps what is learnt from this; None for no examples at all.
        hold: Time between two decisions of a CAV, rounded up to whole decision steps; its targets are held meanwhile
            [s].

    Raises:
        ConfigError: If a setting is out of range, or a template cannot be used.
    """

    def __init__(self, llm: Model, memory: CaseMemory | None, hold: float, shots: int, rule: Driver) -> None:
        if not 0.1 <= hold <= 10:
            raise ConfigError(f"hold must be 0.1 to 10 s, got {hold:g}")
        if not 1 <= shots <= 50:
            raise ConfigError(f"shots must be 1 to 50, got {shots}")
        check_model(llm, memory)
        self.llm, self.memory, self.hold, self.shots, self.rule = llm, memory, hold, shots, rule
        # What answers without a model is not DiLu.
        self.name = "dilu-rule" if llm.chat() is None else "dilu"
        self.reasoner = llm.name
        self.remembers = memory.label if memory is not None else ""

    def files(self, road: Road) -> Mapping[str, Path]:
        return prompt_files(self.llm, self.memory, ("dilu",), "dilu_reflect")

    def reset(self, road_map: RoadMap, model: DrivingModel, seed: int) -> None:
        """Begin an episode."""
        self._steps = max(1, ceil(self.hold / model.decision_interval - 1e-6))
        # A CAV that decides every second predicts what follows from deciding every second.
        held = replace(model, decision_interval=self._steps * model.decision_interval)
        self._perception = single_vehicle_perception(road_map, Forecast(held, CONSTANT))
        self._model = prompted(self.llm)
        self._held: dict[str, tuple[Situation, Decision]] = {}
        self._decided = 0
        self._seed = seed
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
        if self.memory is not None:
            self.memory.begin(seed)

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
        return ReasonedDeliberation(
            world.time, world.step, tuple(given), tuple(decisions), {**counts, **model_counts}, tuple(lines)
        )

    def conclude(self, world: WorldState, outcome: Outcome) -> Account:
        if self._log is None or self.memory is None:
            return {}, []
        experiences = self._log.conclude(world, outcome)
        learnt = learn(self.memory, self, self._perception.road_map.road.name, self._seed, experiences)
        model_counts, lines = self.unfinished_step(world.time)
        return {**model_counts, **learnt}, lines

    def unfinished_step(self, time: float) -> Account:
        return self._model.ledger.close_step(time) if self._model is not None else ({}, [])


def _holds(decision: Decision) -> Decision:
    """Leave targets as the last decision has set them, as highway-env does between two decisions a second apart."""
    return Decision(decision.ego, Action.IDLE, f"holds {decision.action}: {decision.reason}")
