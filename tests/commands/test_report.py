"""`codriving report`: where the page is written, and what is refused in one line."""

import json
import shutil
from pathlib import Path

import pytest
from driven_run import driven_run
from typer.testing import CliRunner, Result

from codriving.cli.app import app


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run of two rows, one short episode each."""
    return driven_run(tmp_path_factory.mktemp("outputs"), "episodes=1", "method=fcfs,mcts", "scenario.time_limit=4")


def call(*args: object) -> Result:
    return CliRunner().invoke(app, ["report", *map(str, args)])


def test_in_the_folder_of_the_run(run: Path) -> None:
    result = call(run)
    assert result.exit_code == 0, result.output
    path = run / "report.html"
    assert result.stdout.startswith(f"Wrote {path}: 2 episodes, ")
    text = path.read_text(encoding="utf-8")
    # Rows of one run are set against its first.
    assert "intersection-fcfs and intersection-mcts" in text
    path.unlink()


def test_one_row_of_it_elsewhere(run: Path, tmp_path: Path) -> None:
    result = call(run, "--cell", "mcts", "--replays", 0, "--out", tmp_path)
    assert result.exit_code == 0, result.output
    assert result.stdout.startswith(f"Wrote {tmp_path / 'report.html'}: 1 episode, 0 of them to replay, ")
    assert "intersection-fcfs" not in (tmp_path / "report.html").read_text(encoding="utf-8")


def test_runs_of_one_name_are_told_apart(run: Path, tmp_path: Path) -> None:
    other = tmp_path / "elsewhere" / "first"
    shutil.copytree(run, other)
    result = call(run, other, "--out", tmp_path / "both.html")
    assert result.exit_code == 0, result.output
    text = (tmp_path / "both.html").read_text(encoding="utf-8")
    assert "<h1>run first and elsewhere first</h1>" in text
    assert "every decision is the same while both are driven" in text


def test_a_page_of_several_is_called_by_their_names(run: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    here, other = tmp_path / "here", tmp_path / "other"
    shutil.copytree(run, here)
    shutil.copytree(run, other)
    monkeypatch.chdir(here)
    result = call(".", other, "--replays", 0)
    assert result.exit_code == 0, result.output
    assert [path.name for path in here.glob("*.html")] == ["report-here-other.html"]


def test_a_page_of_many_has_a_short_name(run: Path, tmp_path: Path) -> None:
    named = [tmp_path / f"{'x' * 100}{k}" for k in range(3)]
    for folder in named:
        shutil.copytree(run, folder)
    result = call(*named, "--replays", 0)
    assert result.exit_code == 0, result.output
    assert [path.name for path in named[0].glob("*.html")] == ["report-of-3-runs.html"]


@pytest.mark.parametrize(
    ("args", "words"),
    [
        (("nowhere",), "there is no run folder nowhere"),
        (("RUN", "RUN"), "is named twice; name each run once"),
        (("RUN", "--out", "page.pdf"), "--out ends in .pdf, but a page is .html"),
        (("RUN", "--out", "no/page.html"), "the folder no of --out does not exist"),
        (("RUN", "--replays", "-1"), "--replays must be 0 or more, got -1"),
        (("RUN", "--cell", "idfst"), "idfst"),
    ],
)
def test_what_cannot_be_is_refused_in_one_line(args: tuple[str, ...], words: str, run: Path) -> None:
    result = call(*[str(run) if word == "RUN" else word for word in args])
    assert result.exit_code == 2
    assert result.stderr.startswith("error: ")
    assert words in result.stderr
    assert result.stderr.count("\n") == 1
    assert not list(run.glob("*.html"))


def test_a_damaged_episode_is_named(run: Path, tmp_path: Path) -> None:
    copy = tmp_path / "first"
    shutil.copytree(run, copy)
    path = copy / "episodes" / "intersection-fcfs" / "0" / "decisions.jsonl"
    path.write_text(path.read_text(encoding="utf-8")[:-9], encoding="utf-8")
    result = call(copy)
    assert result.exit_code == 2
    assert str(path) in result.stderr
    assert result.stderr.count("\n") == 1


def test_a_run_without_an_episode(run: Path, tmp_path: Path) -> None:
    copy = tmp_path / "empty"
    copy.mkdir()
    manifest = json.loads((run / "manifest.json").read_text(encoding="utf-8"))
    (copy / "manifest.json").write_text(json.dumps(manifest), encoding="utf-8")
    result = call(copy)
    assert result.exit_code == 2
    assert "has no finished episode" in result.stderr
