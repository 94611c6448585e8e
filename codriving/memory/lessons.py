"""Lessons that a language model writes: what it is told of a mistake, and what is none."""

import re
from dataclasses import asdict
from typing import Any

from codriving.datatypes import Experience
from codriving.memory.describe import met
from codriving.memory.effect import LESSONS

# Words in the place of a lesson: those of the forms, and what stands for nothing.
_PLACES = frozenset(
    {
        *("", "lesson", "the lesson", "a lesson", "your lesson", "lesson here", "your lesson here", "lesson text"),
        *("one or two short sentences", "one short sentence", "short sentence", "two short sentences", "sentence"),
        *("the action that would have been right", "mistake", "reason", "action", "text", "string", "example"),
        *("none", "no", "no lesson", "no lesson learned", "nothing", "null", "nil", "n a", "na", "not applicable"),
        *("unknown", "todo", "tbd", "placeholder", "ok", "yes", "lesson learned", "lesson learnt"),
    }
)


def is_placeholder(lesson: str, *told: str) -> bool:
    """Whether a lesson says nothing: it is a word of the form, stands for nothing, or repeats what the model was told.

    Args:
        told: Texts of the prompt that are no lesson of the model's own.
    """
    plain = _plain(lesson)
    return plain in _PLACES or plain in {_plain(text) for text in (*LESSONS.values(), *told)}


def _plain(text: str) -> str:
    """Letters and digits alone, in single blanks; without the name of the field before them."""
    words = " ".join(re.findall(r"[^\W_]+", text.casefold()))
    return words.removeprefix("lesson ") if words.removeprefix("lesson ") in _PLACES else words


def reflection_view(experience: Experience) -> dict[str, Any]:
    """Return the variables of the reflection prompt."""
    return {
        "scene": experience.description.scene,
        "conflict": experience.description.conflict,
        "order": experience.description.order,
        "met": f"{met(experience.description)}.",
        "action": str(experience.action),
        "verdict": str(experience.verdict),
        "comment": experience.lesson,
        **asdict(experience.effect),
    }
