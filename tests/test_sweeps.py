"""Sweeps from the command to the table, with the real simulator: short episodes, every way to the same bytes."""

import csv
from pathlib import Path

import pytest

import codriving
from codriving.commands.ablation import ABLATE
from codriving.commands.run import run_command, run_experiment
from codriving.config.choices import choices
from codriving.errors import ConfigError, RunFolderError

SHORT = ("scenario.time_limit=3", "launcher=serial")
TABLES = ("episodes.csv", "summary.csv", "summary.md")
TWO = "scenario.cavs=4,2"


def drive(output: Path, *tokens: str, name: str = "x", code: int = 0) -> Path:
    """Run a command with short episodes and give its run folder."""
    overrides = ["scenario.time_limit=3", f"output={output}", f"run={name}", *tokens]
    if not any(token.startswith("workers=") for token in tokens):
        overrides.append("launcher=serial")
    assert run_experiment(overrides) == code
    return output / "run" / name


def tables(folder: Path) -> dict[str, bytes]:
    return {name: (folder / name).read_bytes() for name in TABLES}


def driven(folder: Path) -> dict[str, bytes]:
    """Everything that must not depend on the clock, the machine or the number of workers."""
    kept = [path for path in folder.glob("episodes/*/*/*") if path.name != "timing.json"]
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in kept}


def rows(path: Path) -> list[dict[str, str]]:
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


@pytest.fixture(scope="module")
def reference(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two numbers of CAVs, two episodes each, driven at once in one process."""
    return drive(tmp_path_factory.mktemp("reference"), TWO, "episodes=2")


def test_a_sweep_is_one_table_with_a_column_for_what_was_swept(reference: Path) -> None:
    summary, episodes = rows(reference / "summary.csv"), rows(reference / "episodes.csv")
    assert [row["scenario.cavs"] for row in summary] == ["4", "2"]
    assert [(row["scenario.cavs"], row["cavs"], row["seed"]) for row in episodes] == [
        ("4", "4", "0"),
        ("4", "4", "1"),
        ("2", "2", "0"),
        ("2", "2", "1"),
    ]
    assert sorted(path.name for path in (reference / "episodes").iterdir()) == [
        "intersection-codriving-full-scenario.cavs=2",
        "intersection-codriving-full-scenario.cavs=4",
    ]
    lines = (reference / "summary.md").read_text().splitlines()
    assert lines[2].startswith("| method | scenario.cavs | episodes |")


def test_two_workers_leave_the_bytes_of_one(reference: Path, tmp_path: Path) -> None:
    folder = drive(tmp_path, TWO, "episodes=2", "workers=2")
    assert tables(folder) == tables(reference)
    assert driven(folder) == driven(reference)


def test_a_run_that_grows_by_values_and_episodes_ends_with_the_same_tables(
    reference: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    drive(tmp_path, "scenario.cavs=4", "episodes=1")
    drive(tmp_path, TWO, "episodes=1")
    capsys.readouterr()
    folder = drive(tmp_path, TWO, "episodes=2")
    out, err = capsys.readouterr()
    assert "2 of 2 episodes done" in err
    assert "not asked for" not in out
    assert tables(folder) == tables(reference)


def test_less_is_a_table_of_what_was_asked_and_loses_nothing(
    reference: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = drive(tmp_path, TWO, "episodes=2")
    before = driven(folder)
    capsys.readouterr()
    drive(tmp_path, "scenario.cavs=2", "episodes=1")
    out = capsys.readouterr().out
    assert out.startswith("Nothing to do: all 1 episodes of this run are finished already.")
    assert "3 more episodes in this run folder were not asked for and are left out of the table." in out
    assert len(rows(folder / "episodes.csv")) == 1
    assert driven(folder) == before
    drive(tmp_path, TWO, "episodes=2")
    assert tables(folder) == tables(reference)


def test_another_config_under_the_same_name_is_refused(reference: Path) -> None:
    before = driven(reference)
    with pytest.raises(RunFolderError, match=r"another config: scenario\.hdvs was \[2, 4\], is now \[0, 0\]; repeat"):
        drive(reference.parents[1], TWO, "episodes=2", "scenario.hdvs=[0,0]")
    assert driven(reference) == before


def test_nothing_is_driven_if_one_cell_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"in the cell scenario\.cavs=99: scenario\.cavs must be 2 to 12, got 99"):
        drive(tmp_path, "scenario.cavs=2,99")
    assert list(tmp_path.iterdir()) == []


def test_all_scenarios_are_one_table_in_their_order(tmp_path: Path) -> None:
    results = codriving.run("scenario=all", "episodes=1", f"output={tmp_path}", *SHORT)
    assert list(results.summary["scenario"]) == list(choices("scenario"))
    assert list(results.episodes["scenario"]) == list(choices("scenario"))
    assert not [column for column in results.summary if "." in column]


def test_a_list_of_scenarios_from_python(tmp_path: Path) -> None:
    last, first = list(choices("scenario"))[-1], next(iter(choices("scenario")))
    results = codriving.run(f"scenario={last},{first}", "episodes=1", f"output={tmp_path}", *SHORT)
    assert list(results.summary["scenario"]) == list(dict.fromkeys([last, first]))


def test_an_ablation_of_several_scenarios_keeps_their_rows_together(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    names = list(choices("scenario"))[:2]
    tokens = [f"scenario={','.join(names)}", "episodes=1", "scenario.cavs=2", *SHORT, f"output={tmp_path}", "run=x"]
    tokens.append("controls=false")
    assert run_command(ABLATE, tokens) == 0
    summary = rows(tmp_path / "ablate" / "x" / "summary.csv")
    assert [row["scenario"] for row in summary] == [name for name in names for _ in range(7)]
    assert [row["variant"] for row in summary[:7]] == [row["variant"] for row in summary[-7:]]
    said = [line for line in capsys.readouterr().out.splitlines() if "no_intent_sharing" in line]
    # What the paper says of a row is of its own setting, not of two CAVs. Below are the rows against the full method.
    for name, line in zip(names * 2, said, strict=True):
        assert line.startswith(name)
        assert "small effect" not in line
        assert "clear drop" not in line
