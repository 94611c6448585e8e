"""Two short runs on the same seeds, driven once, and a page of both."""

import sys
from pathlib import Path

import pytest

from codriving.commands.report import ReportOptions, run_report
from codriving.commands.run import run_experiment

sys.path.insert(0, str(Path(__file__).parent))


@pytest.fixture(scope="session")
def two_runs(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """Folders of two runs of two episodes each: by rules, and with messages about orders."""
    output = tmp_path_factory.mktemp("outputs")
    short = [f"output={output}", "launcher=serial", "episodes=2", "seed=20000", "scenario.time_limit=8"]
    assert run_experiment([*short, "run=plain"]) == 0
    assert run_experiment([*short, "run=talking", "v2x=good"]) == 0
    return output / "run" / "plain", output / "run" / "talking"


@pytest.fixture(scope="session")
def page(two_runs: tuple[Path, Path], tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page of both."""
    path = tmp_path_factory.mktemp("page") / "both.html"
    run_report(two_runs, ReportOptions(out=path))
    return path
