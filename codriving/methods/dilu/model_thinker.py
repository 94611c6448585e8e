"""Reasoning by a language model: all CAVs are asked at once, each in a question of its own about what it alone sees."""

from collections.abc import Sequence
from typing import cast

from codriving.datatypes.action import Action
from codriving.datatypes.situation import Decision
from codriving.llm.ledger import Ledger
from codriving.llm.prompts.free_text import LONGEST_MEMORY, one_line
from codriving.llm.prompts.render import Prompts
from codriving.llm.prompts.replies import DecisionReply, decision_reply
from codriving.llm.question import Answer, Chat, Question
from codriving.methods.dilu.prompt_view import seen_view
from codriving.methods.dilu.thinker import Thought
from codriving.methods.dilu.told import Told

INSTEAD = (Action.IDLE, Action.SLOWER)
"""What stands in for an answer that is missing, as in the source: keep going, or slow down if that is not allowed."""


class ModelThinker:
    """Asks a model for every CAV, all in one go.

    Args:
        interval: Time for which a decision holds [s].
    """

    def __init__(self, chat: Chat, prompts: Prompts, ledger: Ledger, interval: float) -> None:
        self.chat, self.prompts, self.ledger, self.interval = chat, prompts, ledger, interval

    def decide(self, told: Sequence[Told]) -> list[Thought]:
        """Return one thought a CAV, in the same order.

        Raises:
            ModelUnavailableError: If the model does not answer.
            SpendingLimitError: If the tokens or the money that may be spent are used up.
        """
        questions = [self.question(one) for one in told]
        answers = self.chat.ask(questions) if questions else []
        for question, answer in zip(questions, answers, strict=True):
            self.ledger.note(question, answer)
        return [Thought(self._decision(o, a), o.situation) for o, a in zip(told, answers, strict=True)]

    def question(self, told: Told, nearest: int | None = None, with_memories: bool = True) -> Question:
        """Return what the model is asked for one CAV.

        Args:
            nearest: Number of vehicles, nearest first, that are mentioned; None for all.
        """
        allowed = [str(action) for action in told.situation.allowed]
        memories = told.situation.memories if with_memories else ()
        values = {
            **seen_view(told, nearest),
            "interval": self.interval,
            "memories": [one_line(memory.text, LONGEST_MEMORY) for memory in memories],
        }

        def check(reply: object) -> str:
            action = cast(DecisionReply, reply).action
            return "" if action in allowed else f"{one_line(action)} is not one of: {', '.join(allowed)}"

        def shorter() -> Question | None:
            """Leave out the experiences, then again and again the farther half of the vehicles."""
            if memories:
                return self.question(told, nearest, False)
            left = (len(told.situation.scene.neighbours) if nearest is None else nearest) // 2
            return self.question(told, left, False) if left else None

        return Question(
            purpose="decide",
            subject=told.situation.scene.ego.id,
            messages=self.prompts.messages("dilu", values),
            schema=decision_reply(tuple(allowed)),
            check=check,
            shorter=shorter,
        )

    def _decision(self, told: Told, answer: Answer) -> Decision:
        if answer.value is None:
            return instead(told, answer.problem)
        reply = cast(DecisionReply, answer.value)
        if reply.action not in told.situation.allowed:
            # No chat should let this pass; whatever it says, only what the road allows is done.
            self.ledger.count("fallbacks")
            return instead(told, "the action is not allowed")
        return Decision(told.situation.scene.ego.id, Action(reply.action), reply.reason or "no reason was given")


def instead(told: Told, problem: str) -> Decision:
    """Decide without the model; a model that does not answer is not driven by the rule in silence."""
    allowed = told.situation.allowed
    action = next((a for a in INSTEAD if a in allowed), allowed[0])
    return Decision(told.situation.scene.ego.id, action, f"fallback, no usable answer: {problem}")
