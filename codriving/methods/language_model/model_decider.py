"""Decisions by a language model: all CAVs are asked at once, and each may choose what the safety check has left."""

from collections.abc import Sequence
from typing import cast

from codriving.datatypes.action import Action
from codriving.datatypes.situation import Decision, Situation
from codriving.llm.ledger import Ledger
from codriving.llm.prompts.free_text import names_for
from codriving.llm.prompts.render import Prompts
from codriving.llm.prompts.replies import DecisionReply, decision_reply
from codriving.llm.prompts.variables import decision_view, vehicles_by_distance
from codriving.llm.question import Answer, Chat, Question
from codriving.reasoning.decision.rules import Decider, decide_one, is_plain

SAFEST = (Action.SLOWER, Action.IDLE, Action.FASTER, Action.LANE_RIGHT, Action.LANE_LEFT)
"""Actions in the order in which they stand in for an answer that is missing."""


class ModelDecider(Decider):
    """Asks a model for every CAV, all in one go.

    Nobody asks for a CAV whose decision is plain, see ``is_plain``; the rules decide, and the ledger counts it.
    """

    def __init__(self, chat: Chat, prompts: Prompts, ledger: Ledger, ask_plain: bool, sees_conflicts: bool) -> None:
        self.chat, self.prompts, self.ledger = chat, prompts, ledger
        self.ask_plain, self.sees_conflicts = ask_plain, sees_conflicts

    def decide(self, situations: Sequence[Situation]) -> list[Decision]:
        """Return one decision a situation, in the same order.

        Raises:
            ModelUnavailableError: If the model does not answer.
            SpendingLimitError: If the tokens or the money that may be spent are used up.
        """
        open_ones = [s for s in situations if self.ask_plain or not is_plain(s, self.sees_conflicts)]
        questions = [self.question(s) for s in open_ones]
        answers = self.chat.ask(questions) if questions else []
        for question, answer in zip(questions, answers, strict=True):
            self.ledger.note(question, answer)
        found = {s.scene.ego.id: self._decision(s, answer) for s, answer in zip(open_ones, answers, strict=True)}
        if len(open_ones) < len(situations):
            self.ledger.count("plain_decisions", len(situations) - len(open_ones))
        return [found.get(s.scene.ego.id) or decide_one(s) for s in situations]

    def _decision(self, situation: Situation, answer: Answer) -> Decision:
        if answer.value is None:
            return fallback(situation, answer.problem)
        reply = cast(DecisionReply, answer.value)
        if reply.action not in situation.allowed:
            # No chat should let this pass; whatever it says, only what is allowed is done.
            self.ledger.count("fallbacks")
            return fallback(situation, "the action is not allowed")
        return Decision(situation.scene.ego.id, Action(reply.action), reply.reason or "no reason was given")

    def question(self, situation: Situation) -> Question:
        """Return what the model is asked for one CAV."""
        return self._question(situation, None, True)

    def _question(self, situation: Situation, nearest: int | None, with_memories: bool) -> Question:
        allowed = [str(action) for action in situation.allowed]
        names = names_for(situation)
        removed = {str(a.action): a.reasons for a in situation.assessments if not a.safe}

        def check(reply: object) -> str:
            action = cast(DecisionReply, reply).action
            if action in allowed:
                return ""
            why = names.sentence("; ".join(removed[action])) if action in removed else "it is no action"
            return f"{names.sentence(action)} cannot be chosen: {why}; choose one of: {', '.join(allowed)}"

        def shorter() -> Question | None:
            """Leave out the memories, then again and again the farther half of the vehicles."""
            if situation.memories and with_memories:
                return self._question(situation, nearest, False)
            left = (len(vehicles_by_distance(situation)) if nearest is None else nearest) // 2
            return self._question(situation, left, False) if left else None

        return Question(
            purpose="decide",
            subject=situation.scene.ego.id,
            messages=self.prompts.messages("decide", decision_view(situation, nearest, with_memories)),
            schema=decision_reply(tuple(allowed)),
            check=check,
            shorter=shorter,
        )


def fallback(situation: Situation, problem: str) -> Decision:
    """Decide without the model: the slowest action that keeps the order, or else the slowest that is allowed.

    The rules would often drive on here. A model that does not answer is not to be driven by them in silence.
    """
    keeps = {a.action for a in situation.assessments if a.safe and a.progress is not None}
    choices = [a for a in SAFEST if a in keeps] or [a for a in SAFEST if a in situation.allowed]
    return Decision(situation.scene.ego.id, choices[0], f"fallback, no usable answer: {problem}")
