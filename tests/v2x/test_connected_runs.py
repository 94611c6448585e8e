"""Runs with a channel: the same bytes for any number of workers and after a break, and what tables say of them."""

import csv
import json
from pathlib import Path

import pytest

from codriving.commands.run import run_experiment

TYPED = ("v2x=poor", "method=codriving,madqn,pidm", "filter=true", "scenario.time_limit=3", "seed=11", "run=x")


def drive(output: Path, *more: str) -> Path:
    """Drive, and give the run folder."""
    assert run_experiment([*TYPED, f"output={output}", *more]) == 0
    return output / "run" / "x"


def driven(folder: Path) -> dict[str, bytes]:
    """Everything that must not depend on the clock or the number of workers."""
    kept = [path for path in folder.glob("episodes/*/*/*") if path.name != "timing.json"]
    files = {path.relative_to(folder).as_posix(): path.read_bytes() for path in kept}
    return files | {name: (folder / name).read_bytes() for name in ("episodes.csv", "summary.csv", "summary.md")}


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two episodes of three methods, in one process."""
    return drive(tmp_path_factory.mktemp("runs"), "episodes=2", "launcher=serial")


def test_workers_and_a_break_make_no_difference(run: Path, tmp_path: Path) -> None:
    drive(tmp_path, "episodes=1", "launcher=serial")
    again = drive(tmp_path, "episodes=2", "workers=2")
    assert driven(again) == driven(run)


def rows(run: Path) -> dict[str, dict[str, str]]:
    """The rows of the summary, by method."""
    with (run / "summary.csv").open(newline="") as file:
        return {row["method"]: row for row in csv.DictReader(file)}


def test_tables_hold_what_was_sent_a_second_and_how_old_it_was(run: Path) -> None:
    ours = rows(run)["madqn"]
    records = [json.loads(p.read_text()) for p in run.glob("episodes/*madqn*/*/record.json")]
    counts = [record["counts"] for record in records]
    seconds = sum(record["outcome"]["time"] for record in records)
    assert seconds == 6.0
    # Four CAVs send three messages each, at 31 times from 0 to 3 s.
    assert {c["messages"] for c in counts} == {4 * 3 * 31}
    assert float(ours["messages_per_second"]) == 124.0
    sent = sum(c["message_bytes"] for c in counts)
    assert float(ours["kilobytes_per_second"]) == pytest.approx(sent / 6000, rel=1e-5)
    age = sum(c["message_age"] for c in counts) / sum(c["message_uses"] for c in counts)
    assert float(ours["message_age_mean"]) == pytest.approx(age, rel=1e-5)
    assert 1.0 <= age <= 3.0


def test_the_page_says_what_was_driven_with_which_channel(run: Path) -> None:
    page = (run / "summary.md").read_text()
    assert "| messages [1/s] | kB/s | age [s] |" in page
    assert (
        "v2x=poor (10 Hz, 1 s late (always), 30 % lost, 50 m far, noise 0.3 m, 0.1 m/s): each CAV of codriving, "
        "madqn, pidm decides by what it sees and what messages have told it." in page
    )


def test_without_a_channel_nothing_is_said_of_messages(tmp_path: Path) -> None:
    typed = ("method=pidm", "scenario.time_limit=1", "seed=11", "run=x", "episodes=1", "launcher=serial")
    for name, more in (("none", ()), ("unused", ("v2x=poor",))):
        assert run_experiment([*typed, f"output={tmp_path / name}", *more]) == 0
        page = (tmp_path / name / "run" / "x" / "summary.md").read_text()
        assert "kB/s" not in page
        assert "message" not in (tmp_path / name / "run" / "x" / "summary.csv").read_text()
        said = "v2x=poor has no effect on pidm: the CAVs tell one another nothing."
        assert (said in page) is (name == "unused")


def test_a_swept_channel_has_a_column(tmp_path: Path) -> None:
    typed = ("method=madqn", "v2x=perfect,good", "scenario.time_limit=1", "seed=11", "run=x", "episodes=1")
    assert run_experiment([*typed, f"output={tmp_path}", "launcher=serial"]) == 0
    with (tmp_path / "run" / "x" / "summary.csv").open(newline="") as file:
        found = [(row["v2x"], row["messages_per_second"]) for row in csv.DictReader(file)]
    assert found == [("perfect", ""), ("good", "132")]
    page = (tmp_path / "run" / "x" / "summary.md").read_text()
    assert "v2x=good: each CAV of madqn decides" in page
