"""DiLu: each CAV on its own describes what it sees, recalls what was like it, reasons, and learns from its mistakes."""

from collections import Counter
from collections.abc import Mapping
from dataclasses import replace
from math import ceil
from pathlib import Path

from codriving.datatypes.action import Action
from codriving.datatypes.deliberation import ReasonedDeliberation
from codriving.datatypes.driving_model import DrivingModel
from codriving.datatypes.experience import Interaction
from codriving.datatypes.outcome import Outcome
from codriving.datatypes.parts import Account, CaseMemory, Method, Model
from codriving.datatypes.road import Road
from codriving.datatypes.situation import Decision
from codriving.datatypes.world import WorldState
from codriving.errors import ConfigError
from codriving.geometry.road_map import RoadMap
from codriving.methods.dilu.diary import Diary
from codriving.methods.dilu.ports import dilu_ports
from codriving.methods.dilu.thinker import Thought
from codriving.methods.dilu.told import Told, tell
from codriving.methods.language_model.ports import check_prompts, prompt_files
from codriving.methods.single_vehicle.demonstrated import CONSTANT
from codriving.methods.single_vehicle.method import Driver
from codriving.reasoning.perception import single_vehicle_perception
from codriving.reasoning.prediction.forecast import Forecast


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
        check_prompts(llm)
        if memory is not None and memory.reflections and llm.chat() is None:
            raise ConfigError(
                "memory.reflection=llm needs a language model; set llm= to one, or memory.reflection=rules"
            )
        self.llm, self.memory, self.hold, self.shots, self.rule = llm, memory, hold, shots, rule
        # Whatever answers without a model is not DiLu, whatever it is called.
        self.name = "dilu-rule" if llm.chat() is None else "dilu"
        self.reasoner = llm.name
        self.remembers = memory.label if memory is not None else ""

    def files(self, road: Road) -> Mapping[str, Path]:
        return prompt_files(self.llm, self.memory, ("dilu",), "dilu_reflect")

    def reset(self, road_map: RoadMap, model: DrivingModel, seed: int) -> None:
        """Begin an episode."""
        self._steps = max(1, ceil(self.hold / model.decision_interval - 1e-6))
        # Whoever decides every second predicts what follows from deciding every second.
        held = replace(model, decision_interval=self._steps * model.decision_interval)
        self._perception = single_vehicle_perception(road_map, Forecast(held, CONSTANT))
        self._thinker, self._reflector, self._ledger = dilu_ports(
            self.llm.chat(), self.llm.prompts, self.rule, held.decision_interval
        )
        self._thoughts: dict[str, Thought] = {}
        self._decided = 0
        self._seed = seed
        self._diary = Diary() if self.memory is not None and self.memory.learns else None
        if self.memory is not None:
            self.memory.begin(seed)

    def act(self, world: WorldState) -> ReasonedDeliberation:
        """Decide for every CAV on the road, one by one; between decisions hold what was decided."""
        names = [cav.id for cav in world.cavs]
        if all(name in self._thoughts for name in names) and world.step < self._decided + self._steps:
            kept = [self._thoughts[name] for name in names]
            situations = tuple(thought.situation for thought in kept)
            return ReasonedDeliberation(world.time, world.step, situations, tuple(_holds(t.decision) for t in kept), {})
        moment = self._perception.perceive(world)
        told = self._recall([tell(moment, ego) for ego in moment.scenes])
        thoughts = self._thinker.decide(told)
        self._thoughts = {thought.decision.ego: thought for thought in thoughts}
        self._decided = world.step
        if self._diary is not None:
            self._diary.note(world.time, world.step, told, [thought.decision for thought in thoughts])
        asked, lines = self._ledger.close_step(world.time) if self._ledger is not None else ({}, [])
        counts = Counter[str]()
        for thought in thoughts:
            counts.update(thought.counts)
        if self.memory is not None:
            counts["recalled"] += sum(len(one.situation.memories) for one in told)
            counts["reconsidered"] += sum(bool(thought.decision.recalled) for thought in thoughts)
        return ReasonedDeliberation(
            world.time,
            world.step,
            tuple(thought.situation for thought in thoughts),
            tuple(thought.decision for thought in thoughts),
            {**counts, **asked},
            tuple(lines),
        )

    def conclude(self, world: WorldState, outcome: Outcome) -> Account:
        if self._diary is None or self.memory is None:
            return {}, []
        experiences = self._diary.conclude(outcome, self._reflector)
        scenario = self._perception.road_map.road.name
        new = self.memory.learn(Interaction(scenario, self._seed, self.name, self.variant, self.reasoner), experiences)
        asked, lines = self._ledger.close_step(world.time) if self._ledger is not None else ({}, [])
        return {**asked, "experiences": len(experiences), "experiences_new": new}, lines

    def unfinished_step(self, time: float) -> Account:
        return self._ledger.close_step(time) if self._ledger is not None else ({}, [])

    def _recall(self, told: list[Told]) -> list[Told]:
        """Put what is remembered of like situations beside each."""
        if self.memory is None or not told:
            return told
        found = self.memory.recall([one.situation for one in told])
        return [
            replace(one, situation=replace(one.situation, memories=memories[: self.shots])) if memories else one
            for one, memories in zip(told, found, strict=True)
        ]


def _holds(decision: Decision) -> Decision:
    """Leave targets as the last decision has set them, as highway-env does between two decisions a second apart."""
    return Decision(decision.ego, Action.IDLE, f"holds {decision.action}: {decision.reason}")
