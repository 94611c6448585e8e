"""`codriving figures`: where files are written, what is said of what is left out, and what is refused in one line."""

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
    return CliRunner().invoke(app, ["figures", *map(str, args)])


def test_into_the_folder_of_the_run_and_the_same_bytes_again(run: Path, tmp_path: Path) -> None:
    result = call(run)
    assert result.exit_code == 0, result.output
    said = result.stdout.splitlines()
    assert said[0] == f"Wrote to {run / 'figures'}, as .png and .svg: endings, rates, performance."
    assert said[1:] == [
        "No pets: no two vehicles have a PET.",
        "No trade-off: it takes two rows with PETs and successes in one panel.",
    ]
    again = call(run, "--out", tmp_path / "made")
    assert again.exit_code == 0, again.output
    for path in (run / "figures").iterdir():
        assert (tmp_path / "made" / path.name).read_bytes() == path.read_bytes()


def test_several_runs_stand_in_one_panel_by_their_names(run: Path, tmp_path: Path) -> None:
    shutil.copytree(run, other := tmp_path / "other")
    result = call(run, other, "--cell", "fcfs", "--out", tmp_path / "both")
    assert result.exit_code == 0, result.output
    said = (tmp_path / "both" / "endings.svg").read_text()
    assert "<!-- first: fcfs -->" in said
    assert "<!-- other: fcfs -->" in said
    assert "a run is named twice; name each run once" in call(run, run).output


def test_the_space_time_diagram_of_an_episode(run: Path, tmp_path: Path) -> None:
    result = call(run, "--episode", 0, "--cell", "fcfs", "--out", tmp_path)
    assert result.exit_code == 0, result.output
    assert result.stdout == f"Wrote to {tmp_path}, as .png and .svg: space-time-intersection-fcfs-0.\n"
    assert (tmp_path / "space-time-intersection-fcfs-0.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("args", "said"),
    [
        (["--episode", 7, "--cell", "fcfs"], "has no episode with seed 7; seeds: 0"),
        (["--episode", 0], "holds 2 cells; choose one with --cell: "),
        (["--cell", "elsewhere"], "has no cell elsewhere; cells: "),
        (["--out", __file__], "--out must be a folder, and "),
    ],
)
def test_what_there_is_not_is_refused_in_a_line(run: Path, args: list[object], said: str) -> None:
    result = call(run, *args)
    assert result.exit_code == 2
    assert said in result.output.replace("\n", " ")


def test_runs_that_are_not_there_and_an_episode_of_two(run: Path) -> None:
    assert "there is no run folder nowhere; runs: " in call("nowhere").output
    assert "--episode draws an episode of one run; name one" in call(run, run, "--episode", 0).output
