"""Nothing harmful comes with a text."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from codriving.llm.parsing import LONGEST, clean, is_page, one_line

TEXT = '{"action": "IDLE"}'


@given(st.text(alphabet=st.characters(), max_size=200))
def test_cleaned_text_can_be_written_and_is_short(text: str) -> None:
    made = clean(text, 100)
    made.encode("utf-8")
    assert len(made) <= 105
    assert "\x1b" not in made


def test_what_is_longer_is_cut() -> None:
    assert len(clean("x" * 10 * LONGEST)) < LONGEST + 10
    assert one_line("a\n\n b\t c" + "d" * 100, 10) == "a b cdd..."


@pytest.mark.parametrize(("said", "page"), [("<!DOCTYPE html><p>", True), (" <html lang=en>", True), (TEXT, False)])
def test_pages_are_told(said: str, page: bool) -> None:
    assert is_page(said) is page
