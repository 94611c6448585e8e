"""Units over threads of this process: episodes side by side that wait for a language model nearly all the time."""

from collections import deque
from collections.abc import Generator, Sequence
from dataclasses import replace
from queue import Empty, SimpleQueue
from threading import Event, Lock, Thread

from codriving.experiment.episode import EpisodeResult
from codriving.experiment.launchers import Launcher, worker_count
from codriving.experiment.worker import Job, Objects, Report, Unit, Worker

POLL = 0.5  # How long to wait before looking again [s]; where Ctrl-C does not end a wait, it is noticed after this


class Threads(Launcher):
    """In several threads of this process, which share one client of the language model and its limits.

    When the iterator is closed, nothing more is saved: an episode in flight ends before its next decision and is lost.
    That is not waited for, since it may be waiting for a server.
    """

    asks = True

    def launch(
        self, units: Sequence[Unit], job: Job, workers: int | str, preload: Sequence[str]
    ) -> Generator[Report, None, None]:
        saved = [unit for unit in units if job.saved(unit) is not None]
        batch = _Batch([unit for unit in units if unit not in set(saved)], job)
        try:
            batch.start(worker_count(workers, len(units)))
            yield from map(Worker(job).run, saved)
            for _ in range(batch.units):
                report = batch.next_report()
                if job.after:
                    job.after.finish(report.unit)
                yield report
            for thread in batch.threads:
                thread.join()
        finally:
            batch.stop()


class Abandoned(BaseException):
    """Raised in a thread whose batch has stopped: its episode is neither finished nor failed."""


class _Batch:
    """The threads of one batch and what they share."""

    def __init__(self, units: Sequence[Unit], job: Job) -> None:
        self.units, self._job, self._waiting = len(units), job, deque(units)
        self._news: SimpleQueue[Report | BaseException] = SimpleQueue()
        self._building, self._saving, self._stopped = Lock(), Lock(), Event()
        self.threads: list[Thread] = []

    def start(self, threads: int) -> None:
        """Begin; a process that ends does not wait for them."""
        own = replace(self._job, build=self._build, save=self._save, after=None)
        for number in range(min(threads, self.units)):
            worker = Worker(own, self._go_on)
            thread = Thread(target=self._work, args=(worker,), daemon=True, name=f"codriving-episode-{number}")
            self.threads.append(thread)
            thread.start()

    def next_report(self) -> Report:
        """Wait for the next report."""
        while True:
            try:
                news = self._news.get(timeout=POLL)
            except Empty:
                continue
            if isinstance(news, BaseException):
                raise news
            return news

    def stop(self) -> None:
        """Let nothing more be saved; what is being saved is saved whole."""
        with self._saving:
            self._stopped.set()

    def _work(self, worker: Worker) -> None:
        try:
            while (unit := self._next()) is not None:
                self._news.put(worker.run(unit))
        except Abandoned:
            return
        except BaseException as error:
            self._news.put(error)

    def _next(self) -> Unit | None:
        """Take the next unit; None if there is none, also if another thread has just taken the last one."""
        self._go_on()
        try:
            return self._waiting.popleft()
        except IndexError:
            return None

    def _go_on(self) -> None:
        if self._stopped.is_set():
            raise Abandoned

    def _build(self, cell: str) -> Objects:
        # One at a time: they import modules, and work out a road that they then share.
        with self._building:
            self._go_on()
            return self._job.build(cell)

    def _save(self, unit: Unit, result: EpisodeResult) -> None:
        with self._saving:
            self._go_on()
            self._job.save(unit, result)
