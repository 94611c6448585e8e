"""The calls from Python: frames of a run that was driven are those of its folder, and mistakes are exceptions."""

import subprocess
import sys
from pathlib import Path

import pandas as pd
import pytest
from pandas.testing import assert_frame_equal

import codriving
from codriving.api.result import Result
from codriving.errors import ConfigError, RunFolderError

SHORT = ("launcher=serial", "episodes=2", "seed=20000", "scenario.time_limit=12", "scenario.cavs=2", "method=fcfs,idm")


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory) -> Result:
    """Two methods on two seeds."""
    return codriving.run(*SHORT, f"output={tmp_path_factory.mktemp('outputs')}", "run=short")


@pytest.fixture(scope="module")
def there(result: Result) -> Result:
    """The same run, read from its folder."""
    return codriving.load(result.folder)


@pytest.mark.parametrize("table", ["episodes", "summary", "table"])
def test_a_run_that_is_there_has_the_same_tables(result: Result, there: Result, table: str) -> None:
    driven, read = getattr(result, table), getattr(there, table)
    # An empty column does not say whether words or numbers are missing in it.
    driven, read = (
        frame.astype({key: object for key in driven if driven[key].isna().all()}) for frame in (driven, read)
    )
    assert_frame_equal(read.fillna(pd.NA), driven.fillna(pd.NA), check_dtype=False, rtol=1e-5)
    assert there.folder == result.folder
    assert [entry.method for entry in there.manifest.cells] == ["fcfs", "idm"]


def test_pets_are_those_of_the_episodes(there: Result) -> None:
    pets = there.pets()
    assert list(pets.columns) == [
        *("scenario", "method", "variant", "reasoner", "seed", "outcome", "first", "second", "kind", "pet")
    ]
    assert len(pets) == there.episodes["pet_count"].sum() > 0
    for row in there.episodes.itertuples():
        own = pets[(pets["method"] == row.method) & (pets["seed"] == row.seed)]["pet"]
        assert own.empty or own.min() == pytest.approx(row.pet_min, rel=1e-5)
    one = there.pets(cell="fcfs", episode=20001)
    assert set(zip(one["method"], one["seed"], strict=True)) <= {("fcfs", 20001)}


def test_decisions_and_trajectories_of_an_episode(there: Result) -> None:
    decided = there.decisions(cell="fcfs", episode=20000)
    assert set(decided["id"]) == {"CAV1", "CAV2"}
    assert set(decided["action"]) <= {"FASTER", "SLOWER", "IDLE", "HOLD", "LANE_LEFT", "LANE_RIGHT"}
    assert decided["time"].is_monotonic_increasing
    assert decided["entry"][0]["action"] == decided["action"][0]
    driven = there.trajectories(cell="fcfs", episode=20000)
    text = pd.read_csv(there.folder / "episodes" / "intersection-fcfs" / "20000" / "trajectory.csv")
    assert len(driven) == len(text)
    here = driven.sort_values(["time", "id"], ignore_index=True)
    assert list(here["x"]) == list(text.sort_values(["time", "id"])["x"])
    assert set(here["route"]) <= {"south-north", *driven["route"]}
    # A method that hands its CAVs over decides nothing.
    assert set(there.decisions(cell="idm")["action"]) == {""}


def test_a_notebook_shows_a_table_with_intervals_and_escapes_it(there: Result) -> None:
    page = there._repr_html_()
    assert page.startswith(f"<p>4 episodes in 2 rows, {there.folder}</p>\n<table>\n<tr><th>scenario</th>")
    assert "<th>success</th>" in page
    assert "<td>100 % (34.2 to 100)</td>" in page or "<td>0 % (0 to 65.8)</td>" in page
    odd = Result(Path("<a>"), there.episodes, there.summary, there.table.assign(method="<b>&"))
    assert "<b>" not in odd._repr_html_()
    assert "&lt;b&gt;&amp;" in odd._repr_html_()
    assert repr(there).startswith(f"<4 episodes in 2 rows, {there.folder}; .table, ")


