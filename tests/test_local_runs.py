"""Short episodes that a real model drives, by llama.cpp in this process: ``make test-local``."""

import csv
import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

pytestmark = pytest.mark.skipif(not os.environ.get("LOCAL"), reason="a model takes seconds an answer; make test-local")

SHORT = ("scenario.cavs=4", "episodes=1", "seed=10000", "scenario.time_limit=1.5", "run=local")


def drive(folder: Path, *more: str) -> dict[str, str]:
    """Run as a user does, and return the row of the one episode."""
    command = [sys.executable, "-m", "codriving", "run", "llm=local", *SHORT, *more]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    (row,) = csv.DictReader((folder / "outputs/run/local/episodes.csv").read_text(encoding="utf-8").splitlines())
    return row


def calls(folder: Path) -> list[dict[str, Any]]:
    """Return what was asked and answered."""
    (transcript,) = folder.glob("outputs/run/local/episodes/*/*/transcript.jsonl")
    return [json.loads(line) for line in transcript.read_text(encoding="utf-8").splitlines()]


# With the beginning of a prompt kept, a question takes half as long; only which bytes come out then depends on what was
# asked before.
@pytest.mark.parametrize("scenario", ["intersection", "roundabout", "highway", "merge"])
def test_a_real_model_drives_every_scenario(scenario: str, tmp_path: Path) -> None:
    row = drive(tmp_path, f"scenario={scenario}", "llm.extra={cache_prompt: true}")
    assert row["reasoner"].startswith("local/SmolLM2-135M-Instruct")
    assert row["outcome"] == "timeout"
    asked = calls(tmp_path)
    assert len(asked) > 0
    answered = [line for line in asked if line["value"] is not None]
    # The grammar leaves no other form; what it cannot know is which order has no circle.
    assert all(call["form"] == "json_schema" for line in asked for call in line["calls"])
    assert len(answered) >= 0.9 * len(asked)
    assert float(row["prompt_tokens"]) > 100 * len(asked)
    assert float(row["cost_usd"]) == 0.0


def test_what_was_answered_is_replayed_without_llama(tmp_path: Path) -> None:
    few = ("scenario=merge",)
    asked = drive(tmp_path, *few, "llm.cache=use")
    answers = calls(tmp_path)
    (tmp_path / "outputs/run").rename(tmp_path / "first")
    assert drive(tmp_path, *few, "llm.cache=replay") == asked
    assert calls(tmp_path) == answers
