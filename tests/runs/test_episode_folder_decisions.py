"""decisions.jsonl: one line a step, plain JSON."""

import json
from pathlib import Path

import pytest

from codriving.datatypes.world import Action
from codriving.errors import RunFolderError
from codriving.runs.episode_folder import DECISIONS, read_decisions
from codriving.runs.json_files import lines_text


def test_one_line_a_step() -> None:
    text = lines_text("decisions.jsonl", [{"step": 0, "action": Action.IDLE, "why": "先行\nline"}, {"step": 1}])
    assert text.count("\n") == 2
    assert [json.loads(line) for line in text.splitlines()] == [
        {"step": 0, "action": "IDLE", "why": "先行\nline"},
        {"step": 1},
    ]


def test_what_is_not_finite_becomes_null() -> None:
    (line,) = lines_text(
        "decisions.jsonl", [{"ttcp": float("inf"), "list": [1.0, float("nan")], "deep": {"x": (2.0,)}}]
    ).splitlines()
    assert json.loads(line) == {"ttcp": None, "list": [1.0, None], "deep": {"x": [2.0]}}


def test_what_has_no_place_in_json_is_refused() -> None:
    with pytest.raises(ValueError, match=r"decisions\.jsonl cannot be written"):
        lines_text("decisions.jsonl", [{"set": {1}}])


def test_what_was_written_is_read_back(tmp_path: Path) -> None:
    lines = [{"step": 0, "why": "先行\u2028\nline"}, {"step": 1}]
    (tmp_path / DECISIONS).write_text(lines_text("decisions.jsonl", lines), encoding="utf-8", newline="")
    assert list(read_decisions(tmp_path)) == lines


@pytest.mark.parametrize("text", ['{"step": 0', "[1]\n", "\x00"])
def test_a_damaged_file_is_named(tmp_path: Path, text: str) -> None:
    (tmp_path / DECISIONS).write_text(text, encoding="utf-8")
    with pytest.raises(RunFolderError, match=r"decisions\.jsonl is damaged .*run again"):
        read_decisions(tmp_path)


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(RunFolderError, match=r"decisions\.jsonl is damaged \(it is missing\)"):
        read_decisions(tmp_path)