def test_a_run_is_scored_again(there: Result) -> None:
    scores = codriving.score(there.folder, "metrics.near_miss=2.5")
    assert list(scores.table["file"])[-1] == "all"
    assert len(scores.table) == 5
    assert len(scores.pets) == len(there.pets())
    assert "scores of 4 files by metrics=standard" in scores._repr_html_()
    assert scores.notes


def test_what_cannot_be_read_is_said_in_a_line(there: Result, tmp_path: Path) -> None:
    with pytest.raises(RunFolderError, match=r"^there is no run folder nowhere; runs: "):
        codriving.load("nowhere")
    with pytest.raises(ConfigError, match=r"^a run is a folder, or the name of one below outputs/, got 5$"):
        codriving.load(5)  # type: ignore[arg-type]
    with pytest.raises(RunFolderError, match=r"has no cell elsewhere; cells: "):
        there.pets(cell="elsewhere")
    with pytest.raises(RunFolderError, match=r"has no finished episode with seed 7; "):
        there.decisions(episode=7)
    with pytest.raises(ConfigError, match=r"^episode must be a seed, a whole number, got '3'$"):
        there.trajectories(episode="3")  # type: ignore[arg-type]
    for draw in (lambda: there.figure("pets", cell=3), lambda: there.space_time(20000, cell=3)):  # type: ignore[arg-type]
        with pytest.raises(ConfigError, match=r"^cell must be the name of a row, or None, got 3$"):
            draw()
    with pytest.raises(ConfigError, match=r"^a figure is asked for by its name, got \['pets'\]$"):
        there.figure(["pets"])  # type: ignore[arg-type]
    with pytest.raises(ConfigError, match=r"^a file is named by a text or a path, got 3$"):
        there.figure("endings").save(3)  # type: ignore[arg-type]
    with pytest.raises(RunFolderError, match=r"^no episode was scored by metrics=authors; it was by standard, "):
        there.pets(metrics="authors")
    with pytest.raises(ConfigError, match="nothing to score; name files of trajectories, or a run folder"):
        codriving.score()
    with pytest.raises(ConfigError, match=r"^a source is the path of a file, or a run, got 5$"):
        codriving.score(5)  # type: ignore[arg-type]
    (folder := tmp_path / "begun").mkdir()
    (folder / "manifest.json").write_bytes((there.folder / "manifest.json").read_bytes())
    with pytest.raises(RunFolderError, match=r"has no episodes\.csv yet; the command of the run with the same run="):
        codriving.load(folder)
    (folder / "episodes.csv").write_text("")
    (folder / "summary.csv").write_text("")
    with pytest.raises(RunFolderError, match=r"episodes\.csv cannot be read \(No columns to parse from file\); "):
        codriving.load(folder)


def test_an_ablation_and_a_learning_curve_are_tables_of_their_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    short = ("launcher=serial", "episodes=1", "seed=20000", "scenario.time_limit=1", "scenario.cavs=2", "run=x")
    ablation = codriving.ablate(*short, "controls=false", "scenario=intersection")
    assert len(ablation.table) == len(ablation.summary) == 7
    assert ablation.folder == Path("outputs/ablate/x")
    assert list(codriving.load("outputs/ablate/x").table["clean_rate"]) == list(ablation.table["clean_rate"])
    curve = codriving.learn(*short, "scenario=intersection", "cda=full", "interactions=0,1", "controls=false")
    assert list(curve.table["interactions"]) == [0, 1]
    assert list(codriving.load(curve.folder).table["interactions"]) == [0, 1]


def test_the_import_is_light() -> None:
    assert {"run", "load", "score", "parallel_env"} <= set(dir(codriving))
    heavy = "pandas", "hydra", "highway_env", "matplotlib", "numpy", "codriving.commands"
    code = f"import sys, codriving; dir(codriving); print([name for name in {heavy} if name in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"
