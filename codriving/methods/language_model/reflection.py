"""``memory.reflection=llm``: a language model writes the lessons of the mistakes of an episode."""

from collections.abc import Sequence
from dataclasses import replace
from typing import cast

from codriving.datatypes.experience import Experience, Verdict
from codriving.llm.ledger import Ledger
from codriving.llm.prompts.render import Prompts
from codriving.llm.prompts.replies import LessonReply
from codriving.llm.prompts.variables import reflection_view
from codriving.llm.question import Chat, Question

MISTAKES = (Verdict.INTENSIFIED, Verdict.TOO_CAUTIOUS)
"""What is reflected on; what went well speaks for itself."""


class Reflection:
    """Asks a model about the worst mistakes of an episode at once; the comment of the rules stays before its words."""

    def __init__(self, chat: Chat, prompts: Prompts, ledger: Ledger, most: int) -> None:
        self.chat, self.prompts, self.ledger, self.most = chat, prompts, ledger, most

    def reflect(self, experiences: Sequence[Experience]) -> list[Experience]:
        """Return the experiences with lessons of the model's where it gave one that can be used.

        Raises:
            ModelUnavailableError: If the model does not answer.
            SpendingLimitError: If the tokens or the money that may be spent are used up.
        """
        mistakes = [k for k, e in enumerate(experiences) if e.verdict in MISTAKES]
        chosen = sorted(sorted(mistakes, key=lambda k: _gravity(experiences[k]))[: self.most])
        questions = [self.question(experiences[k]) for k in chosen]
        answers = self.chat.ask(questions) if questions else []
        found = list(experiences)
        for k, question, answer in zip(chosen, questions, answers, strict=True):
            self.ledger.note(question, answer)
            if answer.value is not None:
                lesson = cast(LessonReply, answer.value).lesson
                found[k] = replace(experiences[k], lesson=f"{experiences[k].lesson} {lesson}".strip())
        return found

    def question(self, experience: Experience) -> Question:
        """Return what the model is asked about one experience."""
        return Question(
            purpose="reflect",
            subject=experience.ego,
            messages=self.prompts.messages("reflect", reflection_view(experience)),
            schema=LessonReply,
            check=lambda reply: "" if cast(LessonReply, reply).lesson else "the lesson is empty",
        )


def _gravity(e: Experience) -> tuple[bool, bool, float, int, str]:
    """Collisions first, then what intensified the conflict most, then needless waiting."""
    return e.effect.collision is None, e.verdict is not Verdict.INTENSIFIED, e.effect.own_change, e.step, e.ego
