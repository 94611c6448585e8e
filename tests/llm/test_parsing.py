"""An answer is found wherever it stands, and nothing harmful comes with it."""

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from codriving.llm.parsing import LONGEST, clean, is_page, last_object, one_line

ANSWER = {"action": "IDLE"}
TEXT = '{"action": "IDLE"}'


@pytest.mark.parametrize(
    "said",
    [
        TEXT,
        f"```json\n{TEXT}\n```",
        f"Here is what {{you}} asked for: {TEXT} I hope that helps :}}",
        f'<think>{{"action": "FASTER"}} or </think>{TEXT}',
        f'{{"action": "FASTER"}}</think>{TEXT}',
        f'{TEXT}<think>but then {{"action": "FASTER"}}',
        f'<THINKING>\n{{"action": "SLOWER"}}\n</THINKING>\n{TEXT}',
        f'First I thought {{"action": "SLOWER"}}, in the end {TEXT}',
        f'{{"broken": {TEXT}',
        "so " * 350_000 + TEXT,
        TEXT + " so" * 350_000,
    ],
)
def test_last_balanced_object_is_read(said: str) -> None:
    assert last_object(clean(said)) == ANSWER


@pytest.mark.parametrize("said", ["", "no", '["IDLE"]', '{"action": "IDLE"', "<think>" + TEXT, "{" * 20_000, "null"])
def test_nothing_is_made_up(said: str) -> None:
    assert last_object(said) is None


def test_deep_nesting_ends_nothing() -> None:
    assert last_object('{"a":' * 4000) is None


def test_long_text_inside_an_answer_is_capped() -> None:
    found = last_object(clean(json.dumps({"reason": "so " * 350_000, "action": "IDLE"})))
    assert found is not None
    assert found["action"] == "IDLE"
    assert len(found["reason"]) < 2100


def test_control_characters_go_even_if_they_were_escaped() -> None:
    found = last_object('{"reason": "\\u001b[31mred\\u0000 \\ud800\\u202eend\nline"}')
    assert found == {"reason": "[31mred end\nline"}


@given(st.text(alphabet=st.characters(), max_size=200))
def test_cleaned_text_can_be_written_and_is_short(text: str) -> None:
    made = clean(text, 100)
    made.encode("utf-8")
    assert len(made) <= 105
    assert "\x1b" not in made


@given(st.dictionaries(st.sampled_from("abc"), st.integers() | st.booleans() | st.none()), st.text('{}[]" ,:ab\\'))
def test_object_after_anything_balanced_is_found(value: dict[str, object], before: str) -> None:
    assert last_object(f"{before.replace('{', '')}\n{json.dumps(value)}") == value


def test_what_is_longer_is_cut() -> None:
    assert len(clean("x" * 10 * LONGEST)) < LONGEST + 10
    assert one_line("a\n\n b\t c" + "d" * 100, 10) == "a b cdd..."


@pytest.mark.parametrize(("said", "page"), [("<!DOCTYPE html><p>", True), (" <html lang=en>", True), (TEXT, False)])
def test_pages_are_told(said: str, page: bool) -> None:
    assert is_page(said) is page
