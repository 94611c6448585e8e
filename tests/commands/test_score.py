"""`codriving score` on files of each kind and on a finished run; a mistake is one line."""

import csv
import json
from pathlib import Path

import pytest
from driven_run import driven_run
from typer.testing import CliRunner, Result

from codriving.cli.app import app

Row = dict[str, str]

WAITING = Path(__file__).parents[2] / "examples" / "waiting_time" / "conf"


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run with two episodes in which vehicles pass the junction."""
    return driven_run(tmp_path_factory.mktemp("outputs"), "episodes=2", "method=fcfs")


def call(*args: object) -> Result:
    return CliRunner().invoke(app, ["score", *map(str, args)])


def rows(path: Path) -> list[Row]:
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def tidy(path: Path, delay: float, kind: bool = True) -> Path:
    """A drives east and B, a human driver, south, both at 10 m/s; B passes the middle so much later [s]."""
    lines = ["time,id,x,y" + ",kind" * kind]
    for k in range(150):
        t = 0.1 * k
        lines.append(f"{t:.1f},a,{10 * (t - 5):.2f},0" + ",CAV" * kind)
        lines.append(f"{t:.1f},b,0,{10 * (t - 5 - delay):.2f}" + ",HDV" * kind)
    path.write_text("\n".join(lines), encoding="utf-8")
    return path


def test_a_row_each_and_one_of_all(tmp_path: Path) -> None:
    early, late = tidy(tmp_path / "early.csv", 0.5), tidy(tmp_path / "late.csv", 3.0)
    out, pets = tmp_path / "out.csv", tmp_path / "pets.csv"
    result = call(early, late, "--csv", out, "--pets", pets)
    assert result.exit_code == 0, result.output
    one, other, both = rows(out)
    assert [row["file"] for row in (one, other, both)] == [str(early), str(late), "all"]
    assert [row["success"] for row in (one, other, both)] == ["0", "1", "0.5"]
    assert [row["clean"] for row in (one, other, both)] == ["0", "1", "0.5"]
    assert float(one["pet_mean"]) == pytest.approx(-0.2, abs=0.02)
    assert float(other["pet_mean"]) == pytest.approx(2.3, abs=0.02)
    assert float(both["pet_mean"]) == pytest.approx(1.05, abs=0.02)
    assert (both["pet_min"], both["pet_max"]) == (one["pet_min"], other["pet_max"])
    assert (both["pet_count"], both["vehicles"], both["files"]) == ("2", "4", "2")
    assert [float(row["velocity_mean"]) for row in (one, other, both)] == pytest.approx([10, 10, 10])
    assert [row["duration"] for row in (one, other, both)] == ["14.9"] * 3
    assert {"ttc_min", "drac_max", "braking_max", "hard_braking", "jerk", "stops"} <= both.keys()
    assert [(row["first"], row["second"], row["kind"]) for row in rows(pets)] == [("a", "b", "driven")] * 2
    assert "whether all arrived, a recording does not say" in result.stdout.lower()
    assert "nothing says which vehicles are CAVs" not in result.stdout


def test_without_marks_all_count_and_that_is_said(tmp_path: Path) -> None:
    path, out = tidy(tmp_path / "a.csv", 3.0, kind=False), tmp_path / "out.csv"
    result = call(path, "--csv", out, "metrics.near_miss=2.5")
    assert result.exit_code == 0, result.output
    assert f"{path}: nothing says which vehicles are CAVs, so all of them count." in result.stdout
    assert rows(out)[0]["clean"] == "0", "the least PET is 2.3 s"


def test_a_run_is_scored_by_another_metric_and_stays_as_it_is(run: Path, tmp_path: Path) -> None:
    before = {path: path.read_bytes() for path in run.rglob("*") if path.is_file()}
    out = tmp_path / "out.csv"
    result = call(run, "metrics=authors", "metrics.rows=20", "--csv", out)
    assert result.exit_code == 0, result.output
    assert {path: path.read_bytes() for path in run.rglob("*") if path.is_file()} == before
    found = rows(out)
    assert [row["file"] for row in found] == [f"{run}/intersection-fcfs/{seed}" for seed in (0, 1)] + ["all"]
    assert result.stdout.count(f"{run}: intersection-fcfs") == 1, "a row a cell on the screen"
    files = call(*sorted(run.glob("episodes/*/*/trajectory.csv")), "metrics=authors", "metrics.rows=20", "--csv", out)
    assert files.exit_code == 0, files.output
    same = ("success", "pet_mean", "pet_count", "velocity_mean", "vehicles")
    assert [[row[key] for key in same] for row in rows(out)] == [[row[key] for key in same] for row in found]


def test_a_run_has_the_scores_that_it_was_driven_with(run: Path, tmp_path: Path) -> None:
    out = tmp_path / "out.csv"
    assert call(run, "--csv", out).exit_code == 0
    (summary,) = rows(run / "summary.csv")
    all_of_it = rows(out)[-1]
    for key in ("time_all", "hard_braking_cavs", "ttc_min", "success_forgiving"):
        assert all_of_it[key] == summary[key], key
    assert all_of_it["success"] == summary["success_rate"]
    shown = call(run).stdout.splitlines()[1]
    assert all(head in shown for head in ("ttc min [s]", "drac max [m/s2]", "hard braking cavs"))
    result = call(run, "metrics.near_miss=100", "--csv", out)
    assert "Delays, time_all and fairness need driving anew and are left out" in result.stdout
    changed = rows(out)[-1]
    assert (changed["clean"], changed["time_all"]) == ("0", "")
    for key in ("ttc_min", "pet_mean"):
        assert float(changed[key]) == pytest.approx(float(all_of_it[key]), rel=1e-3), "stored places are rounded"


def test_pets_of_a_stored_trajectory_alone_are_near_those_on_its_road(run: Path, tmp_path: Path) -> None:
    """The conflict areas of a road are those of its centre lines; vehicles cut corners by some decimetres."""
    pets = tmp_path / "pets.csv"
    (cell,) = (run / "episodes").iterdir()
    for seed in ("0", "1"):
        assert call(cell / seed / "trajectory.csv", "--pets", pets).exit_code == 0
        record = json.loads((cell / seed / "record.json").read_text(encoding="utf-8"))
        by_road = {(p["first"], p["second"]): p["value"] for p in record["scores"]["standard"]["pets"]}
        alone = {(row["first"], row["second"]): float(row["pet"]) for row in rows(pets)}
        assert by_road
        assert {pair: alone[pair] for pair in by_road} == pytest.approx(by_road, abs=0.1)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ([], "nothing to score; name files of trajectories, or a run folder"),
        (["metrics=authors"], "nothing to score"),
        (["none.csv"], "there is no file none.csv; name one that exists"),
        (["none"], "there is no run folder none"),
        (["{a}", "metrics=standard,authors"], "score takes one metric at a time"),
        (["{a}", "scenario.cavs=3"], "score takes no setting but those of metrics, got scenario.cavs=3"),
        (["{a}", "metrics=best"], "best"),
        (["{a}", "--csv", "no/out.csv"], "the folder of no/out.csv does not exist"),
        (
            ["{a}", "--config-dir", str(WAITING), "metrics=waiting_time"],
            "metrics=waiting_time needs the road",
        ),
    ],
)
def test_a_mistake_is_one_line(words: list[str], said: str, tmp_path: Path) -> None:
    path = tidy(tmp_path / "a.csv", 3.0)
    result = call(*(word.replace("{a}", str(path)) for word in words))
    assert result.exit_code == 2
    assert said in result.stderr
    assert result.stderr.count("\n") == 1
