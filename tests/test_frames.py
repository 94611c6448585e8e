"""From the command line to one step of the world: few functions of ours, each with something to do."""

import inspect
import sys
from collections.abc import Mapping
from pathlib import Path

import pytest

import codriving
from codriving.cli.app import main
from codriving.datatypes.world import Action, WorldState
from codriving.environment.environment import Environment

OURS = Path(codriving.__file__).parent


def test_eight_frames_at_most_from_main_to_a_step(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    stacks: list[list[str]] = []
    step = Environment.step

    def noted(self: Environment, actions: Mapping[str, Action]) -> WorldState:
        if not stacks:
            frames = [frame for frame in inspect.stack(0)[1:] if Path(frame.filename).is_relative_to(OURS)]
            stacks.append([f"{Path(frame.filename).stem}.{frame.function}" for frame in frames])
        return step(self, actions)

    monkeypatch.setattr(Environment, "step", noted)
    tokens = [f"output={tmp_path}", "run=x", "episodes=1", "launcher=serial", "scenario.time_limit=1"]
    monkeypatch.setattr(sys, "argv", ["codriving", "run", *tokens])
    with pytest.raises(SystemExit) as stop:
        main()
    assert stop.value.code == 0
    (stack,) = stacks
    assert stack[0] == "episode.run_episode"
    assert stack[-1] == "app.main"
    assert len(stack) <= 8, stack
