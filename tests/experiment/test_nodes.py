"""What a node is sent, what it is not, and what becomes of what it gives back."""

import pickle
import sys
from collections.abc import Generator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from toy_drive import LABELS, BuildToy

from codriving.config.compose import compose
from codriving.config.sweep import expand
from codriving.datatypes.record import Ending
from codriving.errors import LauncherError
from codriving.experiment.batch import drive
from codriving.experiment.episode import EpisodeResult, Labels, run_episode
from codriving.experiment.launchers import Serial
from codriving.experiment.nodes import NodeJob, NodeTask, Refusal, drive_on_node, program, program_differences
from codriving.experiment.objects import BuildObjects, make_objects
from codriving.experiment.plan import make_plan
from codriving.experiment.worker import Job, Report, Unit

SECRET = "hunter2-and-more"
SHORT = ("scenario.cavs=2", "scenario.hdvs=[1,1]", "scenario.time_limit=2")
UNIT = Unit("cell", 10_000)


class Kept(dict[Unit, EpisodeResult]):
    """Keeps results in memory."""

    def __call__(self, unit: Unit, result: EpisodeResult) -> None:
        """Keep one."""
        self[unit] = result


def job(config: dict[str, Any], kept: Kept | None = None) -> Job:
    return Job({"cell": Labels("a", "b", "c", "d")}, BuildObjects({"cell": config}), Kept() if kept is None else kept)


def sent(task: NodeTask) -> NodeTask:
    made = pickle.loads(pickle.dumps(task))
    assert isinstance(made, NodeTask)
    return made


def test_a_node_drives_what_this_process_drives() -> None:
    config, kept = compose([*SHORT, "scenario=merge", "method=fcfs"]), Kept()
    node_job = NodeJob(job(config, kept))
    assert node_job.finish_here(UNIT) is None
    answer = pickle.loads(pickle.dumps(drive_on_node(sent(node_job.task(UNIT)))))
    report = node_job.take(UNIT, answer)
    environment, method, metrics, *_ = make_objects(config)
    alone = run_episode(environment, method, metrics, 10_000, Labels("a", "b", "c", "d"))
    assert report == Report(UNIT, alone.record.outcome.ending)
    assert kept[UNIT].record == alone.record
    assert repr(kept[UNIT].decisions) == repr(alone.decisions)


