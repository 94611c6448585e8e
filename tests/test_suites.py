"""Worlds by name: what a suite sets, what wins over it, and every command that drives in one."""

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from codriving.cli.app import main
from codriving.config import compose, compose_training
from codriving.errors import ConfigError

FOLDER_OF_0_1 = Path(__file__).parent / "sameness" / "folder-0.1" / "run" / "plain"
SHORT = (
    "suite=paper", "scenario.cavs=2", "scenario.hdvs=[1,1]", "scenario.time_limit=2", "launcher=serial", "run=x",
)  # fmt: skip
NOTE = "The default world has changed"

Typed = Callable[..., tuple[int, str, str]]


@pytest.fixture
def typed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Typed:
    """Gives a command in an empty folder, and what it comes to: exit code, output and errors."""
    monkeypatch.chdir(tmp_path)

    def give(*arguments: str) -> tuple[int, str, str]:
        with pytest.raises(SystemExit) as ended:
            main(arguments)
        said = capsys.readouterr()
        return int(ended.value.code or 0), said.out, said.err

    return give


def world(*overrides: str) -> tuple[bool, bool]:
    """Whether vehicles have limits, and whether human drivers differ."""
    config = compose(overrides)
    assert (config["limits"], config["drivers"]) == (config["environment"]["limits"], config["environment"]["drivers"])
    return config["limits"] is not None, "styles" in config["drivers"]


@pytest.mark.parametrize(
    ("overrides", "expected"),
    [
        ((), (True, True)),
        (("suite=default",), (True, True)),
        (("suite=paper",), (False, False)),
        (("suite=paper", "limits=road"), (True, False)),
        (("limits=road", "suite=paper"), (True, False)),
        (("drivers=rough", "suite=paper"), (False, True)),
        (("suite=default", "suite=paper"), (False, False)),
        *(((f"experiments={name}",), (False, False)) for name in ("ablation", "comparison", "learning")),
        (("experiments=single_vehicle",), (False, False)),
        (("experiments=ablation", "suite=default"), (True, True)),
        (("experiments=ablation", "limits=road"), (True, False)),
    ],
)
def test_what_is_named_wins_over_the_suite_and_the_suite_over_the_default(
    overrides: tuple[str, ...], expected: tuple[bool, bool]
) -> None:
    assert world(*overrides) == expected


def test_values_that_are_named_win_over_a_suite_of_ones_own(tmp_path: Path) -> None:
    (tmp_path / "suite").mkdir()
    text = "# @package _global_\n# Mine.\ndefaults:\n  - override /drivers: rough\nscenario: {cavs: 5}\n"
    (tmp_path / "suite" / "mine.yaml").write_text(text)
    config = compose(["suite=mine", "drivers.signals=0.5"], tmp_path)
    assert (config["scenario"]["cavs"], config["drivers"]["signals"]) == (5, 0.5)
    assert config["drivers"]["shares"]["nonyielding"] == 0.2
    assert compose(["scenario.cavs=3", "suite=mine"], tmp_path)["scenario"]["cavs"] == 3


@pytest.mark.parametrize(
    ("overrides", "said"),
    [
        (("suite=papr",), "unknown suite 'papr'; choices: default, paper"),
        (("suite=",), "unknown suite"),
        (("suite.limits=road",), "suite.limits: a suite has no keys of its own, it chooses other groups; set theirs"),
        (("suite=paper", "scenario.typo=1"), "unknown key scenario.typo; keys of scenario: "),
        (("drivers.headway=1.2",), "unknown key drivers.headway; it is a key of drivers=simulator; keys of drivers: "),
        (
            ("environment.drivers.headway=1.2",),
            "environment.drivers.headway has moved in release 0.2; set drivers=simulator drivers.headway instead",
        ),
    ],
)
def test_a_slip_costs_one_line(typed: Typed, overrides: tuple[str, ...], said: str) -> None:
    for command in (("run",), ("compare", "baselines"), ("memory", "build")):
        code, out, err = typed(*command, *overrides)
        assert (code, out) == (2, "")
        assert err.startswith(f"error: {said}")
        assert err.count("\n") == 1
    assert not Path("outputs").exists()


def test_a_training_names_its_world_itself() -> None:
    with pytest.raises(ConfigError, match=r"^suite=paper: the world of a training .* write world\.suite=paper$"):
        compose_training("ppo_junction", ["suite=paper"], smoke=True)
    with pytest.raises(ConfigError, match=r"^unknown suite 'papr'; choices: default, paper, "):
        compose_training("ppo_junction", ["world.suite=papr"], smoke=True)


def settings(run: str) -> list[dict[str, Any]]:
    """What drives in each cell of a run."""
    return [cell["settings"] for cell in json.loads(Path("outputs", run, "manifest.json").read_text())["cells"]]


