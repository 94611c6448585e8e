"""decisions.jsonl: one line a step, plain JSON."""

import json

import pytest

from codriving.datatypes.action import Action
from codriving.storage.decisions_file import decisions_text


def test_one_line_a_step() -> None:
    text = decisions_text([{"step": 0, "action": Action.IDLE, "why": "先行\nline"}, {"step": 1}])
    assert text.count("\n") == 2
    assert [json.loads(line) for line in text.splitlines()] == [
        {"step": 0, "action": "IDLE", "why": "先行\nline"},
        {"step": 1},
    ]


def test_what_is_not_finite_becomes_null() -> None:
    (line,) = decisions_text([{"ttcp": float("inf"), "list": [1.0, float("nan")], "deep": {"x": (2.0,)}}]).splitlines()
    assert json.loads(line) == {"ttcp": None, "list": [1.0, None], "deep": {"x": [2.0]}}


def test_what_has_no_place_in_json_is_refused() -> None:
    with pytest.raises(ValueError, match=r"decisions\.jsonl cannot be written"):
        decisions_text([{"set": {1}}])
