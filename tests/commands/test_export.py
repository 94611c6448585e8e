"""`codriving export`: what is written can be read, by us and by SUMO's own tool."""

import csv
import json
import os
import shutil
import subprocess
import sys
from dataclasses import fields
from pathlib import Path
from typing import Any

import pytest
from driven_run import driven_run
from typer.testing import CliRunner, Result

from codriving.cli.app import app
from codriving.commands.sft import refuse_measured
from codriving.errors import RunFolderError
from codriving.experiment.stored import StoredEpisode
from codriving.recordings.read import read_recording
from codriving.runs.episode_folder import read_decisions, read_record, read_transcript
from codriving.runs.manifest import CellEntry
from codriving.runs.trajectory_file import read_trajectory


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run with two short episodes in which vehicles pass the junction."""
    return driven_run(tmp_path_factory.mktemp("outputs"), "episodes=2", "method=fcfs", "scenario.time_limit=14")


def call(*args: object) -> Result:
    return CliRunner().invoke(app, ["export", *map(str, args)])


@pytest.mark.parametrize(("layout", "ending"), [("fcd", ".fcd.xml"), ("csv", ".csv")])
def test_a_file_an_episode_that_is_read_as_what_was_driven(layout: str, ending: str, run: Path, tmp_path: Path) -> None:
    result = call(run, "--to", layout, "--out", tmp_path / "new" / "folder")
    assert result.exit_code == 0, result.output
    names = [f"intersection-fcfs-{seed}{ending}" for seed in (0, 1)]
    assert sorted(path.name for path in (tmp_path / "new" / "folder").iterdir()) == names
    folder = run / "episodes" / "intersection-fcfs" / "1"
    driven = read_trajectory(folder, read_record(folder))
    found = read_recording(tmp_path / "new" / "folder" / names[1])
    assert driven is not None
    assert found.marked
    after = {track.id: track for track in found.trajectory.tracks}
    for before in driven.tracks:
        own = after[before.id]
        assert (own.kind, own.first_step, len(own.x)) == (before.kind, before.first_step, len(before.x))
        for name in ("x", "y", "speed"):
            assert getattr(own, name) == pytest.approx(getattr(before, name), abs=5e-4), name


def test_one_episode_beside_the_others_of_its_run(run: Path) -> None:
    result = call(run, "--to", "fcd", "--episode", 1, "--cell", "fcfs")
    assert result.exit_code == 0, result.output
    path = run / "exported" / "intersection-fcfs-1.fcd.xml"
    assert result.stdout == f"Wrote {path}: 1 episode.\n"
    assert [item.name for item in path.parent.iterdir()] == [path.name]
    shutil.rmtree(path.parent)


def test_interactions_are_the_pets_of_the_records(run: Path, tmp_path: Path) -> None:
    result = call(run, "--to", "interhub", "--out", tmp_path)
    assert result.exit_code == 0, result.output
    with (tmp_path / "interhub.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    expected = []
    for seed in (0, 1):
        for pet in read_record(run / "episodes" / "intersection-fcfs" / str(seed)).scores["standard"].pets:
            expected.append((str(seed), f"{pet.first};{pet.second}", round(pet.value, 3)))
    assert [(row["scenario_idx"], row["key_agents"], round(float(row["PET"]), 3)) for row in rows] == expected
    assert {row["dataset"] for row in rows} == {"codriving"}
    assert {row["intensity"] + row["priority_label"] for row in rows} == {""}
    assert all(float(row["start"]) < float(row["end"]) for row in rows)


def _trace_exporter() -> Path | None:
    """SUMO's own tool, where it is installed."""
    homes = [os.environ.get("SUMO_HOME", ""), "/usr/share/sumo", "/usr/local/share/sumo"]
    tools = [Path(home) / "tools" / "traceExporter.py" for home in homes if home]
    return next((tool for tool in tools if tool.is_file()), None)


