"""``codriving experiment``: cells and tables of a file, and mistakes that are named with file and row."""

import csv
from pathlib import Path

import pytest

from codriving.commands.ablation import ablation_points
from codriving.commands.compare import comparison
from codriving.commands.experiment import experiment_command, row_points, run_experiment_file
from codriving.commands.join import JoinOptions, run_join
from codriving.commands.learn import settings_of
from codriving.config.experiments import experiment_file
from codriving.errors import ConfigError

SHORT = ["scenario.time_limit=2", "episodes=1", "seed=12000", "launcher=serial", "run=x"]

MINE = """# Two rules in two scenarios.
set: [limits=road]
rows:
  negotiated: []
  first come: [order=fcfs]
columns:
  crossing: [scenario=intersection]
  lanes: [scenario=merge]
"""


@pytest.fixture
def mine(tmp_path: Path) -> Path:
    (tmp_path / "experiments").mkdir()
    file = tmp_path / "experiments" / "mine.yaml"
    file.write_text(MINE)
    return file


def drive(file: Path, *tokens: str) -> Path:
    folder = file.parents[1]
    assert run_experiment_file(str(file), [*SHORT, f"output={folder}", *tokens]) == 0
    return folder / "mine" / "x"


def test_rows_and_columns_become_cells_and_a_table_against_the_first_row(
    mine: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = drive(mine)
    with (folder / "experiment.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [(row["row"], row["column"], row["pairs"]) for row in rows] == [
        ("negotiated", "crossing", ""),
        ("first come", "crossing", "1"),
        ("negotiated", "lanes", ""),
        ("first come", "lanes", "1"),
    ]
    assert "only_negotiated_succeeds" in rows[0]
    said = capsys.readouterr()
    lines = said.out.splitlines()
    place = next(index for index, line in enumerate(lines) if line.startswith("rows and columns"))
    assert lines[place + 1].split() == ["row", "crossing", "lanes"]
    assert lines[place + 3].split()[:3] == ["first", "come", "0"]
    assert "against negotiated on the same seeds" in said.out
    assert (
        (folder / "experiment.md").read_text().startswith("# rows and columns - intersection, merge - reasoner: rules")
    )
    drive(mine)
    assert "Nothing to do: all 4 episodes of this run are finished already." in capsys.readouterr().out


def test_the_command_line_takes_the_place_of_columns_and_not_of_rows(mine: Path) -> None:
    spec = experiment_file(str(mine))
    points = row_points(spec, ["scenario=highway", "scenario.cavs=2,3"])
    assert [point.swept for point in points] == [
        {"row": row, "scenario.cavs": cavs} for cavs in ("2", "3") for row in ("negotiated", "first come")
    ]
    assert points[1].overrides == (
        "experiment=mine",
        "limits=road",
        "scenario=highway",
        "scenario.cavs=2",
        "order=fcfs",
    )
    assert len(row_points(spec, ["suite=busy_merge"])) == 2, "a suite that is about one scenario, too"
    with pytest.raises(ConfigError, match=r"order is what .*mine\.yaml sets in rows\.first come; leave it out"):
        row_points(spec, ["order=mcts"])
    with pytest.raises(ConfigError, match="controls is no word of table: rows"):
        row_points(spec, ["controls=false"])


@pytest.mark.parametrize(
    ("old", "new", "place", "said"),
    [
        ("order=fcfs", "order=nothing", "rows.first come", "unknown order 'nothing'; choices: "),
        ("order=fcfs", "scenario.typo=3", "rows.first come", "unknown key scenario.typo"),
        ("order=fcfs", "method=fcfs, cda.negotiation=perhaps", "rows.first come", "cda.negotiation"),
        ("scenario=merge", "scenario.cavs=99", "columns.lanes", "scenario.cavs must be"),
        ("limits=road", "episodes=0", "set", "episodes must be a whole number"),
    ],
)
def test_an_override_that_does_not_compose_is_named_with_file_and_row(
    mine: Path, old: str, new: str, place: str, said: str
) -> None:
    mine.write_text(MINE.replace(old, new))
    with pytest.raises(ConfigError) as refused:
        run_experiment_file(str(mine), ["episodes=1"] if "episodes" not in new else [])
    assert str(refused.value).startswith(f"{mine}: {place}: {said}")


def test_a_mistake_of_the_command_line_is_not_said_to_be_the_files(mine: Path) -> None:
    with pytest.raises(ConfigError) as refused:
        run_experiment_file(str(mine), ["episodes=0"])
    assert str(refused.value).startswith("episodes must be a whole number")


def test_the_commands_drive_what_their_files_say() -> None:
    assert [p.overrides for p in ablation_points(["episodes=3"])] == [
        p.overrides for p in experiment_command(experiment_file("ablate"), "x").points(["episodes=3"], None)
    ]
    for table in ("baselines", "load", "orders", "filters"):
        spec = experiment_file(f"compare_{table}")
        assert comparison(table, []) == experiment_command(spec, "x").points([], None)
    learnt = settings_of([], None, experiment_file("learning"))
    assert [point.swept for point in learnt] == [
        {"scenario": name} for name in ("intersection", "roundabout", "highway", "merge")
    ]
    assert all({"suite=paper", "cda=full", "episodes=20"} <= set(point.overrides) for point in learnt)


def test_the_papers_ablation_is_that_of_the_command_in_its_world_and_scenarios() -> None:
    points = experiment_command(experiment_file("ablation"), "x").points(["controls=false"], None)
    assert [point.swept["scenario"] for point in points[::7]] == ["intersection", "roundabout", "highway", "merge"]
    assert points[8].overrides[:6] == (
        *("experiment=ablate", "suite=paper", "cda=full", "episodes=20", "seed=0", "scenario=roundabout"),
    )
    assert points[8].removed == ("cda.state_sharing=false",)


def test_shards_of_a_named_experiment_are_joined_and_those_of_a_file_refused(
    mine: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    config_dir = mine.parents[1]
    tokens = [*SHORT, "scenario=merge", f"output={config_dir}", "episodes=2"]
    for shard in ("1/2", "2/2"):
        assert run_experiment_file("mine", [*tokens, f"shard={shard}"], config_dir) == 0
    assert run_join([config_dir / "mine" / "x"], JoinOptions(config_dir)) == 0
    assert "against negotiated on the same seeds" in capsys.readouterr().out
    assert (config_dir / "mine" / "x" / "experiment.csv").is_file()
    with pytest.raises(ConfigError, match=r"shards need an experiment with a name; put .* into DIR/experiments/"):
        run_experiment_file(str(mine), [*tokens, "shard=1/2"])
