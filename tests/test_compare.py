"""codriving compare with the real simulator: short episodes, two methods that exist and one that does not."""

import csv
import sys
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path

import pytest

import codriving
from codriving.commands import comparison_command, run_command
from codriving.commands.compare import EXPERIMENT
from codriving.errors import ConfigError

PACKAGE = "toy_methods"
SOURCE = '''"""Methods for tests."""
from dataclasses import dataclass, field
from codriving.datatypes.world import Action
from codriving.datatypes.situation import Deliberation
from codriving.datatypes.parts import Method


@dataclass
class Said(Deliberation):
    """Nothing but actions."""

    chosen: dict
    counts: dict = field(default_factory=dict)

    @property
    def actions(self):
        """What was chosen."""
        return self.chosen

    def as_dict(self):
        """One line."""
        return {"actions": {name: action.name for name, action in self.actions.items()}}


@dataclass
class Steady(Method):
    """Every CAV does the same."""

    action: str
    name: str = "steady"
    variant: str = ""
    reasoner: str = "none"

    def reset(self, road_map, model, seed):
        """Nothing to forget."""

    def act(self, world):
        """The one action."""
        return Said({cav.id: Action[self.action] for cav in world.cavs})
'''
YAML = "# Always the same.\n_target_: toy_methods.Steady\nplugins: [toy_methods]\naction: {action}\n{rest}"
BOTH = ("launcher=serial", "scenario.time_limit=4", "controls=false", "run=x")


