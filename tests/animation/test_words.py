"""Words that fit."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from codriving.animation.canvas import Canvas
from codriving.animation.words import shortened, wrapped

CANVAS = Canvas(10, 10)
texts = st.text(st.characters(codec="utf-8", categories=("L", "N", "P", "Zs")), max_size=120)


@given(texts, st.floats(30, 400), st.booleans())
def test_a_shortened_text_fits(words: str, room: float, bold: bool) -> None:
    cut = shortened(CANVAS, words, 12, room, bold)
    assert CANVAS.width_of(cut, 12, bold) <= room
    assert cut == " ".join(words.split()) or cut.endswith("…")


@given(texts, st.integers(0, 4))
def test_wrapped_lines_fit_and_are_not_too_many(words: str, lines: int) -> None:
    broken = wrapped(CANVAS, words, 12, 200, lines)
    assert len(broken) <= lines
    assert all(CANVAS.width_of(line, 12) <= 200 for line in broken)


def test_nothing_is_lost_where_there_is_room() -> None:
    words = "FASTER still lets CAV1, CAV4, HDV1, HDV2 and HDV4 pass first, which all have been there before"
    assert " ".join(wrapped(CANVAS, words, 12, 200, 9)) == words
    assert wrapped(CANVAS, words, 12, 200, 2)[-1].endswith("…")


@pytest.mark.parametrize("words", ["", " ", "\n"])
def test_no_words_no_lines(words: str) -> None:
    assert wrapped(CANVAS, words, 12, 200, 3) == []
    CANVAS.text(5, 5, words, 12, "#000000")
