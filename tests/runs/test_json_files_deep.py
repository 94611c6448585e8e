"""JSON that nests too deep is damaged like any other, wherever it is read."""

from pathlib import Path

import pytest

from codriving.errors import RunFolderError
from codriving.runs.episode_folder import read_decisions, read_record
from codriving.runs.manifest import read_manifest
from codriving.runs.redaction import nested

DEEP = "[" * 100_000 + "]" * 100_000


def test_files_of_a_run_folder(tmp_path: Path) -> None:
    (tmp_path / "manifest.json").write_text(DEEP)
    with pytest.raises(RunFolderError, match=r"is damaged \(it nests too deep"):
        read_manifest(tmp_path)
    (tmp_path / "decisions.jsonl").write_text(f"{DEEP}\n")
    with pytest.raises(RunFolderError, match=r"is damaged \(it nests too deep"):
        read_decisions(tmp_path)
    (tmp_path / "record.json").write_text(f'{{\n  "score": {DEEP}}}')
    with pytest.raises(RunFolderError, match=r"is damaged \(it nests too deep"):
        read_record(tmp_path)
    (tmp_path / "record.json").write_text(DEEP)
    with pytest.raises(RunFolderError, match="is damaged"):
        read_record(tmp_path)


def test_a_setting() -> None:
    with pytest.raises(ValueError, match="it nests too deep"):
        nested({"a": DEEP})
