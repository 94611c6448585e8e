"""One worker process and its lifeline: it ignores Ctrl-C and dies with its parent."""

import multiprocessing
import multiprocessing.forkserver
import multiprocessing.resource_tracker
import os
import signal
import sys
import threading
import types
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from multiprocessing.connection import Connection, wait
from multiprocessing.context import ForkServerContext, SpawnContext

from codriving.errors import UserError
from codriving.experiment.episodes.job import Job, Report, Worker
from codriving.experiment.episodes.unit import Unit


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
        self._process = context.Process(target=serve, args=(theirs, job), daemon=True, name="codriving-worker")
        with _without_main():
            self._process.start()
        theirs.close()

    def give(self, unit: Unit) -> None:
        """Hand out a unit; a worker that is dead is noticed by ``take``."""
        self.unit = unit
        with suppress(OSError):
            self.connection.send(unit)

    def take(self) -> Report:
        """Take the report of the unit.

        Raises:
            WorkerDied: If the process is gone.
            UserError: If the batch has to stop.
        """
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


def warm(preload: Sequence[str]) -> None:
    """Start importing heavy modules in the background, so that workers are ready when they are wanted."""
    _context(preload)


def _context(preload: Sequence[str]) -> ForkServerContext | SpawnContext:
    """The way to start processes: forked from a clean server; spawned where there is none (Windows)."""
    if "forkserver" not in multiprocessing.get_all_start_methods():
        return multiprocessing.get_context("spawn")
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(list(preload))
    # The tracker unblocks SIGINT when it starts, so it has to be there before.
    multiprocessing.resource_tracker.ensure_running()
    # A mask outlives fork and exec: with it, Ctrl-C reaches neither the server, even in its imports, nor a worker.
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        with _without_main():
            multiprocessing.forkserver.ensure_running()
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)
    return context


@contextmanager
def _without_main() -> Iterator[None]:
    """Keep workers from importing the caller's script again."""
    main = sys.modules["__main__"]
    sys.modules["__main__"] = types.ModuleType("__main__")
    try:
        yield
    finally:
        sys.modules["__main__"] = main


def serve(connection: Connection, job: Job) -> None:
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
    parent = multiprocessing.parent_process()
    if parent is not None:
        wait([parent.sentinel])
    os._exit(1)
