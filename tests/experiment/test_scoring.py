"""Several metrics score one drive, and a later one scores what has been driven."""

import json
from pathlib import Path

import pytest

from codriving.config.sweep import expand
from codriving.experiment.batch import Finished, drive
from codriving.experiment.plan import make_plan
from codriving.experiment.scoring import names_of_scores


def run(*overrides: str) -> Finished:
    typed = ("scenario=merge", "method=fcfs", "episodes=2", "launcher=serial", "run=x", *overrides)
    return drive(make_plan(expand(typed)))


def scores(folder: Path) -> dict[str, dict[str, object]]:
    (cell,) = (folder / "episodes").iterdir()
    found: dict[str, dict[str, object]] = json.loads((cell / "0" / "record.json").read_text())["scores"]
    return found


def test_two_metrics_drive_once_and_are_two_rows(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    both = run("metrics=standard,authors")
    assert (both.driven, both.kept) == (2, 0)
    assert list(scores(both.folder)) == ["standard", "authors"]
    assert [row["metrics"] for row in both.tables.summary.rows] == ["standard", "authors"]
    assert len({row["velocity_mean"] for row in both.tables.summary.rows}) == 2
    assert len((both.folder / "timing.csv").read_text().splitlines()) == 1 + 2
    table = both.tables.summary.rows[1]

    one = run("metrics=authors")
    assert (one.driven, one.kept, one.left_out) == (0, 2, 0)
    row = one.tables.summary.rows[0]
    assert {key: value for key, value in row.items() if key != "metrics"} == {
        key: table[key] for key in row if key != "metrics"
    }
    assert {table[key] for key in table if key not in row and key != "metrics"} == {None}

    other = run("metrics.free_speed=3")
    assert other.driven == 0
    found = scores(other.folder)
    assert {name: score["settings"] for name, score in found.items()}["standard"] == {
        "free_speed": "3",
        "hard_braking": "3.4",
        "near_miss": "1.5",
    }
    assert set(found) == {"standard", "authors"}


def test_new_numbers_are_worked_out_of_what_is_stored(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    driven = scores(run("method=codriving").folder)["standard"]
    (path,) = Path("outputs").glob("*/x/episodes/*/0/record.json")
    record = json.loads(path.read_text())
    # As a version wrote it that did not know them yet.
    record["scores"]["standard"] |= {"numbers": [], "settings": {"free_speed": "null"}}
    del record["scores"]["standard"]["clean"]
    path.write_text(json.dumps(record, indent=2))
    (path.parent / "SHA256SUMS").unlink()
    again = run("method=codriving")
    assert again.driven == 0
    found = scores(again.folder)["standard"]
    assert found["clean"] == driven["clean"]
    numbers, before = (
        {n["name"]: n["value"] for n in score["numbers"]}  # type: ignore[attr-defined]
        for score in (found, driven)
    )
    assert numbers == pytest.approx(before, abs=0.02)
    assert numbers["delay_cavs"] > 0
    assert numbers["ttc_min"] > 0


def test_scores_are_named_by_their_metric_and_by_settings_where_two_are_of_one() -> None:
    assert names_of_scores([("standard", {"free_speed": "3"}), ("authors", {})]) == ["standard", "authors"]
    assert names_of_scores([("standard", {"free_speed": "3"}), ("standard", {"free_speed": "5"})]) == [
        "standard free_speed=3",
        "standard free_speed=5",
    ]
