"""Flows with the real simulator: driven, gone on with, replayed and compared; the same bytes for any workers."""

import csv
import hashlib
import sys
from pathlib import Path

import pytest

import codriving
from codriving.commands import RUN, ReplayOptions, run_command, run_replay
from codriving.errors import RunFolderError

SHORT = ("flow=steady", "flow.warm_up=5", "flow.window=15", "flow.arrivals=500", "seed=10000", "method=fcfs")


@pytest.fixture(autouse=True)
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def rows(file: str) -> list[dict[str, str]]:
    with Path(file).open(encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream))


def digests(run: str) -> dict[str, str]:
    """What every file of the episodes and every table holds, but for what it cost in time."""
    place = Path("outputs/run", run)
    files = [f for f in place.rglob("*") if f.is_file() and f.parent.name.isdigit() and f.name != "timing.json"]
    files += [place / name for name in ("episodes.csv", "summary.csv", "summary.md")]
    return {str(f.relative_to(place)): hashlib.sha256(f.read_bytes()).hexdigest() for f in files}


def test_a_run_is_driven_gone_on_with_and_replayed(capsys: pytest.CaptureFixture[str]) -> None:
    assert run_command(RUN, [*SHORT, "episodes=1", "launcher=serial", "run=a"]) == 0
    assert run_command(RUN, [*SHORT, "episodes=2", "launcher=serial", "run=a"]) == 0
    out, err = capsys.readouterr()
    assert "1 of 1 episodes done" in err, "the first one is kept"
    assert "throughput [1/h]" in out
    assert "success" not in out
    assert run_command(RUN, [*SHORT, "episodes=2", "launcher=serial", "run=b"]) == 0
    assert digests("a") == digests("b")
    assert run_command(RUN, [*SHORT, "episodes=2", "launcher=serial", "run=a"]) == 0
    assert "Nothing to do: all 2 episodes" in capsys.readouterr().out
    first, second = rows("outputs/run/a/episodes.csv")
    assert (first["outcome"], first["duration"], first["seed"]) == ("counted", "20", "10000")
    assert first["throughput"] != second["throughput"]
    (summary,) = rows("outputs/run/a/summary.csv")
    assert float(summary["vehicles"]) == float(first["vehicles"]) + float(second["vehicles"])
    assert run_replay(Path("outputs/run/a"), ReplayOptions(frame=20.0)).endswith("20 s of seed 10000.")
    with pytest.raises(RunFolderError, match=r"flow.arrivals was 500, is now 400"):
        run_command(RUN, [*SHORT, "flow.arrivals=400", "episodes=1", "launcher=serial", "run=a"])


def test_workers_change_no_byte() -> None:
    assert run_command(RUN, [*SHORT, "episodes=3", "launcher=serial", "run=one"]) == 0
    assert run_command(RUN, [*SHORT, "episodes=3", "workers=2", "run=two"]) == 0
    assert digests("one") == digests("two")


def test_stored_flows_are_scored_by_another_metric() -> None:
    assert run_command(RUN, [*SHORT, "episodes=1", "launcher=serial", "run=a"]) == 0
    (before,) = rows("outputs/run/a/episodes.csv")
    again = codriving.run(*SHORT, "episodes=1", "launcher=serial", "run=a", "metrics.hard_braking=0.1")
    (after,) = again.episodes.to_dict("records")
    assert after["hard_braking"] > float(before["hard_braking"])
    assert after["delay"] == pytest.approx(float(before["delay"]), abs=0.01)


def test_methods_are_compared_without_pairs(capsys: pytest.CaptureFixture[str]) -> None:
    tokens, imported = [token for token in SHORT if not token.startswith("method")], "torch" in sys.modules
    given = codriving.compare("single-vehicle", *tokens, "controls=false", "episodes=1", "launcher=serial", "run=c")
    assert list(given.table["method"]) == ["pidm", "noncoop_game", "ppo", "tell", "dilu-rule", "codriving"]
    assert (given.table["demand"] == given.table["demand"][0]).all(), "all are asked for the same"
    page = Path("outputs/compare-single-vehicle/c/comparison.md").read_text(encoding="utf-8")
    assert "against codriving" not in page
    assert "success" not in page
    assert ("torch" in sys.modules) is imported, "by this comparison"