@pytest.fixture
def own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A config folder with a method of the paper's, as far as this test goes, and one of a user's."""
    first = {"single-vehicle": "ppo_toy"}
    others = {"single-vehicle": "fcfs_toy"}
    monkeypatch.setattr(
        import_module("codriving.commands.compare"),
        "taking_part",
        lambda table: (first.get(table, "fcfs_toy"), others.get(table, "madqn_toy"), "codriving"),
    )
    folder = tmp_path / "conf" / "method"
    folder.mkdir(parents=True)
    (tmp_path / f"{PACKAGE}.py").write_text(SOURCE)
    (folder / "fcfs_toy.yaml").write_text(YAML.format(action="FASTER", rest="name: fcfs_toy\n"))
    (folder / "mine.yaml").write_text(YAML.format(action="SLOWER", rest=""))
    yield tmp_path / "conf"
    sys.modules.pop(PACKAGE, None)
    if str(tmp_path) in sys.path:
        sys.path.remove(str(tmp_path))


def compare(own: Path, table: str, *tokens: str) -> Path:
    assert run_command(comparison_command(table), [*BOTH, f"output={own.parent}", *tokens], own) == 0
    return own.parent / EXPERIMENT[table] / "x"


def rows(path: Path) -> list[dict[str, str]]:
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def files(folder: Path) -> dict[str, bytes]:
    """The tables that must not depend on the clock or on how they came about."""
    kept = [*folder.glob("*.csv"), *folder.glob("*.md"), *folder.glob("figures/*")]
    return {path.name: path.read_bytes() for path in kept if path.name != "timing.csv"}


def test_baselines_are_one_run_with_a_row_for_every_method(own: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = compare(own, "baselines", "episodes=2", "method=mine")
    table = rows(folder / "comparison.csv")
    assert [(row["method"], row["status"]) for row in table] == [
        ("fcfs_toy", "driven"),
        ("codriving", "driven"),
        ("steady", "driven"),
        ("madqn_toy", "not there yet"),
    ]
    assert [row["pairs"] for row in table] == ["2", "", "2", ""]
    episodes = rows(folder / "episodes.csv")
    assert [row["seed"] for row in episodes] == ["0", "1"] * 3
    assert {path.name for path in folder.iterdir()} >= {"summary.csv", "summary.md", "timing.csv", "comparison.md"}
    assert all(float(row["decision_cpu_mean"]) >= 0 for row in rows(folder / "timing.csv"))
    out = capsys.readouterr().out
    assert "madqn_toy" in out
    assert "CPU [ms]" in out
    assert "CPU" not in (folder / "comparison.md").read_text()
    assert out.splitlines()[-1] == f"Run folder: {folder}"


def test_a_comparison_grows_under_its_name_and_repeats_to_the_byte(
    own: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    compare(own, "baselines", "episodes=1")
    capsys.readouterr()
    grown = files(compare(own, "baselines", "episodes=2", "method=mine"))
    assert "4 of 4 episodes done" in capsys.readouterr().err
    assert files(compare(own, "baselines", "episodes=2", "method=mine")) == grown
    assert capsys.readouterr().out.startswith("Nothing to do: all 6 episodes")
    (own.parent / "compare").rename(own.parent / "before")
    assert files(compare(own, "baselines", "episodes=2", "method=mine")) == grown


def test_load_is_a_table_and_a_figure(own: Path) -> None:
    folder = compare(own, "load", "episodes=1", "scenario.cavs=2,3", "scenario=intersection,merge")
    table = rows(folder / "load.csv")
    assert [(row["scenario"], row["method"]) for row in table] == [
        (scenario, method)
        for scenario in ("intersection", "merge")
        for method in ("fcfs_toy", "madqn_toy", "codriving")
    ]
    assert [bool(row["completed_2"] and row["completed_3"]) for row in table] == [True, False, True] * 2
    assert {path.name for path in (folder / "figures").iterdir()} == {"load.png", "load.svg"}
    assert [row["scenario.cavs"] for row in rows(folder / "summary.csv")] == ["2"] * 4 + ["3"] * 4


def test_python_gets_the_comparison_as_a_frame(own: Path) -> None:
    tokens = [*BOTH, f"output={own.parent}", "episodes=1"]
    results = codriving.compare("baselines", *tokens, config_dir=own)
    assert list(results.table["method"]) == ["fcfs_toy", "codriving", "madqn_toy"]
    assert results.table["velocity_mean"].dtype == float
    assert list(results.table["status"]) == ["driven", "driven", "not there yet"]
    assert len(results.episodes) == len(results.summary) == 2
    assert results.folder == own.parent / "compare" / "x"


def test_the_single_vehicle_table_has_methods_and_a_folder_of_its_own(own: Path) -> None:
    table = rows(compare(own, "single-vehicle", "episodes=1") / "comparison.csv")
    assert [(row["method"], row["status"]) for row in table] == [
        ("fcfs_toy", "driven"),
        ("codriving", "driven"),
        ("ppo_toy", "not there yet"),
    ]
    assert not (own.parent / "compare").exists()


def test_rows_are_set_against_the_bound_if_that_is_asked_for(own: Path, capsys: pytest.CaptureFixture[str]) -> None:
    tokens = [
        *BOTH,
        f"output={own.parent}",
        "scenario.time_limit=30",
        "scenario.cavs=2",
        "scenario.hdvs=[0,0]",
        "episodes=1",
    ]
    assert run_command(comparison_command("baselines", bounded=True), tokens, own) == 0
    folder = own.parent / EXPERIMENT["baselines"] / "x"
    assert "above bound [s]" in capsys.readouterr().out
    table = {row["method"]: row for row in rows(folder / "comparison.csv")}
    bound, ours = float(table["bound"]["arrival_mean"]), float(table["codriving"]["arrival_mean"])
    assert float(table["codriving"]["above_bound"]) == pytest.approx(ours - bound, abs=1e-3)
    assert float(rows(folder / "bound.csv")[0]["bound"]) == pytest.approx(2 * bound, abs=0.01)
    # Where a CAV cannot arrive there is none, and it is said why.
    tokens[tokens.index("run=x")] = "run=y"
    assert run_command(comparison_command("baselines", bounded=True), [*tokens, "scenario.time_limit=4"], own) == 0
    assert "Above bound is empty: CAV1 does not arrive within the time limit" in capsys.readouterr().out


def test_bound_is_refused_where_there_is_none(own: Path) -> None:
    with pytest.raises(ConfigError, match="compare load has no columns of the bound"):
        comparison_command("load", bounded=True)
    flow = [*BOTH, f"output={own.parent}", "flow=steady"]
    with pytest.raises(ConfigError, match="no bound is defined for a flow"):
        run_command(comparison_command("baselines", bounded=True), flow, own)
