"""DiLu by a language model: one question a CAV about what it alone sees, and one about each mistake."""

from collections.abc import Sequence
from typing import Any, cast

from codriving.datatypes.situation import Situation
from codriving.datatypes.world import Action, DrivingModel
from codriving.geometry.road_map import RoadMap
from codriving.llm.prompts.free_text import LONGEST_MEMORY, one_line, seen_names
from codriving.llm.prompts.replies import CorrectionReply, correction_reply
from codriving.llm.question import Answer, Question
from codriving.methods.dilu.collision_log import Correction, Mistake
from codriving.methods.dilu.prompt_view import seen_view
from codriving.methods.dilu.rule import correct_one
from codriving.methods.language_model.model_decider import ModelDecider
from codriving.methods.language_model.prompted_model import PromptedModel

INSTEAD = (Action.IDLE, Action.SLOWER)
"""What stands in for an answer that is missing, as in the source: keep going, or slow down if that is not allowed."""


class SightDecider(ModelDecider):
    """DiLu's: each CAV may choose what the road allows, by what it alone sees.

    Args:
        driving: How a CAV answers to actions; its decision interval is the time for which a decision holds.
    """

    template = "dilu"

    def __init__(self, model: PromptedModel, road_map: RoadMap, driving: DrivingModel) -> None:
        super().__init__(model)
        self.road_map, self.driving = road_map, driving

    def variables(self, situation: Situation, nearest: int | None, with_memories: bool) -> dict[str, Any]:
        memories = situation.memories if with_memories else ()
        return {
            **seen_view(situation, self.road_map, self.driving, nearest),
            "interval": self.driving.decision_interval,
            "memories": [one_line(memory.text, LONGEST_MEMORY) for memory in memories],
        }

    def objection(self, situation: Situation, action: str) -> str:
        return f"{one_line(action)} is not one of: {', '.join(str(a) for a in situation.allowed)}"

    def substitute(self, situation: Situation) -> Action:
        """Return an action without the model, which is not replaced by the rule in silence."""
        return next((a for a in INSTEAD if a in situation.allowed), situation.allowed[0])


def correct_by_model(
    model: PromptedModel, road_map: RoadMap, driving: DrivingModel, mistakes: Sequence[Mistake]
) -> list[Correction]:
    """Ask about every mistake of an episode, all in one go; by rule where the model gives no usable answer.

    Returns:
        One correction a mistake, in the same order.

    Raises:
        ModelUnavailableError: If the model does not answer.
        SpendingLimitError: If the tokens or the money that may be spent are used up.
    """
    answers = model.ask([_question(model, road_map, driving, mistake) for mistake in mistakes])
    return [_correction(mistake, answer) for mistake, answer in zip(mistakes, answers, strict=True)]


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

    return Question(
        purpose="reflect",
        subject=situation.scene.ego.id,
        messages=model.prompts.messages("dilu_reflect", variables),
        schema=correction_reply(tuple(right)),
        check=check,
    )


def _correction(mistake: Mistake, answer: Answer) -> Correction:
    by_rule, reply = correct_one(mistake), cast(CorrectionReply | None, answer.value)
    return (
        by_rule if reply is None else Correction(Action(reply.action), reply.mistake or by_rule.mistake, reply.lesson)
    )