@pytest.mark.parametrize(
    ("command", "more", "runs", "cells"),
    [
        (("run",), ("episodes=1",), ["run/x"], 1),
        (("ablate",), ("episodes=1", "controls=false"), ["ablate/x"], 7),
        (("compare", "single-vehicle"), ("episodes=1", "controls=false"), ["compare-single-vehicle/x"], 6),
        (("memory", "build"), ("interactions=1",), ["memory/x"], 1),
        (
            ("learn",),
            ("interactions=1", "episodes=1", "scenario=merge", "cda=full", "controls=false"),
            ["learn-memory/x", "learn/x"],
            1,
        ),
    ],
)
def test_each_command_drives_in_the_suite(
    typed: Typed, command: tuple[str, ...], more: tuple[str, ...], runs: list[str], cells: int
) -> None:
    code, _, err = typed(*command, *SHORT, *more)
    assert code == 0, err
    for run in runs:
        found = settings(run)
        assert len(found) == cells
        for values in found:
            assert not [key for key in values if key.startswith("limits.")]
            assert values["environment.drivers.headway"] == "1.5"


def test_hold_is_no_action_of_the_paper() -> None:
    assert compose([])["environment"]["steady"] is True
    assert compose(["suite=paper"])["environment"]["steady"] is False
    assert compose(["suite=paper", "environment.steady=true"])["environment"]["steady"] is True


def test_the_same_world_by_other_words_goes_on(typed: Typed) -> None:
    assert typed("run", *SHORT, "episodes=1")[0] == 0
    code, out, _ = typed(
        "run", *SHORT[1:], "limits=none", "drivers=simulator", "environment.steady=false", "episodes=1"
    )
    assert code == 0
    assert "Nothing to do: all 1 episodes of this run are finished already." in out
    code, _, err = typed("run", *SHORT[1:], "episodes=1")
    assert code == 2
    assert "holds a run of another config" in err
    assert "suite=paper is the world" not in err
    code, out, _ = typed("replay", "x", "--frame", "1", "--out", "frame.png")
    assert (code, Path("frame.png").exists()) == (0, True)


def test_two_worlds_in_one_table(typed: Typed) -> None:
    code, _, err = typed("run", *SHORT[1:], "suite=default,paper", "episodes=1")
    assert code == 0, err
    assert [any(key.startswith("limits.") for key in cell) for cell in settings("run/x")] == [True, False]
    assert {"suite=default", "suite=paper"} == {
        path.name.rpartition("-")[2] for path in Path("outputs/run/x/episodes").iterdir()
    }
    assert "choose one with --cell" in typed("replay", "x", "--frame", "1")[2]
    for suite in ("default", "paper"):
        code, out, err = typed("replay", "x", f"suite={suite}", "--frame", "1")
        assert code == 0, err
        assert f"suite={suite}/0/frame-1s.png" in out


@pytest.mark.parametrize(
    ("tokens", "said"),
    [
        (("suite=default",), "nothing in outputs/run/x was driven in the world of suite=default; leave it out"),
        (("suite=papr",), "unknown suite 'papr'; choices: default, paper"),
        (
            ("scenario.cavs=3",),
            "replay takes no setting but one suite=NAME, which chooses a row, got scenario.cavs=3",
        ),
        (("suite=paper", "suite=default"), "replay takes no setting but one suite=NAME"),
        (("suite=",), "replay takes no setting but one suite=NAME"),
    ],
)
def test_replay_takes_the_row_of_a_world_and_no_other_setting(typed: Typed, tokens: tuple[str, ...], said: str) -> None:
    assert typed("run", *SHORT, "episodes=1")[0] == 0
    code, _, err = typed("replay", "x", *tokens, "--frame", "1")
    assert (code, err.count("\n")) == (2, 1)
    assert said in err


def test_the_first_run_beside_those_of_0_1_says_that_the_world_has_changed(typed: Typed) -> None:
    shutil.copytree(FOLDER_OF_0_1, "outputs/run/old")
    other = ("output=elsewhere", "episodes=1")
    assert NOTE not in typed("run", *SHORT[1:], *other)[2]
    first, second = typed("run", *SHORT[1:], "episodes=1"), typed("run", *SHORT[1:-1], "run=y", "episodes=1")
    assert (first[0], second[0]) == (0, 0)
    assert first[2].splitlines()[0] == (
        "The runs in outputs are of a release before 0.2. The default world has changed: vehicles have limits and "
        "human drivers differ (limits=road drivers=attentive). suite=paper is the world of before, though not its "
        "methods."
    )
    assert NOTE not in second[2]


def test_those_who_name_the_world_of_before_are_told_nothing(typed: Typed) -> None:
    shutil.copytree(FOLDER_OF_0_1, "outputs/run/old")
    code, _, err = typed("run", *SHORT, "episodes=1")
    assert (code, NOTE in err) == (0, False)
