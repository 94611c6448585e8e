"""The same seed gives the same bytes: twice, and whatever the number of workers and the order of the episodes."""

from pathlib import Path

import pytest
from cells import LIMITS
from driving import codriving
from thorough import some

SHORT = ("scenario.time_limit=3", "seed=11", "episodes=1", "run=x")
TABLES = ("episodes.csv", "summary.csv", "summary.md")

REST = [*zip(("cda=all", "method=all") * 2, LIMITS, strict=True)]
"""What is left to thorough tests: each scenario is driven by all methods or in all classes anyway."""


def drive(folder: Path, *overrides: str) -> tuple[dict[str, bytes], dict[str, bytes]]:
    """The files of the episodes of a run, and its tables."""
    code, said = codriving("run", *SHORT, f"output={folder}", *overrides)
    assert code == 0, said
    run = folder / "run" / "x"
    files = {
        path.relative_to(run).as_posix(): path.read_bytes()
        for path in run.glob("episodes/*/*/*")
        if path.name != "timing.json"
    }
    return files, {name: (run / name).read_bytes() for name in TABLES}


@pytest.mark.parametrize(
    ("what", "scenario"), some(4, [*zip(("method=all", "cda=all") * 2, LIMITS, strict=True), *REST])
)
def test_the_same_seed_gives_the_same_bytes(what: str, scenario: str, tmp_path: Path) -> None:
    first, tables = drive(tmp_path / "first", what, f"scenario={scenario}", "launcher=serial")
    second, others = drive(tmp_path / "second", what, f"scenario={scenario}", "workers=2")
    # An episode that is over before the first decision says nothing.
    assert all(files for name, files in first.items() if name.endswith("decisions.jsonl"))
    expected = {"record.json", "trajectory.csv", "decisions.jsonl", "SHA256SUMS"}
    assert {name.rpartition("/")[2] for name in first} == expected
    assert first == second
    assert tables == others
