"""Where episodes are driven, on which no result depends: the base class, its check, and this process."""

import os
from abc import ABC, abstractmethod
from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from typing import ClassVar

from codriving.datatypes import EpisodeLauncher
from codriving.errors import LauncherError
from codriving.experiment.worker import Job, Report, Unit, Worker
from codriving.runs import Manifest

NAMED = 3  # Units that a message names


class Launcher(EpisodeLauncher, ABC):
    """Drives units somewhere; results are saved by the job, so they do not depend on where."""

    drives: ClassVar[bool] = True  # Whether models and memories are needed; not where episodes are there already
    asks: ClassVar[bool] = False  # Whether it drives what asks a language model, all in this process; else threads do
    elsewhere: ClassVar[bool] = False  # Whether it may drive on other machines, where no server is asked

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
        """Drive units, and report each once it is saved.

        When the iterator is closed, by an exception or otherwise, units in flight are lost.
        """


class Serial(Launcher):
    """One after another in this process, for debugging and profiling; ``workers`` has no meaning here."""

    asks = True

    def launch(
        self, units: Sequence[Unit], job: Job, workers: int | str = 1, preload: Sequence[str] = ()
    ) -> Generator[Report, None, None]:
        yield from map(Worker(job).run, units)


def accounted(
    reports: Iterable[Report], units: Sequence[Unit], launcher: Launcher, is_saved: Callable[[Unit], bool]
) -> Iterator[Report]:
    """Pass on what a launcher reports, as long as it is about what it was given.

    Raises:
        LauncherError: If it reports a unit that it was not given or has not saved, or one twice, or loses any.
    """
    name, due = type(launcher).__name__, dict.fromkeys(units)
    for report in reports:
        if report.unit not in due:
            raise LauncherError(f"the launcher {name} reports {report.unit}, which it was not given or reported before")
        if not is_saved(report.unit):
            raise LauncherError(f"the launcher {name} reports {report.unit}, which it has not saved")
        del due[report.unit]
        yield report
    if due:
        shown = ", ".join(map(str, list(due)[:NAMED])) + (f" and {len(due) - NAMED} more" if len(due) > NAMED else "")
        raise LauncherError(f"the launcher {name} has lost {len(due)} of {len(units)} episodes: {shown}")


def worker_count(workers: int | str, units: int) -> int:
    """Return how many workers to use, at least 1."""
    return max(1, min(available_cores() if workers == "auto" else int(workers), units))


def available_cores() -> int:
    """Return the number of cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
