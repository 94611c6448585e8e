"""Whole or not at all."""

from pathlib import Path

import pytest

from codriving.runs.atomic import PARTIAL, sweep, whole_file, whole_folder, write_text


def leftovers(folder: Path) -> list[str]:
    return [item.name for item in folder.rglob(f"{PARTIAL}*")]


def test_a_folder_appears_only_when_it_is_complete(tmp_path: Path) -> None:
    target = tmp_path / "cell" / "7"
    with whole_folder(target) as partial:
        (partial / "a.txt").write_text("a")
        assert not target.exists()
    assert (target / "a.txt").read_text() == "a"
    assert leftovers(tmp_path) == []


@pytest.mark.parametrize("error", [RuntimeError, KeyboardInterrupt])
def test_a_folder_that_fails_leaves_nothing_and_keeps_the_former(tmp_path: Path, error: type[BaseException]) -> None:
    target = tmp_path / "7"
    with whole_folder(target) as partial:
        (partial / "a.txt").write_text("former")

    def fail() -> None:
        with whole_folder(target) as partial:
            (partial / "a.txt").write_text("new")
            raise error

    with pytest.raises(error):
        fail()
    assert (target / "a.txt").read_text() == "former"
    assert leftovers(tmp_path) == []


def test_a_folder_is_replaced_as_a_whole(tmp_path: Path) -> None:
    target = tmp_path / "7"
    for name in ("old.txt", "new.txt"):
        with whole_folder(target) as partial:
            (partial / name).touch()
    assert [item.name for item in target.iterdir()] == ["new.txt"]
    assert leftovers(tmp_path) == []


def test_a_file_is_replaced_and_keeps_its_line_ends(tmp_path: Path) -> None:
    path = tmp_path / "summary.csv"
    write_text(path, "old\n")
    write_text(path, "é\r\nb\n")
    assert path.read_bytes() == "é\r\nb\n".encode()
    assert leftovers(tmp_path) == []


def test_a_file_that_fails_leaves_the_former(tmp_path: Path) -> None:
    path = tmp_path / "summary.csv"
    write_text(path, "old\n")
    with pytest.raises(UnicodeEncodeError):
        write_text(path, "\ud800")
    assert path.read_text() == "old\n"
    assert leftovers(tmp_path) == []


def test_sweeping_removes_what_a_killed_run_left_and_nothing_else(tmp_path: Path) -> None:
    (tmp_path / f"{PARTIAL}7-abc").mkdir()
    (tmp_path / f"{PARTIAL}7-abc" / "record.json").touch()
    (tmp_path / f"{PARTIAL}summary.csv-abc").touch()
    (tmp_path / "7").mkdir()
    sweep(tmp_path)
    assert [item.name for item in tmp_path.iterdir()] == ["7"]
    sweep(tmp_path / "not there")


def test_a_file_made_by_others_appears_only_when_it_is_complete(tmp_path: Path) -> None:
    (tmp_path / "7").mkdir()
    target = tmp_path / "7" / "replay.mp4"
    with whole_file(target, beside=tmp_path) as partial:
        partial.write_bytes(b"film")
        assert partial.parent == tmp_path
        assert not target.exists()
    assert target.read_bytes() == b"film"
    assert leftovers(tmp_path) == []


def test_a_file_that_others_fail_to_make_leaves_the_former(tmp_path: Path) -> None:
    target = tmp_path / "replay.mp4"
    target.write_bytes(b"former")

    def fail() -> None:
        with whole_file(target) as partial:
            partial.write_bytes(b"half")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        fail()
    assert target.read_bytes() == b"former"
    assert leftovers(tmp_path) == []
