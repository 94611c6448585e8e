"""Workers get ready while configs are checked, unless there will be nothing for them to do."""

from pathlib import Path

import pytest

from codriving.config.sweep import expand
from codriving.experiment.plan import make_plan
from codriving.experiment.processes import Processes


@pytest.mark.parametrize(
    ("rows", "tokens", "ready"),
    [
        (0, ["run=x"], True),
        (3, ["run=x"], False),
        (3, ["run=x", "episodes=4"], True),
        (3, ["run=x", "scenario.cavs=4,8"], True),
        (6, ["run=x", "scenario.cavs=4,8"], False),
        (3, [], True),
    ],
)
def test_a_run_that_is_complete_needs_no_workers(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, rows: int, tokens: list[str], ready: bool
) -> None:
    asked: list[int] = []
    monkeypatch.setattr(Processes, "prepare", lambda self, workers, units, preload: asked.append(units))
    (tmp_path / "run" / "x").mkdir(parents=True)
    if rows:
        lines = ["seed,message", *(f'{seed},"one\ntwo"' for seed in range(rows))]
        (tmp_path / "run" / "x" / "episodes.csv").write_text("\n".join(lines) + "\n")
    plan = make_plan(expand(["episodes=3", f"output={tmp_path}", *tokens]))
    assert asked == ([plan.episodes * len(plan.cells)] if ready else [])
