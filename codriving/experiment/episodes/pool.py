"""Units over worker processes: each gets the next one when it is free; a dead one is replaced."""

import os
from collections import Counter, deque
from collections.abc import Generator, Sequence
from multiprocessing.connection import wait

from codriving.experiment.episodes.job import Job, Report, Worker
from codriving.experiment.episodes.process import WorkerDied, WorkerProcess
from codriving.experiment.episodes.unit import Unit

ATTEMPTS = 2
"""How often a unit may take its process down: once can be the machine's fault, twice is the unit's."""


def available_cores() -> int:
    """Give the number of cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def run_serial(units: Sequence[Unit], job: Job) -> Generator[Report, None, None]:
    """Drive units one after another in this process.

    Raises:
        UserError: If the batch has to stop.
    """
    worker = Worker(job)
    for unit in units:
        yield worker.run(unit)


def run_parallel(
    units: Sequence[Unit], job: Job, workers: int, preload: Sequence[str]
) -> Generator[Report, None, None]:
    """Drive units in several processes.

    When the iterator is closed, by an exception or otherwise, the processes are ended and units in flight are lost.

    Raises:
        UserError: If the batch has to stop.
    """
    waiting = deque(units)
    deaths: Counter[Unit] = Counter()
    pool: list[WorkerProcess] = []
    try:
        while waiting or any(worker.unit for worker in pool):
            while waiting and len(pool) < workers:
                worker = WorkerProcess(job, preload)
                pool.append(worker)
                worker.give(waiting.popleft())
            busy = {worker.connection: worker for worker in pool if worker.unit}
            for ready in wait(list(busy)):
                worker = next(w for c, w in busy.items() if c is ready)
                unit = worker.unit
                assert unit is not None
                try:
                    report = worker.take()
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
                        worker.give(waiting.popleft())
                yield report
    finally:
        for worker in pool:
            worker.stop()
