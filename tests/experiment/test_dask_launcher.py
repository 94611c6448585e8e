"""Episodes on a Dask cluster: the bytes of a local run, also where a node dies; what cannot be used is refused."""

import dataclasses
import sys
import tempfile
from collections import deque
from collections.abc import Iterator
from concurrent.futures import CancelledError
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from test_batch import deterministic
from toy_drive import LABELS, BuildToy
from toy_plan import toy, toy_plan

from codriving.config.build import validate
from codriving.config.compose import compose
from codriving.datatypes.record import Ending
from codriving.errors import ConfigError, LauncherError
from codriving.experiment import dask_launcher
from codriving.experiment.batch import HaltedError, drive
from codriving.experiment.dask_launcher import Dask
from codriving.experiment.nodes import NodeJob
from codriving.experiment.worker import Job, Report, Unit


@pytest.fixture(scope="module")
def reference(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """The bytes of ten episodes in one process."""
    return deterministic(drive(toy_plan(tmp_path_factory.mktemp("reference")), build=toy()).folder)


@pytest.fixture(scope="module")
def scheduler() -> Iterator[Any]:
    """A cluster of one node with two threads, in this process."""
    distributed = pytest.importorskip("distributed")
    with (
        tempfile.TemporaryDirectory() as folder,
        distributed.LocalCluster(
            n_workers=1,
            threads_per_worker=2,
            processes=False,
            protocol="tcp://",
            host="127.0.0.1",
            dashboard_address="127.0.0.1:0",
            local_directory=folder,
        ) as cluster,
    ):
        yield cluster


def test_two_processes_of_which_one_is_killed_half_way_leave_the_bytes_of_a_local_run(
    tmp_path: Path, reference: dict[str, bytes], capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("distributed")
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    main = sys.modules["__main__"]
    plan = dataclasses.replace(toy_plan(tmp_path), launcher=Dask(None, 2, 60.0))
    finished = drive(plan, build=toy(dies=(5,), dies_once=True, gate=tmp_path, waits_from=99))
    assert (tmp_path / "died-5").read_text() == "x"
    assert deterministic(finished.folder) == reference
    assert (finished.driven, finished.failed) == (10, ())
    assert not list(tmp_path.glob("codriving-dask-*"))
    assert sys.modules["__main__"] is main
    assert "Traceback" not in capsys.readouterr().err


def test_a_cluster_that_has_an_address_leaves_the_bytes_of_a_local_run(
    tmp_path: Path, reference: dict[str, bytes], scheduler: Any
) -> None:
    launcher = Dask(scheduler.scheduler_address, None, 20.0)
    launcher.prepare("auto", 10, ())
    finished = drive(dataclasses.replace(toy_plan(tmp_path), launcher=launcher, workers="auto"), build=toy())
    assert deterministic(finished.folder) == reference
    again = drive(dataclasses.replace(toy_plan(tmp_path, episodes=11), launcher=launcher), build=toy(raises=(10,)))
    assert (again.driven, again.kept) == (1, 10)
    assert [report.message for report in again.failed] == ["RuntimeError: seed 10 broke"]


def test_a_node_that_differs_is_named_before_anything_is_driven(
    tmp_path: Path, scheduler: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    differs = iter(["", "numpy is 1.0 there and 2.0 here"])
    monkeypatch.setattr(dask_launcher, "program_differences", lambda here, there: next(differs))
    launcher = Dask(scheduler.scheduler_address, None, 20.0)
    with pytest.raises(HaltedError) as caught:
        drive(dataclasses.replace(toy_plan(tmp_path), launcher=launcher), build=toy())
    (node,) = scheduler.scheduler_info["workers"]
    said = (
        f"the node {node} is not like this machine: numpy is 1.0 there and 2.0 here; install the same there; 0 of 10 "
    )
    assert str(caught.value).startswith(said)


def test_a_scheduler_without_a_node_and_an_address_without_a_scheduler_are_refused(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(
        n_workers=0, processes=False, protocol="tcp://", host="127.0.0.1", dashboard_address="127.0.0.1:0"
    ) as empty:
        address = empty.scheduler_address
        with pytest.raises(
            LauncherError, match=rf"^the cluster at {address} has no node within 0\.1 s .*; start one: "
        ):
            Dask(address, None, 0.1).prepare("auto", 1, ())
    monkeypatch.setattr(dask_launcher, "CONNECT", 0.3)
    with pytest.raises(LauncherError, match=rf"^no Dask scheduler can be reached at {address} \(") as caught:
        Dask(address, None, 20.0).prepare("auto", 1, ())
    assert "\n" not in str(caught.value)


def test_tls_without_a_certificate_is_refused() -> None:
    pytest.importorskip("distributed")
    with pytest.raises(
        ConfigError, match=r"^launcher\.address=tls://127\.0\.0\.1:9 needs a certificate of yours, which "
    ):
        Dask("tls://127.0.0.1:9", None, 20.0).prepare("auto", 1, ())


def test_without_dask_one_line_says_how_to_get_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(ConfigError) as caught:
        Dask(None, 2, 60.0).prepare(2, 10, ())
    assert str(caught.value).startswith("launcher=dask needs Dask, which is missing (")
    assert str(caught.value).endswith(
        "run make cluster in a clone of the repository, or pip install -e '.[cluster]' there"
    )


@pytest.mark.parametrize(
    ("tokens", "said"),
    [
        (
            ["launcher.address=10.0.0.1"],
            "launcher.address must be that of a scheduler, for instance tls://10.0.0.1:8786",
        ),
        (["launcher.address=tcp://10.0.0.1"], "launcher.address must be that of a scheduler"),
        (
            ["launcher.address=tcp://10.0.0.1:8786", "launcher.workers=2"],
            "launcher.workers are the processes",
        ),
        (["launcher.workers=0"], "launcher.workers must be 1 to 256, got 0"),
        (["launcher.workers=257"], "launcher.workers must be 1 to 256, got 257"),
        (["launcher.patience=0.05"], "launcher.patience must be 0.1 to 86400 s, got 0.05"),
    ],
)
def test_settings_that_mean_nothing_are_refused(tokens: list[str], said: str) -> None:
    with pytest.raises(ConfigError) as caught:
        validate(compose(["launcher=dask", *tokens]))
    assert str(caught.value).startswith(said)


def test_settings_at_their_ends_are_taken() -> None:
    for tokens in (["launcher.workers=256", "launcher.patience=0.1"], ["launcher.address=tls://node:1"]):
        validate(compose(["launcher=dask", *tokens]))


@dataclasses.dataclass
class Cluster:
    """Stands for a client: each unit ends at once, as its seed says."""

    ends: dict[int, BaseException]
    threads: list[dict[str, int]] = dataclasses.field(default_factory=lambda: [{"tcp://127.0.0.1:1": 2}])
    flying: int = 0
    most: int = 0

    def nthreads(self) -> dict[str, int]:
        """The nodes at this moment; the last ones stay."""
        return self.threads.pop(0) if len(self.threads) > 1 else self.threads[0]

    def submit(self, drive_on_node: Any, task: Any, key: str, pure: bool) -> Any:
        """Drive here, or fail as the test wants."""
        error = self.ends.get(task.unit.seed)
        self.flying += 1
        self.most = max(self.most, self.flying)

        def result() -> Any:
            self.flying -= 1
            if error is not None:
                raise error
            return drive_on_node(task)

        future = SimpleNamespace(key=key, result=result)
        future.add_done_callback = lambda put: put(future)
        return future


def driven(cluster: Cluster, seeds: int = 4, most: int | None = None) -> list[Report]:
    job = NodeJob(Job({"cell": LABELS}, BuildToy(), lambda unit, result: None))
    nodes = dask_launcher._Nodes(cluster, "tcp://127.0.0.1:9", 60.0)
    return list(dask_launcher._drive(deque(Unit("cell", seed) for seed in range(seeds)), job, nodes, most))


def test_an_episode_that_ends_its_processes_is_an_error_and_the_others_go_on() -> None:
    killed = pytest.importorskip("distributed").KilledWorker("task", None, 3)
    reports = driven(Cluster({1: killed}))
    assert {report.unit.seed for report in reports} == {0, 1, 2, 3}
    assert [(report.unit.seed, report.message) for report in reports if report.ending is Ending.ERROR] == [
        (1, "WorkerDied: 4 processes that drove this episode died")
    ]


@pytest.mark.parametrize(
    ("end", "said"),
    [
        (ImportError("no\nmodule"), "the cluster at tcp://127.0.0.1:9 failed to drive cell, seed 1: ImportError: no"),
        (CancelledError(), "the scheduler of the cluster at tcp://127.0.0.1:9 is gone or has dropped this run"),
    ],
)
def test_what_the_cluster_fails_at_stops_the_run_in_one_line(end: BaseException, said: str) -> None:
    pytest.importorskip("distributed")
    with pytest.raises(LauncherError) as caught:
        driven(Cluster({1: end}))
    assert str(caught.value).startswith(said)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(("most", "at_once"), [(None, 2), (1, 1), (5, 2)])
def test_each_thread_has_one_episode_and_no_more_than_workers_says(most: int | None, at_once: int) -> None:
    pytest.importorskip("distributed")
    cluster = Cluster({})
    assert len(driven(cluster, 5, most)) == 5
    assert cluster.most == at_once


def test_nodes_that_go_are_named_and_none_at_all_is_borne_for_a_while(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    clock = [100.0]
    monkeypatch.setattr(dask_launcher, "monotonic", lambda: clock[0])
    cluster = Cluster({}, [{"tcp://a:1": 1, "tcp://b:2": 2}, {"tcp://b:2": 2}, {}, {"tcp://c:3": 4}, {}])
    nodes = dask_launcher._Nodes(cluster, "tcp://s:9", 30.0)
    assert nodes.look() == 3
    clock[0] = 100.4
    assert nodes.look() == 3
    clock[0] = 100.5
    assert nodes.look() == 2
    assert capsys.readouterr().err == "The node tcp://a:1 is gone; what it was driving is driven again.\n"
    for moment, threads in ((101.0, 0), (131.0, 4), (140.0, 0), (161.0, 0)):
        clock[0] = moment
        assert nodes.look() == threads
    assert capsys.readouterr().err.splitlines()[1] == "No node is left; waiting 30 s for another (launcher.patience)."
    clock[0] = 161.1
    with pytest.raises(
        LauncherError, match=r"^the cluster at tcp://s:9 has had no node for 30 s \(launcher.patience\)$"
    ):
        nodes.look()
