"""Controls and the filter from the command line to the tables, and that no result depends on the number of workers."""

import csv
import json
from importlib import import_module
from pathlib import Path

import pytest

import codriving
from codriving.commands.compare import comparison_command
from codriving.commands.run import run_command

SHORT = ("scenario.cavs=2", "scenario.hdvs=[2,2]", "scenario.time_limit=4", "seed=10000", "episodes=2")

NAMES = ("fastest", "random_action", "random_order", "idm", "oracle", "pidm")


def kept(folder: Path) -> dict[str, bytes]:
    """What may not depend on how it came about."""
    files = [*folder.glob("summary.csv"), *folder.glob("episodes/*/*/trajectory.csv")]
    return {str(path.relative_to(folder)): path.read_bytes() for path in files}


def test_one_and_two_workers_drive_the_same(tmp_path: Path) -> None:
    asked = [f"method={','.join(NAMES)}", "drivers=rough", "filter=true", *SHORT, f"output={tmp_path}"]
    one = codriving.run(*asked, "run=one", "launcher=serial")
    two = codriving.run(*asked, "run=two", "workers=2")
    assert kept(one.folder) == kept(two.folder)
    variants = dict(zip(one.summary["method"], one.summary["variant"], strict=True))
    assert variants == {**dict.fromkeys(NAMES, "control"), "pidm": "filtered"}
    tracks = {name.split("/")[1]: content for name, content in kept(one.folder).items() if "/10000/" in name}
    assert len(set(tracks.values())) >= 4, "they drive differently"


def test_filters_are_a_table(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(import_module("codriving.commands.compare"), "taking_part", lambda _: ("ppo", "codriving"))
    # Long enough for a collision: the learned method has one on the first of these seeds, in the world of the paper.
    asked = [
        "launcher=serial",
        "suite=paper",
        "scenario.cavs=4",
        "seed=10000",
        "episodes=3",
        f"output={tmp_path}",
        "run=x",
        "controls=false",
    ]
    assert run_command(comparison_command("filters"), asked) == 0
    folder = tmp_path / "compare-filters" / "x"
    with (folder / "filters.csv").open(newline="", encoding="utf-8") as file:
        learned, whole = csv.DictReader(file)
    assert [(row["method"], row["variant"], row["safety_check"]) for row in (learned, whole)] == [
        ("ppo", "", "none"),
        ("codriving", "full", "own"),
    ]
    plain, filtered = (float(learned[f"success_rate_{which}"]) for which in ("plain", "filtered"))
    gained, lost = int(learned["only_filtered_succeeds"]), int(learned["only_plain_succeeds"])
    assert filtered - plain == pytest.approx((gained - lost) / 3, abs=1e-5)
    assert (whole["success_rate_plain"], whole["success_rate_filtered"], whole["replaced"]) == ("1", "", "")
    entries = [
        cav["filter"]
        for path in folder.glob("episodes/intersection-ppo-filtered/*/decisions.jsonl")
        for line in path.read_text(encoding="utf-8").splitlines()
        for cav in json.loads(line)["cavs"]
    ]
    changed = [entry for entry in entries if entry["wanted"] != entry["taken"]]
    assert float(learned["replaced"]) == pytest.approx(len(changed) / len(entries), rel=1e-4)
    assert changed
    assert all(entry["wanted"] in entry["removed"] for entry in changed)
    out = capsys.readouterr().out
    assert out.startswith("safety check behind each method - intersection")
    assert "filters.md" in {path.name for path in folder.iterdir()}
