"""``memory.reflection=llm``: a language model writes the lessons of the mistakes of an episode."""

from collections.abc import Sequence
from dataclasses import replace
from typing import cast

from codriving.datatypes import Experience, Verdict
from codriving.llm import LessonReply, Question
from codriving.memory import is_placeholder, reflection_view
from codriving.methods.language_model.prompted_model import PromptedModel

MISTAKES = (Verdict.INTENSIFIED, Verdict.TOO_CAUTIOUS)  # What is reflected on; what went well speaks for itself


def reflect(model: PromptedModel, experiences: Sequence[Experience], most: int) -> list[Experience]:
    """Ask about the worst mistakes of an episode at once; the comment of the rules stays before the model's words."""
    mistakes = [k for k, e in enumerate(experiences) if e.verdict in MISTAKES]
    chosen = sorted(sorted(mistakes, key=lambda k: _gravity(experiences[k]))[:most])
    answers = model.ask([_question(model, experiences[k]) for k in chosen])
    found = list(experiences)
    for k, answer in zip(chosen, answers, strict=True):
        if answer.value is not None:
            lesson = cast(LessonReply, answer.value).lesson
            if is_placeholder(lesson, experiences[k].lesson):
                model.ledger.count("lessons_dropped")
                continue
            found[k] = replace(experiences[k], lesson=f"{experiences[k].lesson} {lesson}".strip())
    return found


def _question(model: PromptedModel, experience: Experience) -> Question:
    def check(reply: object) -> str:
        return "" if cast(LessonReply, reply).lesson else "the lesson is empty"

    messages = model.prompts.messages("reflect", reflection_view(experience))
    return Question("reflect", experience.ego, messages, LessonReply, check)


def _gravity(e: Experience) -> tuple[bool, bool, float, int, str]:
    """Collisions first, then what intensified the conflict most, then needless waiting."""
    return e.effect.collision is None, e.verdict is not Verdict.INTENSIFIED, e.effect.own_change, e.step, e.ego
