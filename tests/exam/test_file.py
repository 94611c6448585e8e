"""The file of an exam: the same bytes each time, and refused where it is not as it was written."""

import json
import lzma
from pathlib import Path

import pytest
from small_exam import small_exam

from codriving.errors import ConfigError
from codriving.exam.file import OURS, read_exam, written_exam
from codriving.exam.plain import plain


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "exam.jsonl.xz"
    path.write_bytes(written_exam(small_exam()))
    return path


def test_an_exam_comes_back_with_its_hash(file: Path) -> None:
    exam, written = read_exam(file), small_exam()
    assert plain(exam.situations) == plain(written.situations)
    assert plain(exam.negotiations) == plain(written.negotiations)
    assert exam.about == written.about
    assert len(exam.sha256) == 64
    assert written_exam(exam) == file.read_bytes()


def changed(file: Path, old: str, new: str) -> None:
    text = lzma.decompress(file.read_bytes()).decode()
    assert old in text
    file.write_bytes(lzma.compress(text.replace(old, new, 1).encode()))


def test_a_changed_question_is_noticed(file: Path) -> None:
    changed(file, '"collisions":2', '"collisions":0')
    with pytest.raises(ConfigError, match="is not as it was built: its SHA-256 is "):
        read_exam(file)


def test_another_format_is_refused(file: Path) -> None:
    changed(file, '"exam":1', '"exam":2')
    with pytest.raises(ConfigError, match="holds no exam of format 1; build it again"):
        read_exam(file)


@pytest.mark.parametrize("content", [b"", b"no xz", lzma.compress(b"[1]\n"), lzma.compress(b"\xff\n")])
def test_what_is_no_exam_is_refused(content: bytes, tmp_path: Path) -> None:
    (path := tmp_path / "strange").write_bytes(content)
    with pytest.raises(ConfigError, match=r"strange (cannot be read|holds no exam of format 1)"):
        read_exam(path)


def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"none.xz cannot be read .*No such file"):
        read_exam(tmp_path / "none.xz")


def test_ours_can_be_read_and_each_question_tells_answers_apart() -> None:
    exam = read_exam(OURS)
    head = json.loads(lzma.decompress(OURS.read_bytes()).decode().partition("\n")[0])
    assert head["sha256"] == exam.sha256
    assert OURS.stat().st_size < 1_500_000
    names = [one.name for one in (*exam.situations, *exam.negotiations)]
    assert len(set(names)) == len(names)
    for one in exam.situations:
        assert set(one.actions) == set(one.situation.allowed)
        assert {c.acceptable for c in one.actions.values()} == {True, False}
        assert one.actions[one.best].acceptable
        assert 28_000 <= one.origin.seed <= 28_999
    for negotiation in exam.negotiations:
        assert all(pair.if_one.acceptable is not pair.if_other.acceptable for pair in negotiation.pairs)
