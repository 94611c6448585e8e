"""A run: the same bytes however it comes about, resumed where it was left, refused where it must be."""

import dataclasses
import hashlib
import json
import os
import re
import shutil
from collections.abc import Generator
from pathlib import Path
from typing import Any

import pytest
from toy_plan import EPISODES, toy, toy_cell, toy_plan

from codriving.errors import RunFolderError
from codriving.experiment.batch import drive
from codriving.experiment.launchers import Serial
from codriving.experiment.worker import Report

TABLES = ["episodes.csv", "summary.csv", "summary.md"]


def deterministic(folder: Path) -> dict[str, bytes]:
    """Every file that must not depend on the clock, the machine or the number of workers."""
    kept = [folder / name for name in TABLES] + [
        path for path in folder.glob("episodes/*/*/*") if path.name not in {"timing.json", "error.txt"}
    ]
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in kept}


def all_files(folder: Path) -> dict[str, bytes]:
    return {p.relative_to(folder).as_posix(): p.read_bytes() for p in folder.rglob("*") if p.is_file()}


def rewrite(path: Path, old: str, new: str) -> None:
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))


@pytest.fixture(scope="module")
def reference(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """The bytes of an undisturbed run in one process."""
    folder = drive(toy_plan(tmp_path_factory.mktemp("reference")), build=toy()).folder
    return deterministic(folder)


def test_a_run_folder_holds_everything(tmp_path: Path) -> None:
    finished = drive(toy_plan(tmp_path), build=toy())
    assert finished.folder == tmp_path / "run" / "mine"
    assert (finished.driven, finished.kept, finished.failed) == (EPISODES, 0, ())
    top = {item.name for item in finished.folder.iterdir()}
    assert top == {"config.yaml", "configs", "manifest.json", "timing.csv", "episodes", ".lock", *TABLES}
    episode = finished.folder / "episodes" / "toy-steady-full" / "3"
    files = {"record.json", "trajectory.csv", "decisions.jsonl", "timing.json", "SHA256SUMS"}
    assert {p.name for p in episode.iterdir()} == files
    assert len((finished.folder / "episodes.csv").read_text().splitlines()) == EPISODES + 1


def test_three_workers_leave_the_bytes_of_one(tmp_path: Path, reference: dict[str, bytes]) -> None:
    assert deterministic(drive(toy_plan(tmp_path, workers=3), build=toy()).folder) == reference


def test_a_complete_run_is_a_no_op(tmp_path: Path) -> None:
    folder = drive(toy_plan(tmp_path), build=toy()).folder
    before = all_files(folder)
    again = drive(toy_plan(tmp_path), build=toy(raises=tuple(range(EPISODES))))
    assert (again.driven, again.kept) == (0, EPISODES)
    assert all_files(folder) == before


def test_only_what_is_missing_is_driven(tmp_path: Path, reference: dict[str, bytes]) -> None:
    folder = drive(toy_plan(tmp_path), build=toy()).folder
    gone = folder / "episodes" / "toy-steady-full" / "5"
    for path in gone.iterdir():
        path.unlink()
    gone.rmdir()
    # Any episode but the missing one would fail.
    again = drive(toy_plan(tmp_path), build=toy(raises=tuple(s for s in range(EPISODES) if s != 5)))
    assert (again.driven, again.kept, again.failed) == (1, EPISODES - 1, ())
    assert deterministic(folder) == reference


def test_more_episodes_drive_the_further_seeds_and_leave_the_bytes_of_all_at_once(
    tmp_path: Path, reference: dict[str, bytes]
) -> None:
    few = drive(toy_plan(tmp_path, episodes=4), build=toy())
    kept = deterministic(few.folder)
    # Any of the first seeds would fail.
    more = drive(toy_plan(tmp_path), build=toy(raises=(0, 1, 2, 3)))
    assert (more.driven, more.kept, more.failed, more.left_out) == (EPISODES - 4, 4, (), 0)
    assert deterministic(more.folder) == reference
    again = drive(toy_plan(tmp_path, episodes=4), build=toy(raises=tuple(range(EPISODES))))
    assert (again.driven, again.kept, again.left_out) == (0, 4, EPISODES - 4)
    assert {name: deterministic(again.folder)[name] for name in kept} == kept
    assert len((again.folder / "episodes.csv").read_text().splitlines()) == 5


def test_cells_are_added_beside_those_that_are_there(tmp_path: Path) -> None:
    four, eight = toy_cell({"cavs": "4"}, a=4), toy_cell({"cavs": "8"}, a=8)
    drive(toy_plan(tmp_path, cells=(four,)), build=toy())
    both = drive(toy_plan(tmp_path, cells=(eight, four)), build=toy())
    assert (both.driven, both.kept) == (EPISODES, EPISODES)
    assert {path.name for path in (both.folder / "episodes").iterdir()} == {"toy-steady-full", "toy-steady-full-cavs=8"}
    at_once = drive(toy_plan(tmp_path / "at once", cells=(eight, four)), build=toy())
    for name in TABLES:
        assert (both.folder / name).read_bytes() == (at_once.folder / name).read_bytes()
    assert [row["cavs"] for row in both.tables.summary.rows] == ["8", "4"]
    one = drive(toy_plan(tmp_path, cells=(four,)), build=toy())
    assert (one.driven, one.left_out, len(one.tables.summary.rows)) == (0, EPISODES, 1)


def test_the_config_of_each_cell_is_kept(tmp_path: Path) -> None:
    cells = (toy_cell({"a": "4"}, a=4), toy_cell({"a": "8"}, a=8))
    folder = drive(toy_plan(tmp_path, cells=cells, episodes=1), build=toy()).folder
    rest = "plugins: []\nllm: null\nmemory: null\nmethod: null\n"
    assert (folder / "configs" / "toy-steady-full-a=8.yaml").read_text() == f"seed: 0\n{rest}a: 8\n"
    assert (folder / "config.yaml").read_text() == f"seed: 0\n{rest}a: 4\n"


def test_a_run_that_goes_on_with_another_version_says_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("codriving.experiment.batch.versions", lambda: {"numpy": "1"})
    assert drive(toy_plan(tmp_path, episodes=2), build=toy()).changed == ()
    monkeypatch.setattr("codriving.experiment.batch.versions", lambda: {"numpy": "2"})
    assert drive(toy_plan(tmp_path, episodes=2), build=toy()).changed == ()
    assert drive(toy_plan(tmp_path, episodes=3), build=toy()).changed == ("numpy 1 -> 2",)


def test_failed_episodes_are_records_and_are_driven_again(tmp_path: Path, reference: dict[str, bytes]) -> None:
    broken = drive(toy_plan(tmp_path), build=toy(raises=(2,), nan=(4,)))
    message = {report.unit.seed: report.message for report in broken.failed}
    assert message[2] == "RuntimeError: seed 2 broke"
    assert any(text.startswith("ValueError: Out of range float") for text in message.values())
    episode = broken.folder / "episodes" / "toy-steady-full" / "2"
    assert json.loads((episode / "record.json").read_text())["outcome"]["ending"] == "error"
    assert "RuntimeError: seed 2" in (episode / "error.txt").read_text()
    rows = (broken.folder / "episodes.csv").read_text().splitlines()
    assert rows[3].startswith("toy,steady,full,rules,2,error,,,,,")

    mended = drive(toy_plan(tmp_path), build=toy())
    assert mended.driven == len(broken.failed)
    assert not (episode / "error.txt").exists()
    assert deterministic(mended.folder) == reference


def cut(path: Path) -> None:
    path.write_bytes(path.read_bytes()[:-40])


def flip(path: Path) -> None:
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    path.write_bytes(content)


def swap(path: Path) -> None:
    path.write_bytes((path.parent.with_name("1") / path.name).read_bytes())


DAMAGE = {
    "cut": cut,
    "flipped": flip,
    "swapped": swap,
    "gone": Path.unlink,
    "empty": lambda path: path.write_text(""),
    "garbage": lambda path: path.write_bytes(b"\xff\x00garbage" * 50),
    "a folder": lambda path: (path.unlink(), path.mkdir()),
}


@pytest.mark.parametrize("how", DAMAGE)
@pytest.mark.parametrize("name", ["record.json", "trajectory.csv", "decisions.jsonl", "SHA256SUMS"])
def test_a_damaged_episode_is_named_and_driven_again(
    name: str, how: str, tmp_path: Path, reference: dict[str, bytes], capsys: pytest.CaptureFixture[str]
) -> None:
    folder = drive(toy_plan(tmp_path), build=toy()).folder
    path = folder / "episodes" / "toy-steady-full" / "4" / name
    DAMAGE[how](path)
    capsys.readouterr()
    # Any other episode would fail.
    again = drive(toy_plan(tmp_path), build=toy(raises=tuple(s for s in range(EPISODES) if s != 4)))
    said = capsys.readouterr().err
    if (name, how) == ("SHA256SUMS", "gone"):
        # Then it is like one of release 0.1, whose files are looked at for their form.
        assert (again.driven, said) == (0, "")
        return
    assert (again.driven, again.kept, again.failed) == (1, EPISODES - 1, ())
    assert re.fullmatch(rf"{path.parent}/[\w.]+ is damaged \(.*\): driven again\.", said.splitlines()[0])
    assert deterministic(folder) == reference


@pytest.mark.parametrize("how", ["cut", "gone", "empty", "garbage"])
@pytest.mark.parametrize("name", ["record.json", "trajectory.csv", "decisions.jsonl"])
def test_damage_is_noticed_without_a_list_of_sums_too(
    name: str, how: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = drive(toy_plan(tmp_path), build=toy()).folder
    for path in folder.glob("episodes/*/*/SHA256SUMS"):
        path.unlink()
    for seed in ("4", "6"):
        DAMAGE[how](folder / "episodes" / "toy-steady-full" / seed / name)
    again = drive(toy_plan(tmp_path), build=toy())
    assert again.driven == 2
    assert re.search(rf"4/{name} is damaged \(.*\), and 1 more: driven again\.", capsys.readouterr().err)


def test_the_sums_of_an_episode_are_those_that_the_system_tells(tmp_path: Path) -> None:
    folder = drive(toy_plan(tmp_path, episodes=1), build=toy()).folder / "episodes" / "toy-steady-full" / "0"
    lines = (folder / "SHA256SUMS").read_text().splitlines()
    assert [line.partition("  ")[2] for line in lines] == ["record.json", "decisions.jsonl", "trajectory.csv"]
    for line in lines:
        digest, _, name = line.partition("  ")
        assert digest == hashlib.sha256((folder / name).read_bytes()).hexdigest()


def test_a_run_folder_that_is_taken_away_ends_the_batch(tmp_path: Path) -> None:
    class Takes(Serial):
        def launch(self, *args: Any, **kwargs: Any) -> Generator[Report, None, None]:
            for report in super().launch(*args, **kwargs):
                if report.unit.seed == 2:
                    (tmp_path / "run" / "mine").rename(tmp_path / "elsewhere")
                yield report

    plan = dataclasses.replace(toy_plan(tmp_path), launcher=Takes())
    with pytest.raises(RunFolderError, match=r"run/mine was removed or moved while it was written; put it back if"):
        drive(plan, build=toy())
    assert not (tmp_path / "run" / "mine").exists()
    assert len(list((tmp_path / "elsewhere" / "episodes" / "toy-steady-full").iterdir())) == 3


def test_episodes_that_are_taken_away_are_missed(tmp_path: Path) -> None:
    class Takes(Serial):
        def launch(self, *args: Any, **kwargs: Any) -> Generator[Report, None, None]:
            yield from super().launch(*args, **kwargs)
            shutil.rmtree(tmp_path / "run" / "mine" / "episodes" / "toy-steady-full" / "1")

    plan = dataclasses.replace(toy_plan(tmp_path), launcher=Takes())
    with pytest.raises(RunFolderError, match=rf"removed or moved .*\(1 of {EPISODES} episodes are not there"):
        drive(plan, build=toy())


def test_a_disk_that_is_full_ends_the_batch_and_keeps_what_is_there(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, reference: dict[str, bytes]
) -> None:
    write = Path.write_text

    def full(self: Path, *args: Any, **kwargs: Any) -> int:
        if self.parent.name.startswith(".partial-3-"):
            raise OSError(28, "No space left on device")
        return write(self, *args, **kwargs)

    monkeypatch.setattr(Path, "write_text", full)
    with pytest.raises(RunFolderError, match=r"cannot write .*/3: No space left on device; make room .* are kept"):
        drive(toy_plan(tmp_path), build=toy())
    monkeypatch.undo()
    again = drive(toy_plan(tmp_path), build=toy(raises=(0, 1, 2)))
    assert (again.kept, again.failed) == (3, ())
    assert deterministic(again.folder) == reference


def test_another_config_is_refused(tmp_path: Path) -> None:
    folder = drive(toy_plan(tmp_path), build=toy()).folder
    before = all_files(folder)
    with pytest.raises(RunFolderError, match=r"seed was 0, is now 9"):
        drive(toy_plan(tmp_path, cells=(toy_cell(seed=9),)), build=toy())
    assert all_files(folder) == before


def test_an_unwritable_output_is_refused(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(RunFolderError, match="choose another output"):
        drive(toy_plan(tmp_path / "file"), build=toy())


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may write anywhere")
def test_an_output_without_permission_is_refused(tmp_path: Path) -> None:
    (tmp_path / "closed").mkdir(mode=0o500)
    with pytest.raises(RunFolderError, match="Permission denied; choose another output"):
        drive(toy_plan(tmp_path / "closed"), build=toy())


def test_two_cells_are_two_rows(tmp_path: Path) -> None:
    plan = toy_plan(tmp_path, cells=(toy_cell(a=1), toy_cell(a=2)))
    finished = drive(plan, build=toy())
    assert len(list((finished.folder / "episodes").iterdir())) == 2
    assert len(finished.tables.summary.rows) == 2
    assert len(finished.tables.episodes.rows) == 2 * EPISODES


def test_a_run_without_a_name_is_called_by_its_time(tmp_path: Path) -> None:
    names = [drive(toy_plan(tmp_path, name=None), build=toy()).folder.name for _ in range(2)]
    assert names[0] != names[1]
    assert len(names[0]) == len("2026-01-02_030405")
