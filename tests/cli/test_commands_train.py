"""`codriving train`: what is refused, and what is said."""

import importlib.util
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner, Result

from codriving.cli.app import app
from codriving.training import command

HERE = "output={}"


def call(*args: str) -> Result:
    return CliRunner().invoke(app, ["train", *args])


def test_help_shows_an_example() -> None:
    result = call("--help")
    assert result.exit_code == 0
    assert "Example: codriving train madqn" in result.stdout


@pytest.mark.parametrize(
    ("args", "words"),
    [
        (("ppoo",), "unknown learner 'ppoo'; learners: madqn"),
        (("madqn", "--family", "rivers"), "unknown family 'rivers'; families: junction, lanes"),
        (("madqn", "sed=2"), "unknown key sed"),
        (("madqn", "run=../x"), "run must be a name"),
    ],
)
def test_mistakes_cost_a_line(args: tuple[str, ...], words: str, tmp_path: Path) -> None:
    result = call(*args, f"output={tmp_path}")
    assert result.exit_code == 2
    assert result.stderr.count("\n") == 1
    assert words in result.stderr
    assert list(tmp_path.iterdir()) == []


def test_without_torch_it_says_how_to_install_it(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    found = importlib.util.find_spec
    monkeypatch.setattr(command.importlib.util, "find_spec", lambda name: None if name == "torch" else found(name))
    result = call("madqn", f"output={tmp_path}")
    assert result.exit_code == 2
    assert result.stderr.count("\n") == 1
    assert "pip install -e '.[train]'" in result.stderr
    assert "make torch" in result.stderr
    assert list(tmp_path.iterdir()) == []


def test_a_training_that_is_stopped_says_how_to_go_on(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    pytest.importorskip("torch")
    from codriving.training import run

    def interrupted(*_: Any) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(run, "train", interrupted)
    result = call("madqn", "--smoke", "seed=3", f"output={tmp_path}")
    assert result.exit_code == 130
    assert f"codriving train madqn --family junction --smoke seed=3 output={tmp_path}" in result.stderr
    assert (tmp_path / "train" / "madqn_junction_smoke" / "config.yaml").exists()
