"""What every CAV knew and decided in one episode, and what of that is worth remembering at its end."""

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from codriving.datatypes import (
    Action,
    CaseMemory,
    Collision,
    Decision,
    DrivingModel,
    Experience,
    MetDriver,
    Outcome,
    Role,
    Situation,
    Verdict,
    WorldState,
)
from codriving.geometry import RoadMap
from codriving.memory import LESSONS, DecisionHistory, HistoryStep, OwnCollision, describe, effect_of, verdict_of
from codriving.reasoning import SharedStates, Tracking, describe_scenes, find_conflicts


@dataclass(frozen=True, slots=True)
class LoggedDecision:
    """One decision of one CAV."""

    time: float  # Simulated time [s]
    step: int
    situation: Situation
    decision: Decision


class ExperienceLog(ABC):
    """The decisions of one episode; a method says which of them are remembered, and with which lesson."""

    def __init__(self) -> None:
        self.decisions: dict[str, list[LoggedDecision]] = {}

    def note(self, world: WorldState, situations: Sequence[Situation], decisions: Sequence[Decision]) -> None:
        """Note one decision step."""
        for situation, decision in zip(situations, decisions, strict=True):
            logged = LoggedDecision(world.time, world.step, situation, decision)
            self.decisions.setdefault(decision.ego, []).append(logged)

    def conclude(self, world: WorldState, outcome: Outcome) -> list[Experience]:
        """Return what is worth remembering, by step and id of the CAV."""
        return sorted(self.experiences(world, outcome), key=lambda e: (e.step, e.ego))

    @abstractmethod
    def experiences(self, world: WorldState, outcome: Outcome) -> list[Experience]:
        """Return what is worth remembering, in any order."""


class ConflictLog(ExperienceLog):
    """CoDrivingLLM's: judges at the end of an episode what each action did to a conflict (paper Section III-D.1).

    Effects are judged with all states and the intents of all CAVs, whatever the CDA level hides from the deciders:
    what came of an action is seen from outside. A human driver's route is not known here either. What is *remembered*
    of a situation is only what the CAV knew.
    """

    def __init__(self, road_map: RoadMap, model: DrivingModel) -> None:
        super().__init__()
        self._road_map, self._model = road_map, model
        self._tracking, self._sharing = Tracking(road_map), SharedStates()
        self._steps: dict[str, list[HistoryStep]] = {}
        self._begun: float | None = None

    def note(self, world: WorldState, situations: Sequence[Situation], decisions: Sequence[Decision]) -> None:
        super().note(world, situations, decisions)
        self._look(world, {d.ego: (s, d.action) for s, d in zip(situations, decisions, strict=True)})

    def experiences(self, world: WorldState, outcome: Outcome) -> list[Experience]:
        self._look(world, {})
        found = []
        for name, logged in self.decisions.items():
            collision = self._own_collision(name, outcome.collision)
            history = DecisionHistory(tuple(self._steps[name]), self._model.decision_interval, collision)
            for k, one in enumerate(logged):
                action, effect = one.decision.action, effect_of(history, k)
                verdict = verdict_of(effect, action)
                if verdict is not Verdict.NEUTRAL:
                    described, lesson = describe(one.situation), LESSONS[verdict]
                    found.append(Experience(described, action, verdict, effect, lesson, one.step, name))
        return found

    def _look(self, world: WorldState, decided: Mapping[str, tuple[Situation, Action]]) -> None:
        if self._begun is None:
            self._begun = world.time
        views = self._sharing.detections(world, self._model)
        for name, scene in describe_scenes(world, views, world.intents, self._tracking).items():
            situation, action = decided.get(name, (None, None))
            others = {vehicle.id: vehicle for vehicle in world.vehicles if vehicle.id != name}
            conflicts = find_conflicts(scene, self._road_map)
            gap = next((n.gap for n in scene.neighbours if n.role is Role.LEADING), None)
            could_go = situation is not None and action is not None and _could_go(situation, action)
            self._steps.setdefault(name, []).append(HistoryStep(scene.ego, others, conflicts, gap, action, could_go))

    def _own_collision(self, name: str, collision: Collision | None) -> OwnCollision | None:
        if collision is None or name not in (collision.striker, collision.struck) or self._begun is None:
            return None
        strikes = name == collision.striker
        return OwnCollision(collision.time - self._begun, collision.struck if strikes else collision.striker, strikes)


def _could_go(situation: Situation, action: Action) -> bool:
    """Whether an action along the lane was allowed that is faster than the one taken."""
    taken = situation.scene.speed_rank(action)
    ranks = (situation.scene.speed_rank(a) for a in situation.allowed)
    return taken is not None and any(rank is not None and rank > taken for rank in ranks)


def recall(memory: CaseMemory | None, situations: Sequence[Situation], most: int | None = None) -> list[Situation]:
    """Put what is remembered of similar situations into each (paper Algorithm 1)."""
    if memory is None or not situations:
        return list(situations)
    found = zip(situations, memory.recall(situations), strict=True)
    return [replace(situation, memories=memories[:most]) if memories else situation for situation, memories in found]


def learn(
    memory: CaseMemory, experiences: Sequence[Experience], encounters: Sequence[MetDriver] = ()
) -> dict[str, float]:
    """Put what was experienced in an episode into a memory, and what human drivers did in it."""
    new = memory.learn(experiences, encounters) if encounters else memory.learn(experiences)
    learnt: dict[str, float] = {"experiences": len(experiences), "experiences_new": new}
    return {**learnt, "encounters": len(encounters)} if encounters else learnt
