"""The exam as a task of inspect_ai, asked of its mock model; passed over where inspect_ai is not installed."""

import importlib.util
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from small_exam import small_exam

from codriving.exam.file import written_exam

FOLDER = Path(__file__).resolve().parents[2] / "examples" / "inspect_exam"

SCRIPT = """
import json, sys
from inspect_ai import eval
from inspect_ai.model import ModelOutput, ModelUsage, get_model
from inspect_exam import codriving_exam

said = ModelOutput.from_content("mockllm/model", '{"reason": "slow", "action": "SLOWER"}')
said.usage = ModelUsage()  # Else tokens are counted by a list that has to be downloaded
model = get_model("mockllm/model", custom_outputs=[said] * 1000)
[log] = eval(codriving_exam(file=sys.argv[1]), model=model, log_dir=sys.argv[2], display="none")
found = {s.id: {name: score.value for name, score in s.scores.items()} for s in log.samples}
print("FOUND " + json.dumps([log.status, found]))
"""


@pytest.mark.skipif(importlib.util.find_spec("inspect_ai") is None, reason="inspect_ai is not installed")
def test_its_mock_model_is_judged_as_the_command_judges(tmp_path: Path) -> None:
    exam = small_exam()
    (file := tmp_path / "small.jsonl.xz").write_bytes(written_exam(exam))
    path = os.pathsep.join([str(FOLDER), str(FOLDER.parents[1])])
    done = subprocess.run(
        [sys.executable, "-W", "ignore", "-c", SCRIPT, str(file), str(tmp_path / "logs")],
        env={**os.environ, "PYTHONPATH": path},
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    status, found = json.loads(done.stdout.partition("FOUND ")[2])
    assert status == "success"
    decisions = {one.name: one.actions for one in exam.situations}
    for name, actions in decisions.items():
        consequence = next((c for action, c in actions.items() if action == "SLOWER"), None)
        scores = found[f"{name}-decide"]
        expected = (0, 0) if consequence is None else (consequence.acceptable, consequence.safe)
        assert (scores["acceptable"], scores["safe"]) == expected
    for one in exam.negotiations:
        assert set(found[f"{one.name}-negotiate"].values()) == {0.0}


def test_the_page_names_it() -> None:
    assert "inspect_exam.py" in (FOLDER / "README.md").read_text(encoding="utf-8")
