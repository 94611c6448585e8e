"""What a lesson is not: a word of the form, a word for nothing, or what the model was told."""

import pytest
from remembered import experience

from codriving.datatypes.experience import Verdict
from codriving.memory.effect import LESSONS
from codriving.memory.lessons import is_placeholder, reflection_view


@pytest.mark.parametrize(
    "said",
    [
        "", " ", "...", "…", "lesson", "Lesson:", "<lesson>", "one short sentence", "One or two short sentences.",
        "lesson: one short sentence", "None", "N/A", "null", "no lesson", "Your lesson here!", "string", "-",
        LESSONS[Verdict.INTENSIFIED], LESSONS[Verdict.TOO_CAUTIOUS].upper(), "the way was free",
    ],
)  # fmt: skip
def test_what_is_no_lesson(said: str) -> None:
    assert is_placeholder(said, "The way was free.")


@pytest.mark.parametrize(
    "said",
    [
        "Yield earlier.",
        "None of the gaps was long enough.",
        "Lesson: slow down before the zone.",
        "Wait.",
        "The way was",
    ],
)
def test_what_is_one(said: str) -> None:
    assert not is_placeholder(said, "The way was free.")


def test_a_mistake_is_told_in_words_that_need_no_explanation() -> None:
    view = reflection_view(experience())
    assert view["met"] == ("At 8.0 m/s, crossing with CAV, 20 m and 2.5 s before the zone, it 28 m and 3.5 s, second.")
    assert (view["action"], view["dttcp_before"], view["needless"]) == ("FASTER", 1.0, False)
