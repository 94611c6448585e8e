"""Where episodes are driven: the base class, and this process; results do not depend on it."""

import os
from abc import ABC, abstractmethod
from collections.abc import Generator, Sequence
from typing import ClassVar

from codriving.datatypes import EpisodeLauncher
from codriving.experiment.worker import Job, Report, Unit, Worker
from codriving.runs import Manifest


class Launcher(EpisodeLauncher, ABC):
    """Drives units somewhere; results are saved by the job, so they do not depend on where."""

    drives: ClassVar[bool] = True  # Whether models and memories are needed; not where episodes are there already

    def noted(self, manifest: Manifest) -> Manifest:
        """Note in the manifest of a new run by what its episodes are driven, if not by this program here."""
        return manifest

    def prepare(self, workers: int | str, units: int, preload: Sequence[str]) -> None:
        """Get ready in the background."""
        return None

    @abstractmethod
    def launch(
        self, units: Sequence[Unit], job: Job, workers: int | str, preload: Sequence[str]
    ) -> Generator[Report, None, None]:
        """Drive units.

        When the iterator is closed, by an exception or otherwise, units in flight are lost.
        """


class Serial(Launcher):
    """One after another in this process, for debugging and profiling; ``workers`` has no meaning here."""

    def launch(
        self, units: Sequence[Unit], job: Job, workers: int | str = 1, preload: Sequence[str] = ()
    ) -> Generator[Report, None, None]:
        yield from map(Worker(job).run, units)


def worker_count(workers: int | str, units: int) -> int:
    """Return how many workers to use, at least 1."""
    return max(1, min(available_cores() if workers == "auto" else int(workers), units))


def available_cores() -> int:
    """Return the number of cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
