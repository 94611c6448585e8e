"""transcript.jsonl: only where a model was asked, strict, harmless to read, and free of keys like all else."""

import dataclasses
import json
from pathlib import Path

import pytest

from codriving.datatypes.record import EpisodeRecord
from codriving.errors import RunFolderError
from codriving.runs.episode_folder import TRANSCRIPT, read_transcript, timing_of, write_episode
from codriving.runs.json_files import lines_text
from codriving.runs.redaction import MASK, scrubbed, secrets_of, variables_in

CANARY = 'canary-"7\\f3a'
LINE = {"time": 0.5, "value": None, "calls": [{"text": "j'accuse \u00e9 \x1b[31m \u202e \ud800 \u2028", "cost": 1.5}]}


def test_what_is_read_is_what_was_written(tmp_path: Path) -> None:
    text = lines_text("transcript.jsonl", [LINE, {"time": 1.0}])
    (tmp_path / TRANSCRIPT).write_text(text, encoding="utf-8")
    assert read_transcript(tmp_path) == (LINE, {"time": 1.0})


def test_nothing_in_it_harms_a_terminal_or_a_reader() -> None:
    text = lines_text("transcript.jsonl", [LINE])
    assert "\u00e9" in text
    assert not {"\x1b", "\u202e", "\ud800", "\u2028"} & set(text)
    assert len(text.splitlines()) == 1


def test_what_is_not_finite_is_null_and_what_is_no_json_is_refused() -> None:
    assert json.loads(lines_text("transcript.jsonl", [{"x": float("nan")}])) == {"x": None}
    with pytest.raises(ValueError, match=r"transcript\.jsonl cannot be written"):
        lines_text("transcript.jsonl", [{"x": {1}}])


def test_a_run_of_rules_has_no_transcript(tmp_path: Path, record: EpisodeRecord) -> None:
    folder = tmp_path / "7"
    write_episode(folder, record, None, [], timing_of(1.0, []))
    assert not (folder / TRANSCRIPT).exists()
    assert read_transcript(folder) == ()
    write_episode(folder, record, None, [], timing_of(1.0, []), transcript=[LINE])
    assert read_transcript(folder) == (LINE,)


def test_a_damaged_transcript_is_named(tmp_path: Path) -> None:
    (tmp_path / TRANSCRIPT).write_text("{")
    with pytest.raises(RunFolderError, match=r"transcript\.jsonl is damaged"):
        read_transcript(tmp_path)


def test_an_error_quotes_no_secret_of_the_environment_that_no_config_names(
    tmp_path: Path, record: EpisodeRecord, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("THEIR_DATABASE_PASSWORD", CANARY)
    text = f"KeyError: tried {CANARY}"
    record = dataclasses.replace(record, outcome=dataclasses.replace(record.outcome, message=text))
    write_episode(tmp_path / "7", record, None, [], timing_of(1.0, []), text)
    assert (tmp_path / "7" / "error.txt").read_text() == f"KeyError: tried {MASK}"
    assert CANARY not in (tmp_path / "7" / "record.json").read_text()


def test_no_file_of_an_episode_holds_a_key(
    tmp_path: Path, record: EpisodeRecord, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("MY_KEY", CANARY)
    message = f"you sent Bearer {CANARY}"
    record = dataclasses.replace(record, outcome=dataclasses.replace(record.outcome, message=message))
    said = [{"calls": [{"text": message, "messages": ({"content": f"{CANARY}{CANARY}"},)}]}]
    secrets = secrets_of(variables_in({"llm": [{"api_key_env": "MY_KEY"}]}))
    write_episode(tmp_path / "7", record, None, [{"reason": message}], timing_of(1.0, []), message, said, secrets)
    files = sorted(tmp_path.glob("7/*"))
    assert len(files) == 6
    for path in files:
        text = path.read_text()
        assert "canary" not in text
        assert path.name in ("timing.json", "SHA256SUMS") or f"you sent Bearer {MASK}" in text
    assert read_transcript(tmp_path / "7")[0]["calls"][0]["messages"][0]["content"] == MASK * 2


def test_variables_are_found_by_the_keys_that_name_them(monkeypatch: pytest.MonkeyPatch) -> None:
    config = {"llm": {"api_key_env": "A_KEY", "model": "m"}, "method": {"llm": {"api_key_env": "A_KEY"}}, "x_env": None}
    assert variables_in([config, {"token_variable": "B"}]) == ("A_KEY", "B")
    monkeypatch.setenv("A_KEY", "12345678")
    monkeypatch.setenv("B", "EMPTY")
    monkeypatch.setenv("C", "123456789")
    monkeypatch.delenv("D", raising=False)
    assert secrets_of(["A_KEY", "B", "C", "D"]) == ("123456789", "12345678")


def test_only_texts_change() -> None:
    value = {"abcdefgh": ["abcdefgh", 12345678, None, True], "t": ("x",)}
    assert scrubbed(value, ["abcdefgh", "12345678"]) == {"abcdefgh": [MASK, 12345678, None, True], "t": ["x"]}