def test_nothing_secret_is_sent(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MY_KEY", SECRET)
    tokens = ["method=fcfs", "llm=openai", "llm.model=m", "llm.api_key_env=MY_KEY", f"llm.headers={{X-Me: {SECRET}}}"]
    config = compose([*SHORT, *tokens, "launcher=dask", "launcher.address=tcp://10.0.0.1:8786"])
    assert SECRET in str(config)
    task = NodeJob(job(config)).task(UNIT)
    text = pickle.dumps(task)
    for hidden in (SECRET, "MY_KEY", "10.0.0.1", "openai", "PATH="):
        assert hidden.encode() not in text, hidden
    assert isinstance(task.build, BuildObjects)
    assert task.build.configs["cell"]["llm"] is None


@pytest.mark.parametrize(
    ("key", "value"), [("api_token", SECRET), ("server", f"http://me:{SECRET}@example.org"), ("password", SECRET)]
)
def test_what_may_be_a_secret_is_refused_and_not_shown(key: str, value: str) -> None:
    config = compose([*SHORT, "method=fcfs"])
    config["method"] = {**config["method"], key: value}
    with pytest.raises(LauncherError) as caught:
        NodeJob(job(config)).task(UNIT)
    assert f"no node is sent cell: method.{key} may hold a secret" in str(caught.value)
    assert SECRET not in str(caught.value)


@pytest.mark.parametrize("tokens", [("llm=random",), ("llm=ollama", "llm.model=ollama_chat/m")])
def test_what_asks_a_model_is_never_sent(tokens: tuple[str, ...]) -> None:
    with pytest.raises(LauncherError, match=r"^no node is sent cell: it asks a server, which stays on this machine; "):
        NodeJob(job(compose([*SHORT, *tokens]))).task(UNIT)


def test_a_node_needs_only_the_plug_ins_that_it_builds_of(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    source = "from codriving.methods.idm import Idm\n\n\nclass Mine(Idm):\n    pass\n"
    for name in ("my_methods", "my_launchers"):
        (tmp_path / f"{name}.py").write_text(source)
    monkeypatch.syspath_prepend(str(tmp_path))
    config = compose([*SHORT, "method=idm", "plugins=[my_methods,my_launchers]"])
    config["method"] = {**config["method"], "_target_": "my_methods.Mine"}
    task = NodeJob(job(config)).task(UNIT)
    assert isinstance(task.build, BuildObjects)
    assert task.build.configs["cell"]["plugins"] == ["my_methods"]
    assert set(task.files) == {"plug-in my_methods.py"}
    for name in ("my_methods", "my_launchers"):
        sys.modules.pop(name, None)


def test_a_node_of_another_program_refuses() -> None:
    task = NodeJob(job(compose([*SHORT, "method=fcfs"]))).task(UNIT)
    answer = drive_on_node(task._replace(batch="other", program={**task.program, "numpy": "1.0"}))
    assert isinstance(answer, Refusal)
    assert f"numpy is {program()['numpy']} there and 1.0 here" == answer.text


def test_a_node_without_a_file_of_the_run_names_it() -> None:
    task = NodeJob(job(compose([*SHORT, "method=madqn"]))).task(UNIT)
    name = min(task.files)
    assert "weights" in name
    assert len(task.files[name]) == 64
    answer = drive_on_node(task._replace(batch="changed", files={**task.files, name: "0" * 64}))
    assert isinstance(answer, Refusal)
    assert answer.text.startswith(f"{name}: not the files that are here; copy them")
    with pytest.raises(LauncherError, match=rf"^the node \S+ cannot drive cell, seed 10000: {name}: not the files"):
        NodeJob(job(compose([*SHORT, "method=madqn"]))).take(UNIT, answer)


def test_programs_are_compared_by_versions_and_source() -> None:
    here = program()
    assert {"python", "codriving", "numpy", "scipy", "highway-env", "source of codriving"} <= here.keys()
    assert "xllamacpp" not in here
    assert program_differences(here, dict(here)) == ""
    there = {**here, "numpy": "9.9", "source of codriving": "abc"}
    del there["scipy"]
    said = program_differences({**here, "numpy": "2.0"}, there)
    assert said.startswith("numpy is 9.9 there and 2.0 here, scipy is missing there and ")
    assert ", source of codriving is abc there and " in said


def test_objects_are_built_once_a_cell_and_batch() -> None:
    built: list[str] = []
    build = BuildToy()

    def counted(cell: str) -> Any:
        built.append(cell)
        return build(cell)

    names = [f"cell{number}" for number in range(5)]
    toys = Job(dict.fromkeys(names, LABELS), counted, Kept())
    node_job = NodeJob(toys)
    for name in (*names[:4], names[0], names[4], names[0]):
        answer = drive_on_node(node_job.task(Unit(name, 1)))
        assert isinstance(answer, EpisodeResult)
        assert answer.record.outcome.ending is Ending.SUCCESS
    # Four at once: the first one had to make room for the fifth.
    assert built == [*names, names[0]]
    drive_on_node(NodeJob(toys).task(Unit(names[4], 1)))
    assert len(built) == 7


def test_what_asks_in_any_way_stays_on_this_machine(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    launched: list[tuple[str, list[str]]] = []

    class Watched(Serial):
        name, asks = "here", False

        def launch(self, units: Any, *args: Any, **kwargs: Any) -> Generator[Report, None, None]:
            launched.append((self.name, sorted({unit.cell for unit in units})))
            yield from super().launch(units, *args, **kwargs)

    class Elsewhere(Watched):
        name, elsewhere = "elsewhere", True

    monkeypatch.setattr("codriving.experiment.places.Processes", Watched)
    tokens = (*SHORT, "scenario=merge", "llm=offline,random", "episodes=1", f"output={tmp_path}", "run=x")
    plan = make_plan(expand([*tokens, "seed=10000", "launcher=serial"]))
    assert drive(replace(plan, launcher=Elsewhere())).failed == ()
    assert launched == [
        ("here", ["merge-codriving-full-control_random_informed_"]),
        ("elsewhere", ["merge-codriving-full-rules"]),
    ]


@pytest.mark.parametrize("suite", ["paper", "default"])
def test_a_cell_and_a_node_are_told_by_the_weights_of_their_world(suite: str) -> None:
    (cell,) = make_plan(expand(["method=madqn", f"suite={suite}", "launcher=serial"])).cells
    told = {file.name: file for file in cell.files}
    assert Path(told["weights"].path).parent.name == suite
    task = NodeJob(job(compose(["method=madqn", f"suite={suite}"]))).task(UNIT)
    assert task.files == {name: file.sha256 for name, file in told.items()}
