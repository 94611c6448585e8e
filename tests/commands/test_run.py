"""What a finished run says, and how cells and variations come about."""

from collections.abc import Callable
from pathlib import Path

import pytest
from toy_drive import LABELS
from toy_plan import toy as toy_objects
from toy_plan import toy_plan

from codriving.commands import run
from codriving.errors import ConfigError
from codriving.experiment import batch
from codriving.experiment.cells import folder_name, make_cell
from codriving.experiment.episode import Labels
from codriving.experiment.objects import modules_to_preload


@pytest.fixture
def toy(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Callable[..., None]:
    def use(**settings: tuple[int, ...]) -> None:
        monkeypatch.setattr(run, "make_plan", lambda points, config_dir: toy_plan(tmp_path))
        monkeypatch.setattr(batch, "BuildObjects", toy_objects(**settings))

    return use


def test_the_table_is_printed_and_the_last_line_tells_the_folder(
    toy: Callable[..., None], capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    toy()
    assert run.run_experiment([]) == 0
    out, err = capsys.readouterr()
    assert out.splitlines()[0].strip() == "toy - reasoner: rules (llm=offline)"
    assert out.splitlines()[-1] == f"Run folder: {tmp_path / 'run' / 'mine'}"
    assert "10 of 10 episodes done, 0 failed" in err


def test_a_complete_run_says_so_and_prints_its_table_again(
    toy: Callable[..., None], capsys: pytest.CaptureFixture[str]
) -> None:
    toy()
    run.run_experiment([])
    first = capsys.readouterr().out
    assert run.run_experiment([]) == 0
    out, err = capsys.readouterr()
    assert out == "Nothing to do: all 10 episodes of this run are finished already.\n" + first
    assert err == ""


def test_failed_episodes_are_told_with_the_way_to_repeat_them(
    toy: Callable[..., None], capsys: pytest.CaptureFixture[str]
) -> None:
    toy(raises=(2, 3))
    assert run.run_experiment(["episodes=10"]) == 1
    out = capsys.readouterr().out
    assert "2 episodes ended in an error, the first with RuntimeError: seed 2 broke" in out
    assert "Repeat them with: codriving run episodes=10 run=mine" in out


def test_the_command_to_go_on_replaces_the_name_and_is_quoted(tmp_path: Path) -> None:
    command = run.resume_command("ablate", ["run=null", "a='x y'"], tmp_path, "2026-01-02_030405")
    assert command == f"""codriving ablate 'a='"'"'x y'"'"'' run=2026-01-02_030405 --config-dir {tmp_path}"""


def test_folders_are_readable() -> None:
    labels = Labels("intersection", "codriving", "no_negotiation/own_view", "rules")
    assert folder_name(labels) == "intersection-codriving-no_negotiation_own_view"
    assert folder_name(Labels("t", "fcfs", "", "rules")) == "t-fcfs"
    assert folder_name(Labels("../..", "a b", "", "rules")) == "_..-a_b"


def test_a_cell_is_labelled_by_its_objects_and_an_object_without_a_name_is_refused() -> None:
    config = {
        "plugins": ["toy_drive"],
        "llm": None,
        "memory": None,
        "scenario": {"_target_": "toy_drive.ToyScenario"},
        "method": {"_target_": "toy_drive.ToyMethod"},
        "metrics": {"_target_": "toy_drive.ToyMetrics"},
    }
    assert make_cell(config).metrics == "toy"
    assert make_cell(config).labels == Labels("toy", *("steady", "full", "rules"))
    assert make_cell(config).folder == folder_name(LABELS)
    with pytest.raises(ConfigError, match="method: ToyMethod needs an attribute 'name' of type str for the tables"):
        make_cell({**config, "method": {"_target_": "toy_drive.ToyMethod", "name": ""}})
    with pytest.raises(ConfigError, match=r"method must be Method, but toy_drive\.ToyScenario is none"):
        make_cell({**config, "method": config["scenario"]})


def test_only_our_own_modules_are_preloaded() -> None:
    config = {"a": {"_target_": "codriving.x.y.Z", "b": [{"_target_": "theirs.W"}]}, "c": 1}
    modules = modules_to_preload([config])
    assert "codriving.x.y" in modules
    assert not any(module.startswith("theirs") for module in modules)
