"""Shards driven by processes of their own and joined: the bytes of one run, or one line that says what is wrong."""

import json
import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from test_batch import all_files, cut, deterministic, rewrite
from toy_plan import toy, toy_cell, toy_plan

from codriving.commands import join
from codriving.commands.join import JoinOptions, run_join
from codriving.commands.run import RUN, run_command
from codriving.errors import RunFolderError, UserError
from codriving.experiment.batch import drive, driving
from codriving.experiment.cells import Cell
from codriving.experiment.launchers import Serial
from codriving.runs.episode_folder import read_record
from codriving.runs.intact import rewrite_record
from codriving.runs.parts import Part, Shard
from codriving.runs.run_folder import locked

CELLS = (toy_cell({"a": "4"}, a=4), toy_cell({"a": "8"}, a=8))
TYPED = ("scenario=toy", "run=mine")


def shard(
    output: Path,
    index: int,
    count: int = 2,
    cells: Sequence[Cell] = CELLS,
    typed: Sequence[str] = TYPED,
    episodes: int = 10,
    **settings: Any,
) -> Path:
    """Drive a shard of the toy run; returns its part."""
    plan = replace(toy_plan(output, cells=tuple(cells), episodes=episodes), launcher=Serial())
    plan = replace(plan, shard=Shard(index, count), part=Part(index, count, "run", tuple(typed), None))
    with driving(plan, build=toy(**settings)) as batch:
        return batch.ended.folder


