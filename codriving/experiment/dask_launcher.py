"""``launcher=dask``: episodes on the nodes of a Dask cluster, or in processes of this machine that Dask starts."""

import logging
import re
import tempfile
import warnings
from collections import deque
from collections.abc import Generator, Iterator, Mapping, Sequence
from concurrent.futures import CancelledError
from contextlib import ExitStack, contextmanager
from queue import Empty, SimpleQueue
from time import monotonic
from typing import Any

from codriving.errors import ConfigError, LauncherError, require, require_range
from codriving.experiment.asking import announce
from codriving.experiment.launchers import Launcher, worker_count
from codriving.experiment.nodes import NodeJob, drive_on_node, program, program_differences
from codriving.experiment.processes import ATTEMPTS, WorkerDied, uninterrupted, without_main
from codriving.experiment.worker import Job, Report, Unit

CONNECT = 30.0  # How long to try to reach a scheduler [s]
CLOSE = 5.0  # How long to wait for a scheduler that is told that this run has ended [s]
POLL = 0.5  # How long to wait for a result before the nodes are looked at [s]

# For a cluster of ours: how often a unit may take a process down, and no measuring of Dask itself, which wakes each
# process up to a hundred times a second.
_OWN_CLUSTER = {
    "distributed.scheduler.allowed-failures": ATTEMPTS - 1,
    "distributed.worker.profile.enabled": False,
    "distributed.admin.tick.interval": "1s",
    "distributed.admin.system-monitor.interval": "5s",
}

_ADDRESS = re.compile(r"(tcp|tls|ws|wss)://[^\s/@]+:\d+/?")


class Dask(Launcher):
    """On the nodes of a Dask cluster; this process alone writes.

    Units are plain tasks of which each can be repeated, so those of a node that is lost are driven by another one.

    Args:
        address: Of a scheduler; None starts a cluster on this machine.
        workers: Processes of a cluster on this machine; None takes as many as ``workers=`` says.
        patience: How long to wait for a node, at the beginning and when all of them are gone [s].
    """

    elsewhere = True

    def __init__(self, address: str | None, workers: int | None, patience: float) -> None:
        require(
            address is None or _ADDRESS.fullmatch(address) is not None,
            f"address must be that of a scheduler, for instance tls://10.0.0.1:8786, or null, got {address!r:.100}",
        )
        require(
            address is None or workers is None,
            "workers are the processes of a cluster that is started here; leave them or address out",
        )
        require_range("workers", 1 if workers is None else workers, 1, 256)
        require_range("patience", patience, 0.1, 86400, " s")
        self._address, self._workers, self._patience = address, workers, patience

    def prepare(self, workers: int | str, units: int, preload: Sequence[str]) -> None:
        # Before the folder is made: a cluster that cannot be used leaves nothing behind.
        with _silenced():
            if self._address:
                with _client(self._address) as client:
                    _Nodes(client, self._address, self._patience).check()

    def launch(
        self, units: Sequence[Unit], job: Job, workers: int | str, preload: Sequence[str]
    ) -> Generator[Report, None, None]:
        node_job, waiting = NodeJob(job), deque[Unit]()
        for unit in units:
            if (report := node_job.finish_here(unit)) is None:
                waiting.append(unit)
            else:
                yield report
        if not waiting:
            return
        with ExitStack() as stack:
            stack.enter_context(_silenced())
            if (address := self._address) is None:
                address = stack.enter_context(_local_cluster(worker_count(self._workers or workers, len(waiting))))
            client = stack.enter_context(_client(address))
            nodes = _Nodes(client, self._address, self._patience)
            nodes.check()
            yield from _drive(
                waiting, node_job, nodes, None if workers == "auto" or not self._address else int(workers)
            )


def _drive(waiting: deque[Unit], job: NodeJob, nodes: "_Nodes", most: int | None) -> Iterator[Report]:
    """Keep each thread of the nodes busy with one unit, so that a unit that ends a process takes no other with it."""
    from distributed import KilledWorker

    flying: dict[str, tuple[Unit, Any]] = {}
    news: SimpleQueue[Any] = SimpleQueue()
    while waiting or flying:
        threads = nodes.look()
        while waiting and len(flying) < min(threads, most or threads):
            unit = waiting.popleft()
            future = nodes.client.submit(drive_on_node, job.task(unit), key=f"codriving-{job.batch}-{unit}", pure=False)
            flying[future.key] = unit, future
            future.add_done_callback(news.put)
        try:
            future = news.get(timeout=POLL)
        except Empty:
            continue
        unit, _ = flying.pop(future.key)
        try:
            # It raises what went wrong there, or here if what was driven is lost while it is fetched.
            answer = future.result()
        except KilledWorker as killed:
            died = f"{killed.allowed_failures + 1} processes that drove this episode died"
            yield job.abandon(unit, WorkerDied(died))
        except CancelledError as error:
            raise nodes.lost() from error
        except Exception as error:
            raise LauncherError(f"the cluster {nodes.name} failed to drive {unit}: {_line(error)}") from error
        else:
            yield job.take(unit, answer)


