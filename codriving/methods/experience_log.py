"""Looks on while an episode is driven, and judges at its end what each action did (paper Section III-D.1)."""

from collections.abc import Mapping, Sequence

from codriving.datatypes.action import Action
from codriving.datatypes.driving_model import DrivingModel
from codriving.datatypes.experience import Experience, Verdict
from codriving.datatypes.outcome import Collision
from codriving.datatypes.scene_description import Role
from codriving.datatypes.situation import Decision, Situation
from codriving.datatypes.world import WorldState
from codriving.geometry.road_map import RoadMap
from codriving.memory.describe import describe
from codriving.memory.effect import LESSONS, DecisionHistory, HistoryStep, OwnCollision, effect_of, verdict_of
from codriving.reasoning.conflicts import find_conflicts
from codriving.reasoning.sharing.scenes import describe_scenes
from codriving.reasoning.sharing.sharing import SharedStates
from codriving.reasoning.sharing.tracking import Tracking

FASTER_THAN: Mapping[Action | None, tuple[Action, ...]] = {
    Action.SLOWER: (Action.IDLE, Action.FASTER),
    Action.IDLE: (Action.FASTER,),
}
"""What would have been faster than an action."""


class ExperienceLog:
    """One episode as it is looked back on.

    Effects are judged with all states and the intents of all CAVs, whatever the CDA level hides from those who decide:
    what came of an action is seen from outside. A human driver's route is not known here either. What is *remembered*
    of a situation is only what the CAV was told.
    """

    def __init__(self, road_map: RoadMap, model: DrivingModel) -> None:
        self._road_map, self._model = road_map, model
        self._tracking, self._sharing = Tracking(road_map), SharedStates()
        self._steps: dict[str, list[HistoryStep]] = {}
        self._told: dict[str, list[tuple[int, Situation]]] = {}
        self._begun: float | None = None

    def note(self, world: WorldState, situations: Sequence[Situation], decisions: Sequence[Decision]) -> None:
        """Note one decision step."""
        told = {s.scene.ego.id: (s, d.action) for s, d in zip(situations, decisions, strict=True)}
        self._look(world, told)
        for name, (situation, _) in told.items():
            self._told.setdefault(name, []).append((world.step, situation))

    def conclude(self, world: WorldState, collision: Collision | None) -> list[Experience]:
        """Judge everything that was decided.

        Returns:
            What is worth keeping, by step and id of the CAV.
        """
        self._look(world, {})
        found = []
        for name, told in self._told.items():
            way = DecisionHistory(tuple(self._steps[name]), self._model.decision_interval, self._crash(name, collision))
            for k, (step, situation) in enumerate(told):
                action = way.steps[k].action
                assert action is not None
                effect = effect_of(way, k)
                verdict = verdict_of(effect, action)
                if verdict is not Verdict.NEUTRAL:
                    found.append(Experience(describe(situation), action, verdict, effect, LESSONS[verdict], step, name))
        return sorted(found, key=lambda e: (e.step, e.ego))

    def _look(self, world: WorldState, told: dict[str, tuple[Situation, Action]]) -> None:
        if self._begun is None:
            self._begun = world.time
        views = self._sharing.detections(world, self._model)
        scenes = describe_scenes(world, views, world.intents, self._tracking)
        everybody = {v.id: v for v in world.vehicles}
        for name, scene in scenes.items():
            situation, action = told.get(name, (None, None))
            self._steps.setdefault(name, []).append(
                HistoryStep(
                    ego=scene.ego,
                    others={other: state for other, state in everybody.items() if other != name},
                    conflicts=find_conflicts(scene, self._road_map),
                    lead_gap=next((n.gap for n in scene.neighbours if n.role is Role.LEADING), None),
                    action=action,
                    could_go=situation is not None and any(a in situation.allowed for a in FASTER_THAN.get(action, ())),
                )
            )

    def _crash(self, name: str, collision: Collision | None) -> OwnCollision | None:
        if collision is None or name not in (collision.striker, collision.struck) or self._begun is None:
            return None
        strikes = name == collision.striker
        other = collision.struck if strikes else collision.striker
        return OwnCollision(collision.time - self._begun, other, strikes)
