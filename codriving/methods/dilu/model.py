"""DiLu by a language model: one question a CAV about what it alone sees, and one about each mistake."""

from collections.abc import Sequence
from math import atan2, degrees
from typing import Any, cast

from codriving.datatypes import Action, Conflict, DrivingModel, SceneDescription, Situation, TrackedVehicle
from codriving.geometry import RoadMap
from codriving.llm import (
    Answer,
    CorrectionReply,
    MeaningView,
    Names,
    Question,
    SeenView,
    WayView,
    correction_reply,
    lane_views,
    memory_lines,
    one_line,
    seen_names,
)
from codriving.memory import is_placeholder
from codriving.methods.dilu.collision_log import Correction, Mistake
from codriving.methods.dilu.rule import correct_one
from codriving.methods.language_model.model_decider import ModelDecider
from codriving.methods.language_model.prompted_model import PromptedModel

# What stands in for an answer that is missing, as in the source: keep going, or slow down if that is not allowed.
INSTEAD = (Action.IDLE, Action.SLOWER)


class SightDecider(ModelDecider):
    """DiLu's: each CAV may choose what the road allows, by what it alone sees."""

    template = "dilu"

    def __init__(self, model: PromptedModel, road_map: RoadMap, driving: DrivingModel) -> None:
        super().__init__(model)
        self.road_map, self.driving = road_map, driving

    def variables(self, situation: Situation, nearest: int | None, with_memories: bool) -> dict[str, Any]:
        names = seen_names(situation.scene)
        return {
            **seen_view(situation, self.road_map, self.driving, nearest),
            "interval": self.driving.decision_interval,
            "memories": memory_lines(situation.memories, names) if with_memories else [],
        }

    def objection(self, situation: Situation, action: str) -> str:
        return f"{one_line(action)} is not one of: {', '.join(str(a) for a in situation.allowed)}"

    def substitute(self, situation: Situation) -> Action:
        """Return an action without the model, which is not replaced by the rule in silence."""
        return next((a for a in INSTEAD if a in situation.allowed), situation.allowed[0])


def correct_by_model(
    model: PromptedModel, road_map: RoadMap, driving: DrivingModel, mistakes: Sequence[Mistake]
) -> list[Correction]:
    """Ask about every mistake of an episode, all in one go; by rule where the model gives no usable answer."""
    answers = model.ask([_question(model, road_map, driving, mistake) for mistake in mistakes])
    return [_correction(model, mistake, answer) for mistake, answer in zip(mistakes, answers, strict=True)]


def _question(model: PromptedModel, road_map: RoadMap, driving: DrivingModel, mistake: Mistake) -> Question:
    situation, done = mistake.situation, mistake.decision.action
    names = seen_names(situation.scene)
    right = [str(action) for action in situation.allowed if action is not done]
    variables = {
        **seen_view(situation, road_map, driving),
        "action": str(done),
        "reason": names.sentence(mistake.decision.reason),
        "struck": mistake.struck,
        "other": names(mistake.other) if situation.scene.neighbour(mistake.other) else "another vehicle",
        "later": mistake.later,
    }

    def check(reply: object) -> str:
        correction = cast(CorrectionReply, reply)
        if correction.action not in right:
            return f"{one_line(correction.action)} cannot have been right; choose one of: {', '.join(right)}"
        return "" if correction.lesson else "the lesson is missing"

    messages = model.prompts.messages("dilu_reflect", variables)
    return Question("reflect", situation.scene.ego.id, messages, correction_reply(tuple(right)), check)


def _correction(model: PromptedModel, mistake: Mistake, answer: Answer) -> Correction:
    """Take what the model says; where it says nothing, or only what it was told, what the rule says."""
    by_rule, reply = correct_one(mistake), cast(CorrectionReply | None, answer.value)
    if reply is None:
        return by_rule
    empty = is_placeholder(reply.lesson, mistake.decision.reason)
    if empty:
        model.ledger.count("lessons_dropped")
    wrong = by_rule.mistake if is_placeholder(reply.mistake, mistake.decision.reason) else reply.mistake
    return Correction(Action(reply.action), wrong, by_rule.lesson if empty else reply.lesson)


MOST = 6  # Vehicles at most of which it is told where they are and which ways they may take

# Words for eighths of a turn, clockwise from straight ahead.
EIGHTHS = ("ahead", "ahead right", "to the right", "behind right", "behind", "behind left", "to the left", "ahead left")


def seen_view(
    situation: Situation, road_map: RoadMap, driving: DrivingModel, nearest: int | None = None
) -> dict[str, Any]:
    """Return the variables that all of DiLu's prompts have."""
    scene, names = situation.scene, seen_names(situation.scene)
    start, end, index = scene.ego.lane
    mentioned = scene.by_distance()[:nearest]
    lanes = lane_views(scene, mentioned, names)
    placed = {v.id for lane in lanes for v in (lane.leading, lane.rear) if v is not None}
    meets = {c.other: k for k, c in reversed(list(enumerate(situation.conflicts)))}
    # Those whose ways may meet come first, the most urgent of them before the others; the rest by distance.
    ranked = sorted(mentioned, key=lambda n: meets.get(n.id, len(meets) + len(situation.conflicts)))
    shown = [n for n in ranked if n.id in meets or names(n.id) not in placed][:MOST]
    return {
        "speed": scene.ego.speed,
        "target_speed": scene.intent.target_speed,
        "route": scene.intent.route,
        "lane_rank": index + 1,
        "lane_count": sum((a, b) == (start, end) for a, b, _ in road_map.lanes),
        "between_lanes": bool(scene.covers),
        "must_change": None if scene.must_change is None else str(scene.must_change.action),
        "room": 0.0 if scene.must_change is None else scene.must_change.room,
        "lanes": lanes,
        "vehicles": [_seen(situation, n, names) for n in shown],
        "actions": [
            MeaningView(str(a), driving.target_after(a, scene.ego.speed, scene.intent.target_speed))
            for a in situation.allowed
        ],
        "allowed": [str(a) for a in situation.allowed],
    }


def _seen(situation: Situation, n: TrackedVehicle, names: Names) -> SeenView:
    """Describe one vehicle; of each way that it may take, the most urgent place where that meets the CAV's."""
    scene = situation.scene
    ways: dict[str, Conflict] = {}
    for c in situation.conflicts:
        if c.other == n.id:
            ways.setdefault(c.routes[1], c)
    views = [WayView(str(c.relation), *c.distances, *c.ttcp, c.dttcp, str(c.severity)) for c in ways.values()]
    elsewhere, where = sum(route not in ways for route, _ in n.routes), _direction(scene, n)
    return SeenView(names(n.id), where, scene.distance(n), n.speed, n.standing, _apart(views), elsewhere)


def _apart(ways: list[WayView]) -> tuple[WayView, ...]:
    """Leave out ways that would read the same."""
    apart = {(w.relation, round(w.mine), round(w.its), round(w.dttcp, 1)): w for w in reversed(ways)}
    return tuple(w for w in ways if w in apart.values())


def _direction(scene: SceneDescription, n: TrackedVehicle) -> str:
    ahead, right = scene.offset(n)
    # The y axis points to the right of the x axis, so that angles grow clockwise.
    return EIGHTHS[round(degrees(atan2(right, ahead)) / 45) % len(EIGHTHS)]
