"""`codriving join` after the commands themselves: the bytes of one run, with the tables of each."""

import shutil
from collections.abc import Callable, Sequence
from pathlib import Path

import pytest

from codriving.commands import compare
from codriving.commands.ablation import ABLATE
from codriving.commands.compare import comparison_command
from codriving.commands.join import JoinOptions, _command, run_join
from codriving.commands.learn import run_learn
from codriving.commands.run import RUN, run_command
from codriving.errors import RunFolderError
from codriving.experiment.joining import FoundPart
from codriving.runs.manifest import Manifest
from codriving.runs.parts import Part

SHORT = ["scenario=intersection", "scenario.time_limit=5", "scenario.cavs=2", "launcher=serial", "seed=20000"]
DIFFER = ("manifest.json", "timing.csv", "timing.json", ".lock")


def files(run: Path) -> dict[str, bytes]:
    found = {path.relative_to(run): path for path in run.rglob("*") if path.is_file() and path.name not in DIFFER}
    return {name.as_posix(): path.read_bytes() for name, path in found.items() if name.parts[0] != "parts"}


def same_as_one(drive: Callable[[Sequence[str]], int], tokens: Sequence[str], run: Path) -> set[str]:
    """Drive a command at once and in two shards, and compare all files; returns those on top."""
    named = [*tokens, f"run={run.name}"]
    assert drive(named) == 0
    whole = files(run)
    shutil.rmtree(run)
    for index in (1, 2):
        assert drive([*named, f"shard={index}/2"]) == 0
    assert {path.name for path in run.iterdir()} == {"parts"}
    assert run_join([Path(run.name)], JoinOptions()) == 0
    assert files(run) == whole
    return {name for name in whole if "/" not in name}


def test_a_comparison_in_shards(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(compare, "taking_part", lambda _: ("codriving", "fcfs"))
    command = comparison_command("baselines")
    tokens = [*SHORT, "episodes=3", "controls=false"]
    top = same_as_one(lambda typed: run_command(command, typed), tokens, Path("outputs/compare/whole"))
    assert top >= {"comparison.csv", "comparison.md", "summary.csv", "summary.md", "episodes.csv", "config.yaml"}


def test_learning_is_done_once_and_its_tests_in_shards(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    tokens = [*SHORT, "cda=full", "interactions=0,2", "controls=false", "episodes=2"]
    top = same_as_one(run_learn, tokens, Path("outputs/learn/whole"))
    assert top >= {"learn.csv", "learn.md", "summary.csv"}
    said = capsys.readouterr().err
    assert "Learning: 2 interactions in each of 1 settings; one shard learns, the others wait for it." in said
    shutil.rmtree("outputs/learn-memory/whole")
    shutil.rmtree("outputs/learn/whole/episodes")
    with pytest.raises(RunFolderError, match="what was learnt is not in outputs/learn-memory/whole; copy it"):
        run_join([Path("outputs/learn/whole")], JoinOptions())


@pytest.mark.parametrize(
    "name", ["run", "ablate", "compare baselines", "compare all --bound", "compare load", "stress humans,loss"]
)
def test_each_command_that_has_shards_is_found_by_its_name(tmp_path: Path, name: str) -> None:
    manifest = Manifest(3, 5, "run", "", 0, 1, (), (), {}, None, {})
    command = _command(FoundPart(tmp_path, Part(1, 2, name, (), None), manifest), None)
    assert command.name == name
    assert {"run": RUN, "ablate": ABLATE}.get(name, command) is command