class _Nodes:
    """The nodes of a cluster, and when they were last looked at."""

    def __init__(self, client: Any, address: str | None, patience: float) -> None:  # noqa: ANN401 - has no types
        self.client, self.name, self._patience = client, f"at {address}" if address else "on this machine", patience
        self._cure = f"start one: dask worker {address} --nthreads 1" if address else "see whether it has memory left"
        self._threads: dict[str, int] = {}
        self._looked = self._seen = monotonic()

    def check(self) -> None:
        """Wait for the first node, and compare versions with those of all of them.

        Raises:
            LauncherError: With the name of the first one that differs.
        """
        try:
            self.client.wait_for_workers(1, timeout=self._patience)
            answers = {"the scheduler": self._scheduler(), **self.client.run(program, on_error="return")}
        except TimeoutError as error:
            raise LauncherError(
                f"the cluster {self.name} has no node within {self._patience:g} s (launcher.patience); {self._cure}"
            ) from error
        except OSError as error:
            raise self.lost() from error
        here = program()
        for name, answer in answers.items():
            node = name if name == "the scheduler" else f"the node {name}"
            if isinstance(answer, BaseException):
                raise LauncherError(
                    f"{node} cannot load this codriving ({_line(answer)}); start it in an environment like this one"
                ) from answer
            if differs := program_differences(here, answer):
                raise LauncherError(f"{node} is not like this machine: {differs}; install the same there")

    def look(self) -> int:
        """Return how many units can be driven at once, and say which nodes are gone.

        Raises:
            LauncherError: If there has been none for too long, or the scheduler is gone.
        """
        now = monotonic()
        if self._threads and now < self._looked + POLL:
            return sum(self._threads.values())
        try:
            threads = self.client.nthreads()
        except (OSError, TimeoutError, RuntimeError) as error:
            raise self.lost() from error
        for name in self._threads.keys() - threads.keys():
            announce(f"The node {name} is gone; what it was driving is driven again.")
        if self._threads and not threads:
            announce(f"No node is left; waiting {self._patience:g} s for another (launcher.patience).")
        self._threads, self._looked, self._seen = threads, now, now if threads else self._seen
        if now > self._seen + self._patience:
            raise LauncherError(f"the cluster {self.name} has had no node for {self._patience:g} s (launcher.patience)")
        return sum(threads.values())

    def lost(self) -> LauncherError:
        """Return the error for a cluster that does not answer any more."""
        return LauncherError(f"the scheduler of the cluster {self.name} is gone or has dropped this run")

    def _scheduler(self) -> Any:  # noqa: ANN401 - versions, or what went wrong
        try:
            return self.client.run_on_scheduler(program)
        except Exception as error:
            return error


@contextmanager
def _client(address: str) -> Iterator[Any]:
    """Connect to a scheduler."""
    distributed = _distributed()
    try:
        if address.startswith(("tls:", "wss:")):
            _require_certificate(distributed.Security().get_connection_args("client"), address)
        # What differs is refused below, in a line of ours.
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            client = distributed.Client(address, timeout=CONNECT, set_as_default=False, name="codriving")
    except (OSError, TimeoutError, TypeError, ValueError, RuntimeError) as error:
        raise LauncherError(
            f"no Dask scheduler can be reached at {address} ({_line(error)}); start one with dask scheduler, and see "
            "docs/cluster.md for tls://"
        ) from error
    try:
        yield client
    finally:
        try:
            client.close(timeout=CLOSE)
        except TimeoutError:
            # Its scheduler is gone, and nothing may wait for it once more when the object ends.
            client.status = "closed"


def _require_certificate(settings: Mapping[str, Any], address: str) -> None:
    if settings.get("ssl_context") is None:
        raise ConfigError(
            f"launcher.address={address} needs a certificate of yours, which Dask's own config names "
            "(distributed.comm.tls); docs/cluster.md shows how"
        )


@contextmanager
def _local_cluster(processes: int) -> Iterator[str]:
    """Start a scheduler and processes on this machine, reached by loopback only."""
    distributed = _distributed()
    import dask

    with (
        tempfile.TemporaryDirectory(prefix="codriving-dask-") as folder,
        # A process that has died is started again at any time, and must not import the caller's script.
        without_main(),
        dask.config.set(_OWN_CLUSTER),
    ):
        # That the usual port of a page that is not served is taken is no news.
        with warnings.catch_warnings(), uninterrupted():
            warnings.simplefilter("ignore")
            try:
                cluster = distributed.LocalCluster(
                    n_workers=processes,
                    threads_per_worker=1,
                    host="127.0.0.1",
                    memory_limit=None,
                    dashboard_address=None,
                    local_directory=folder,
                    silence_logs=logging.CRITICAL,
                )
            except (OSError, TimeoutError, RuntimeError) as error:
                raise LauncherError(f"Dask cannot start {processes} processes here ({_line(error)})") from error
        with cluster:
            yield cluster.scheduler_address


@contextmanager
def _silenced() -> Iterator[None]:
    """Keep Dask from telling in its own words what we tell in ours."""
    _distributed()
    from distributed.utils import silence_logging_cmgr

    with silence_logging_cmgr(logging.CRITICAL):
        yield


def _distributed() -> Any:  # noqa: ANN401 - a module that need not be there
    try:
        import distributed
    except ImportError as error:
        raise ConfigError(
            f"launcher=dask needs Dask, which is missing ({error!s:.100}); run make cluster in a clone of the "
            "repository, or pip install -e '.[cluster]' there"
        ) from error
    return distributed


def _line(error: BaseException | None) -> str:
    return " ".join(f"{type(error).__name__}: {error}".split())[:300]