@pytest.fixture
def episodes(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> list[int]:
    """How many episodes a cell the command of the parts stands for here, and it alone."""
    asked = [10]
    monkeypatch.setattr(join, "make_plan", lambda *_, **__: toy_plan(tmp_path, cells=CELLS, episodes=asked[-1]))
    return asked


@pytest.fixture(scope="module")
def reference(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    folder = drive(toy_plan(tmp_path_factory.mktemp("reference"), cells=CELLS), build=toy()).folder
    return deterministic(folder)


def joined(*runs: Path, **options: bool) -> int:
    return run_join(runs, JoinOptions(None, **options))


@pytest.mark.parametrize("count", [2, 3])
def test_shards_joined_leave_the_bytes_of_one_run(
    tmp_path: Path, episodes: list[int], reference: Mapping[str, bytes], count: int, capsys: pytest.CaptureFixture[str]
) -> None:
    parts = [shard(tmp_path, index, count) for index in range(1, count + 1)]
    driven = [{path.parent.relative_to(part) for path in part.glob("episodes/*/*/record.json")} for part in parts]
    assert sum(map(len, driven)) == len(set().union(*driven)) == 20
    assert max(map(len, driven)) - min(map(len, driven)) <= 1
    assert not [*tmp_path.rglob("summary.*"), *tmp_path.rglob("episodes.csv"), *tmp_path.rglob("timing.csv")]
    run = tmp_path / "run" / "mine"
    assert joined(run) == 0
    assert deterministic(run) == reference
    out = capsys.readouterr().out
    assert "toy - reasoner: rules (llm=offline)" in out
    assert out.splitlines()[-1] == f"Run folder: {run}"
    manifest, of_part = (json.loads((folder / "manifest.json").read_text()) for folder in (run, parts[0]))
    assert manifest == of_part
    assert (run / "timing.csv").exists()


def test_a_joined_run_is_like_any_other_and_a_second_time_changes_nothing(
    tmp_path: Path, episodes: list[int], reference: Mapping[str, bytes], capsys: pytest.CaptureFixture[str]
) -> None:
    first, second = shard(tmp_path, 1), shard(tmp_path, 2)
    run = tmp_path / "run" / "mine"
    # The same part by two names is joined once.
    assert joined(run, first) == 0
    before = all_files(run)
    assert joined(run) == 0
    assert "Nothing to do: all 20 episodes of this run are finished already." in capsys.readouterr().out
    assert joined(first, second) == 0
    assert all_files(run) == before
    shutil.rmtree(run / "parts")
    again = drive(toy_plan(tmp_path, cells=CELLS), build=toy(raises=tuple(range(10))))
    assert (again.driven, again.kept) == (0, 20)
    assert deterministic(run) == reference


def test_parts_on_several_disks_are_joined_into_the_first(
    tmp_path: Path, episodes: list[int], reference: Mapping[str, bytes]
) -> None:
    shard(tmp_path, 1)
    shard(tmp_path / "other disk", 2)
    assert joined(tmp_path / "run" / "mine", tmp_path / "other disk" / "run" / "mine") == 0
    assert deterministic(tmp_path / "run" / "mine") == reference


def test_a_killed_shard_is_named_and_goes_on(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    out = tmp_path / "out"
    here, tests, top = (str(path) for path in Path(__file__).parents[:3])
    script = f"shard(Path({str(out)!r}), 1, cells=(toy_cell(),), dies=(4,), gate=Path({str(tmp_path)!r}))"
    killed = subprocess.run(
        [sys.executable, "-c", f"from test_joining import *\n{script}"],
        env={**os.environ, "PYTHONPATH": os.pathsep.join([here, tests, top])}, capture_output=True, check=False,
    )  # fmt: skip
    assert killed.returncode == -signal.SIGKILL
    (cell,) = cells = (toy_cell(),)
    monkeypatch.setattr(join, "make_plan", lambda *_, **__: toy_plan(out, cells=cells))
    run = out / "run" / "mine"
    said = f"{run} cannot be joined yet: shard 1/2 lacks 3 of 5 episodes, 2/2 is missing; go on with: codriving run"
    with pytest.raises(RunFolderError, match=f"{said} scenario=toy run=mine shard=1/2, and so on$"):
        joined(run)
    assert {path.name for path in run.iterdir()} == {"parts"}
    # Any of those that are finished would fail.
    shard(out, 1, cells=cells, raises=(0, 2))
    shard(out, 2, cells=cells)
    assert joined(run) == 0
    whole = drive(toy_plan(tmp_path / "whole", cells=(cell,)), build=toy())
    assert deterministic(run) == deterministic(whole.folder)


def test_a_missing_shard_is_named_with_the_command_that_drives_it(tmp_path: Path, episodes: list[int]) -> None:
    run = shard(tmp_path, 1, 3).parent.parent
    said = "shard 2/3 is missing, 3/3 is missing; go on with: codriving run scenario=toy run=mine shard=2/3, and so on"
    with pytest.raises(RunFolderError, match=said):
        joined(run)
    assert not (run / "manifest.json").exists()


def test_a_part_without_a_cell_that_its_command_now_stands_for_has_to_go_on(
    tmp_path: Path, episodes: list[int]
) -> None:
    run = shard(tmp_path, 1).parent.parent
    shard(tmp_path, 2, cells=CELLS[:1])
    said = "shard 2/2 lacks 5 of 10 episodes; go on with: codriving run scenario=toy run=mine shard=2/2"
    with pytest.raises(RunFolderError, match=said):
        joined(run)


def test_a_run_without_a_shard_does_not_begin_beside_parts(tmp_path: Path) -> None:
    run = shard(tmp_path, 1).parent.parent
    with pytest.raises(RunFolderError, match=f"parts of a run that have not been joined: codriving join {run}, or"):
        drive(toy_plan(tmp_path, cells=CELLS), build=toy())


@pytest.mark.parametrize(
    ("other", "said"),
    [
        (
            {"typed": ("scenario=toy", "seed=3")},
            "are parts of different runs, codriving run scenario=toy and",
        ),
        ({"cells": (CELLS[0], toy_cell({"a": "9"}, a=9))}, "are parts of different runs: a was 8, is now 9; drive one"),
        ({"count": 3}, r"are of 2 and of 3 shards; name the parts that belong together, as in .*/parts/\*-of-2"),
    ],
)
def test_a_foreign_part_is_refused(tmp_path: Path, episodes: list[int], other: dict[str, Any], said: str) -> None:
    run = shard(tmp_path, 1).parent.parent
    part = shard(tmp_path / "other", 2, **other)
    shutil.copytree(part, run / "parts" / part.name)
    with pytest.raises(RunFolderError, match=said):
        joined(run)
    assert not (run / "manifest.json").exists()


def test_workers_and_places_may_differ(tmp_path: Path, episodes: list[int], reference: Mapping[str, bytes]) -> None:
    shard(tmp_path, 1, typed=("scenario=toy", "workers=3", "run=mine"))
    shard(tmp_path, 2, typed=("scenario=toy", "launcher=serial", "output=/scratch", "run=mine"))
    assert joined(tmp_path / "run" / "mine") == 0
    assert deterministic(tmp_path / "run" / "mine") == reference


def test_parts_of_different_versions_are_joined_only_on_demand(
    tmp_path: Path, episodes: list[int], monkeypatch: pytest.MonkeyPatch, reference: Mapping[str, bytes]
) -> None:
    monkeypatch.setattr("codriving.experiment.batch.versions", lambda: {"numpy": "1"})
    run = shard(tmp_path, 1).parent.parent
    monkeypatch.setattr("codriving.experiment.batch.versions", lambda: {"numpy": "2"})
    second = shard(tmp_path, 2)
    with pytest.raises(RunFolderError, match="were driven by different versions: numpy 1 -> 2; drive one"):
        joined(run)
    assert joined(run, mixed=True) == 0
    assert deterministic(run) == reference
    assert json.loads((run / "manifest.json").read_text())["versions"] == {"numpy": "1"}
    rewrite(second / "manifest.json", '"behaviour": 5', '"behaviour": 4')
    with pytest.raises(RunFolderError, match=r"was driven by codriving another release \(behaviour 4, here 5\)"):
        joined(run, mixed=True)


def test_what_the_command_stands_for_here_has_to_be_what_was_driven(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    run = [shard(tmp_path, 1), shard(tmp_path, 2)][0].parent.parent
    changed = (CELLS[0], toy_cell({"a": "9"}, a=9))
    monkeypatch.setattr(join, "make_plan", lambda *_, **__: toy_plan(tmp_path, cells=changed))
    with pytest.raises(RunFolderError, match="is not what its command drives here: a was 8, is now 9; restore that"):
        joined(run)


def test_an_episode_that_failed_is_joined_as_it_is_until_its_shard_has_repeated_it(
    tmp_path: Path, episodes: list[int], reference: Mapping[str, bytes], capsys: pytest.CaptureFixture[str]
) -> None:
    run = shard(tmp_path, 1).parent.parent
    shard(tmp_path, 2, raises=(3,))
    assert joined(run) == 1
    out = capsys.readouterr().out
    assert "1 episode ended in an error, the first with RuntimeError: seed 3 broke" in out
    assert "Repeat them with: codriving run scenario=toy run=mine" in out
    shard(tmp_path, 2)
    assert joined(run) == 0
    assert deterministic(run) == reference


def test_a_damaged_episode_is_named(tmp_path: Path, episodes: list[int]) -> None:
    run = [shard(tmp_path, 1), shard(tmp_path, 2)][0].parent.parent
    (broken,) = run.glob("parts/2-of-2/episodes/*a=4/3/trajectory.csv")
    cut(broken)
    with pytest.raises(RunFolderError, match=rf"2/2 lacks 1 of 10 episodes, .*{broken.name} is damaged .*shard=2"):
        joined(run)


def test_a_part_that_is_being_driven_is_not_joined(tmp_path: Path, episodes: list[int]) -> None:
    first, _ = shard(tmp_path, 1), shard(tmp_path, 2)
    with locked(first), pytest.raises(RunFolderError, match="1-of-2 is being written by another run; wait for it"):
        joined(first.parent.parent)


def test_an_episode_that_two_parts_hold_has_to_be_one(
    tmp_path: Path, episodes: list[int], reference: Mapping[str, bytes]
) -> None:
    run = [shard(tmp_path, 1), shard(tmp_path, 2)][0].parent.parent
    copy = shutil.copytree(run / "parts" / "1-of-2", run / "parts" / "copy of 1-of-2")
    assert joined(run) == 0
    assert deterministic(run) == reference
    (cell,) = copy.glob("episodes/*a=4")
    record = read_record(cell / "0")
    rewrite_record(cell / "0", replace(record, outcome=replace(record.outcome, time=99.0)))
    with pytest.raises(RunFolderError, match="are one episode, but were driven differently; delete one of them"):
        joined(run)


def test_a_run_grows_by_its_shards(tmp_path: Path, episodes: list[int], reference: Mapping[str, bytes]) -> None:
    for index in (1, 2, 3):
        shard(tmp_path, index, 3, episodes=4)
    run = tmp_path / "run" / "mine"
    episodes.append(4)
    assert joined(run) == 0
    # Any of the first seeds would fail.
    for index in (1, 2, 3):
        shard(tmp_path, index, 3, raises=(0, 1, 2, 3))
    episodes.append(10)
    assert joined(run) == 0
    assert deterministic(run) == reference


@pytest.mark.parametrize(
    ("part", "said"),
    [
        (
            Part(1, 1, "run", TYPED, "my/conf"),
            "was driven with --config-dir my/conf; give that folder to",
        ),
        (Part(1, 1, "run", (*TYPED, "plugins=[evil]"), None), r"names plug-ins, plugins=\[evil\], which are code"),
        (Part(1, 1, "run", (*TYPED, "++scenario.plugins=[evil]"), None), "which are code; if you know them, join with"),
        (Part(1, 1, "memory build", TYPED, None), "was driven by no command that has shards; drive it again"),
        (Part(1, 1, "compare nothing", TYPED, None), "unknown table 'nothing'"),
    ],
)
def test_a_part_chooses_no_code(tmp_path: Path, part: Part, said: str) -> None:
    plan = replace(toy_plan(tmp_path, cells=CELLS, episodes=1), launcher=Serial(), shard=Shard(1, 1), part=part)
    with driving(plan, build=toy()) as batch:
        run = batch.ended.folder.parent.parent
    with pytest.raises(UserError, match=said):
        joined(run)


def test_what_holds_no_parts_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(RunFolderError, match="there is no run folder big; runs with parts: none"):
        joined(Path("big"))
    part = shard(Path("outputs"), 1)
    with pytest.raises(RunFolderError, match=r"there is no run folder big; runs with parts: outputs/run/mine$"):
        joined(Path("big"))
    shutil.move(part, tmp_path / "moved")
    with pytest.raises(RunFolderError, match="moved is a part, but in no folder parts; put it into <run"):
        joined(tmp_path / "moved")
    with pytest.raises(RunFolderError, match="outputs/run/mine has no parts; the command of a run with shard=1/4"):
        joined(Path("outputs/run/mine"))


def test_a_name_below_outputs_is_enough(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, episodes: list[int], reference: Mapping[str, bytes]
) -> None:
    monkeypatch.chdir(tmp_path)
    for index in (1, 2):
        shard(Path("outputs"), index)
    assert joined(Path("mine")) == 0
    assert deterministic(Path("outputs/run/mine")) == reference


def test_a_shard_says_what_it_has_driven_and_what_comes_next(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    plan = replace(toy_plan(tmp_path), launcher=Serial(), shard=Shard(2, 3))
    monkeypatch.setattr("codriving.commands.run.make_plan", lambda *_: plan)
    monkeypatch.setattr("codriving.experiment.batch.BuildObjects", toy(raises=(4,)))
    assert run_command(RUN, ["scenario=toy", "shard=slurm", "run=mine"]) == 1
    lines = capsys.readouterr().out.splitlines()
    run = tmp_path / "run" / "mine"
    assert lines[0] == "3 episodes of shard 2/3: 3 driven, 0 kept."
    assert lines[2] == "Repeat them with: codriving run scenario=toy shard=2/3 run=mine"
    assert lines[3:] == [f"Once all parts are there: codriving join {run}", f"Part: {run / 'parts' / '2-of-3'}"]
    kept = json.loads((run / "parts" / "2-of-3" / "part.json").read_text())
    assert kept == {
        "index": 2,
        "count": 3,
        "command": "run",
        "arguments": ["scenario=toy", "run=mine"],
        "config_dir": None,
    }
