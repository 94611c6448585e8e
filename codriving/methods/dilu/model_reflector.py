"""Reflection by a language model: what the mistake was, what it teaches, and what would have been right."""

from collections.abc import Sequence
from typing import cast

from codriving.datatypes.action import Action
from codriving.llm.ledger import Ledger
from codriving.llm.prompts.free_text import one_line, seen_names
from codriving.llm.prompts.render import Prompts
from codriving.llm.prompts.replies import CorrectionReply, correction_reply
from codriving.llm.question import Answer, Chat, Question
from codriving.methods.dilu.prompt_view import seen_view
from codriving.methods.dilu.reflection import Correction, Mistake, correct_one


class ModelReflector:
    """Asks a model about every mistake of an episode, all in one go."""

    def __init__(self, chat: Chat, prompts: Prompts, ledger: Ledger) -> None:
        self.chat, self.prompts, self.ledger = chat, prompts, ledger

    def correct(self, mistakes: Sequence[Mistake]) -> list[Correction]:
        """Return one correction a mistake, in the same order; by rule where the model has no usable answer.

        Raises:
            ModelUnavailableError: If the model does not answer.
            SpendingLimitError: If the tokens or the money that may be spent are used up.
        """
        questions = [self.question(mistake) for mistake in mistakes]
        answers = self.chat.ask(questions) if questions else []
        for question, answer in zip(questions, answers, strict=True):
            self.ledger.note(question, answer)
        return [_correction(mistake, answer) for mistake, answer in zip(mistakes, answers, strict=True)]

    def question(self, mistake: Mistake) -> Question:
        """Return what the model is asked about one mistake."""
        situation, done = mistake.told.situation, mistake.decision.action
        names = seen_names(situation.scene)
        right = [str(action) for action in situation.allowed if action is not done]
        values = {
            **seen_view(mistake.told),
            "action": str(done),
            "reason": names.sentence(mistake.decision.reason),
            "struck": mistake.struck,
            "other": names(mistake.other) if situation.scene.neighbour(mistake.other) else "another vehicle",
            "later": mistake.later,
        }

        def check(reply: object) -> str:
            said = cast(CorrectionReply, reply)
            if said.action not in right:
                return f"{one_line(said.action)} cannot have been right; choose one of: {', '.join(right)}"
            return "" if said.lesson else "the lesson is missing"

        return Question(
            purpose="reflect",
            subject=situation.scene.ego.id,
            messages=self.prompts.messages("dilu_reflect", values),
            schema=correction_reply(tuple(right)),
            check=check,
        )


def _correction(mistake: Mistake, answer: Answer) -> Correction:
    if answer.value is None:
        return correct_one(mistake)
    said = cast(CorrectionReply, answer.value)
    return Correction(Action(said.action), said.mistake or correct_one(mistake).mistake, said.lesson)
