"""The example of a launcher of one's own: it drives what a launcher here drives, and a task that died is an error."""

import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import pytest
from toy_plan import toy, toy_plan

from codriving.config.build import build
from codriving.config.compose import compose
from codriving.datatypes import EpisodeLauncher
from codriving.errors import ConfigError
from codriving.experiment.batch import HaltedError, drive

FOLDER = Path(__file__).resolve().parents[2] / "examples" / "ray_launcher"
SOURCE = FOLDER / "ray_launcher.py"


class WorkerCrashedError(RuntimeError):
    """Stands for Ray's error of this name."""


@pytest.fixture
def ray(monkeypatch: pytest.MonkeyPatch) -> Iterator[ModuleType]:
    """What the example needs of Ray, in this process: a reference is the task itself, driven when it is asked for."""
    monkeypatch.syspath_prepend(str(FOLDER))
    fake: Any = ModuleType("ray")
    fake.dies, fake.started, fake.ended = {}, [], []
    fake.exceptions = SimpleNamespace(WorkerCrashedError=WorkerCrashedError, RayError=RuntimeError)
    fake.init = lambda **settings: fake.started.append(settings)
    fake.shutdown = lambda: fake.ended.append(True)
    fake.cluster_resources = lambda: {"CPU": 2.0}
    fake.wait = lambda references, num_returns, timeout: (references[-1:], references[:-1])

    def remote(**settings: Any) -> Any:
        assert settings == {"num_cpus": 1, "max_retries": 1}
        return lambda function: SimpleNamespace(remote=lambda task: Reference(function, task))

    class Reference:
        def __init__(self, function: Any, task: Any) -> None:
            self.function, self.task = function, task

    def get(reference: Reference) -> Any:
        if reference.task.unit.seed in fake.dies:
            raise fake.dies[reference.task.unit.seed]
        return reference.function(reference.task)

    fake.remote, fake.get = remote, get
    monkeypatch.setitem(sys.modules, "ray", fake)
    yield fake
    sys.modules.pop("ray_launcher", None)


def launcher(*tokens: str) -> Any:
    config = compose(["launcher=ray", *tokens], FOLDER / "conf")
    return build(config["launcher"], EpisodeLauncher, "launcher", config["plugins"])


def test_it_leaves_the_bytes_of_a_run_without_it(tmp_path: Path, ray: Any) -> None:
    def records(folder: Path) -> dict[str, bytes]:
        return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("record.json")}

    alone = drive(toy_plan(tmp_path / "alone"), build=toy())
    spread = drive(replace(toy_plan(tmp_path / "spread", workers=3), launcher=launcher()), build=toy())
    assert records(spread.folder) == records(alone.folder)
    assert len(records(alone.folder)) == 10
    local = {"num_cpus": 3, "include_dashboard": False}
    assert ray.started == [{"address": None, "log_to_driver": False, "configure_logging": False, **local}]
    assert ray.ended == [True]


def test_a_task_that_died_is_an_error_and_any_other_failure_stops(tmp_path: Path, ray: Any) -> None:
    ray.dies = {3: WorkerCrashedError("The worker died."), 7: RuntimeError("no such object\nfurther lines")}
    with pytest.raises(HaltedError, match=r"^Ray failed to drive toy-steady-full, seed 7: no such object; ") as caught:
        drive(replace(toy_plan(tmp_path), launcher=launcher("launcher.address=10.0.0.1:6379")), build=toy())
    assert "\n" not in str(caught.value)
    assert ray.started[0]["address"] == "10.0.0.1:6379"
    ray.dies = {3: WorkerCrashedError("The worker died.")}
    finished = drive(replace(toy_plan(tmp_path), launcher=launcher()), build=toy())
    assert [(report.unit.seed, report.message) for report in finished.failed] == [
        (3, "WorkerCrashedError: The worker died.")
    ]
    assert ray.ended == [True, True]


def test_without_ray_one_line_says_so(ray: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    made = launcher()
    monkeypatch.setitem(sys.modules, "ray", None)
    with pytest.raises(ConfigError, match=r"^launcher=ray needs Ray \(.*\); pip install ray$"):
        made.prepare("auto", 1, ())


def test_it_is_short() -> None:
    assert len(SOURCE.read_text(encoding="utf-8").splitlines()) < 100
