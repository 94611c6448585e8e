"""Units over worker processes, which ignore Ctrl-C and die with their parent; a dead one is replaced."""

import multiprocessing
import multiprocessing.forkserver
import multiprocessing.resource_tracker
import os
import signal
import sys
import tempfile
import threading
import types
from collections import Counter, deque
from collections.abc import Generator, Iterator, Sequence
from contextlib import contextmanager, suppress
from multiprocessing.connection import Connection, wait
from multiprocessing.context import ForkServerContext, SpawnContext

from codriving.errors import RunFolderError, UserError
from codriving.experiment.launchers import Launcher, Serial, worker_count
from codriving.experiment.worker import Job, Report, Unit, Worker

ATTEMPTS = 2  # How often a unit may take its process down: once can be the machine's fault, twice is the unit's


class Processes(Launcher):
    """In several processes of this machine; a single one is this process itself."""

    def prepare(self, workers: int | str, units: int, preload: Sequence[str]) -> None:
        # Importing takes longer than anything else before the first step.
        if worker_count(workers, units) > 1:
            _context(preload)

    def launch(
        self, units: Sequence[Unit], job: Job, workers: int | str, preload: Sequence[str]
    ) -> Generator[Report, None, None]:
        processes = worker_count(workers, len(units))
        yield from Serial().launch(units, job) if processes == 1 else run_parallel(units, job, processes, preload)


def run_parallel(
    units: Sequence[Unit], job: Job, workers: int, preload: Sequence[str]
) -> Generator[Report, None, None]:
    """Drive units, each by the next process that is free; with the iterator, the processes end."""
    waiting = deque(units)
    deaths: Counter[Unit] = Counter()
    pool: list[WorkerProcess] = []
    try:
        while waiting or any(worker.unit for worker in pool):
            while waiting and len(pool) < workers:
                worker = WorkerProcess(job, preload)
                pool.append(worker)
                worker.send(waiting.popleft())
            busy = {worker.connection: worker for worker in pool if worker.unit}
            for ready in wait(list(busy)):
                worker = next(w for c, w in busy.items() if c is ready)
                unit = worker.unit
                assert unit is not None
                try:
                    report = worker.receive()
                except WorkerDied as death:
                    pool.remove(worker)
                    worker.stop()
                    deaths[unit] += 1
                    if deaths[unit] < ATTEMPTS:
                        waiting.appendleft(unit)
                        continue
                    report = Worker(job).abandon(unit, death)
                else:
                    if waiting:
                        worker.send(waiting.popleft())
                yield report
    finally:
        for worker in pool:
            worker.stop()


class WorkerDied(Exception):  # noqa: N818 - it reads as the fact that it reports, also in records.
    """Raised in the parent when a worker vanished in the middle of a unit."""


class WorkerProcess:
    """A worker as its parent sees it.

    Attributes:
        unit: What it is driving, or None.
    """

    def __init__(self, job: Job, preload: Sequence[str]) -> None:
        """Start the process."""
        context = _context(preload)
        self.connection, theirs = context.Pipe()
        self.unit: Unit | None = None
        self._process = context.Process(target=drive_units, args=(theirs, job), daemon=True, name="codriving-worker")
        with without_main():
            self._process.start()
        theirs.close()

    def send(self, unit: Unit) -> None:
        """Hand out a unit; a worker that is dead is noticed by ``receive``."""
        self.unit = unit
        with suppress(OSError):
            self.connection.send(unit)

    def receive(self) -> Report:
        """Take the report of the unit."""
        try:
            answer = self.connection.recv()
        except (EOFError, OSError):
            self._process.join()
            code = self._process.exitcode or 0
            how = f"was killed by signal {-code}" if code < 0 else f"ended with exit code {code}"
            raise WorkerDied(f"the process that drove this episode {how}") from None
        self.unit = None
        if isinstance(answer, UserError):
            raise answer
        assert isinstance(answer, Report)
        return answer

    def stop(self) -> None:
        """End the process, whatever it is doing, and free what it held."""
        self.connection.close()
        self._process.terminate()
        self._process.join()
        self._process.close()


def _context(preload: Sequence[str]) -> ForkServerContext | SpawnContext:
    """The way to start processes: forked from a clean server; spawned where there is none (Windows)."""
    if "forkserver" not in multiprocessing.get_all_start_methods():
        return multiprocessing.get_context("spawn")
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload([__name__, *preload])
    try:
        # Ctrl-C reaches neither the server, even in its imports, nor a worker.
        with uninterrupted(), without_main():
            multiprocessing.forkserver.ensure_running()
    except OSError as error:
        # The server is spoken to by a socket in the folder for temporary files, whose path has 107 bytes at most.
        raise RunFolderError(
            f"cannot start worker processes in the folder for temporary files {tempfile.gettempdir()} ({error}); set "
            "TMPDIR to another folder with a short path, or launcher=serial"
        ) from error
    return context


@contextmanager
def uninterrupted() -> Iterator[None]:
    """Keep Ctrl-C from what is started meanwhile, and from what that starts: a mask outlives fork and exec."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    # The tracker unblocks SIGINT when it starts, so it has to be there before.
    multiprocessing.resource_tracker.ensure_running()
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)


@contextmanager
def without_main() -> Iterator[None]:
    """Keep workers from importing the caller's script again."""
    main = sys.modules["__main__"]
    sys.modules["__main__"] = types.ModuleType("__main__")
    try:
        yield
    finally:
        sys.modules["__main__"] = main


def drive_units(connection: Connection, job: Job) -> None:
    """Drive units until there are no more: the main function of a worker process."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_die_with_parent, daemon=True).start()
    worker = Worker(job)
    while True:
        try:
            unit = connection.recv()
        except (EOFError, OSError):
            return
        answer: Report | UserError
        try:
            answer = worker.run(unit)
        except UserError as error:
            answer = error
        connection.send(answer)


def _die_with_parent() -> None:
    """Wait for the parent's end, however it comes, and go at once: an orphan would write into a resumed run."""
    if (parent := multiprocessing.parent_process()) is not None:
        wait([parent.sentinel])
    os._exit(1)