@pytest.mark.skipif(_trace_exporter() is None, reason="SUMO is not installed")
def test_sumos_own_tool_reads_it(run: Path, tmp_path: Path) -> None:
    assert call(run, "--to", "fcd", "--episode", 0, "--out", tmp_path).exit_code == 0
    source = tmp_path / "intersection-fcfs-0.fcd.xml"
    command = [sys.executable, "-W", "ignore", str(_trace_exporter()), "--fcd-input", str(source)]
    gpx = tmp_path / "a.gpx"
    subprocess.run([*command, "--gpx-output", str(gpx)], check=True, timeout=120, capture_output=True)
    trips = read_recording(source).trajectory.tracks
    text = gpx.read_text(encoding="utf-8")
    assert text.count("<trk>") == len(trips)
    assert text.count("<trkpt") == sum(len(track.x) for track in trips)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["{run}", "--to", "kml"], "--to must be fcd, interhub, csv or sft, got kml"),
        (["none", "--to", "fcd"], "there is no run folder none"),
        (["{run}", "--to", "fcd", "--episode", "7"], "has no finished episode with seed 7"),
        (["{run}", "--to", "fcd", "--cell", "mcts"], "has no cell mcts"),
        (["{run}", "--to", "fcd", "--out", "{run}/manifest.json"], "--out must be a folder"),
        (["{run}"], "Missing option '--to'"),
        (["{run}", "--to", "sft"], "seed 0 is one of 0 to 9999, which tables are made with"),
    ],
)
def test_a_mistake_is_one_line(words: list[str], said: str, run: Path) -> None:
    result = call(*(word.replace("{run}", str(run)) for word in words))
    assert result.exit_code == 2
    assert said in result.stderr
    assert result.stderr.count("\n") == 1


@pytest.fixture(scope="module")
def tuned(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run of the optimum and of a control in a model's place, on seeds that may be learnt from."""
    short = "scenario.time_limit=2", "episodes=1", "seed=20000", "scenario.cavs=4"
    return driven_run(tmp_path_factory.mktemp("outputs"), *short, "method=codriving,bruteforce", "llm=first")


def chats(run: Path, cell: str, out: Path) -> list[dict[str, Any]]:
    result = call(run, "--to", "sft", "--cell", cell, "--out", out)
    assert result.exit_code == 0, result.output
    return [json.loads(line) for line in (out / "sft.jsonl").read_text(encoding="utf-8").splitlines()]


def test_decisions_of_a_method_are_chats(tuned: Path, tmp_path: Path) -> None:
    lines = chats(tuned, "bruteforce", tmp_path)
    folder = next(tuned.glob("episodes/*bruteforce*/20000"))
    cavs = [cav for line in read_decisions(folder) for cav in line["cavs"] if len(cav["allowed"]) > 1]
    assert len(lines) == len(cavs) > 0
    for line, cav in zip(lines, cavs, strict=True):
        assert [message["role"] for message in line["messages"]] == ["system", "user", "assistant"]
        answer = json.loads(line["messages"][2]["content"])
        assert answer["action"] == cav["action"]
        assert all(action in line["messages"][1]["content"] for action in cav["allowed"])
        told = line["purpose"], line["cav"], line["seed"], line["answered_by"]
        assert told == ("decide", cav["id"], 20000, "bruteforce")


def test_of_a_model_it_is_what_it_was_asked(tuned: Path, tmp_path: Path) -> None:
    lines = chats(tuned, "codriving", tmp_path)
    folder = next(tuned.glob("episodes/*codriving*/20000"))
    asked = [line for line in read_transcript(folder) if line["value"] is not None]
    assert [line["messages"][:2] for line in lines] == [line["calls"][0]["messages"] for line in asked]
    assert {line["purpose"] for line in lines} == {"negotiate", "decide"}
    assert all(line["answered_by"].startswith("control first") for line in lines)


def at(seed: int) -> StoredEpisode:
    return StoredEpisode(CellEntry(*[None] * len(fields(CellEntry))), seed, Path())  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("seed", "said"),
    [
        (9_999, "0 to 9999, which tables"),
        (100_000, "100000 to 109999, which tables"),
        (109_999, "100000 to 109999, which tables"),
        (28_000, "28000 to 28999, which the exam is of"),
        (28_999, "28000 to 28999, which the exam is of"),
        (29_000, "29000 to 29959, which the judged moments are of"),
        (29_959, "29000 to 29959, which the judged moments are of"),
    ],
)
def test_seeds_by_which_models_are_measured_are_refused(seed: int, said: str) -> None:
    with pytest.raises(RunFolderError, match=f"seed {seed} is one of {said}"):
        refuse_measured([at(20_000), at(seed)])


def test_other_seeds_are_not() -> None:
    refuse_measured([at(n) for n in (10_000, 27_999, 29_960, 99_999, 110_000, 1_000_000)])
