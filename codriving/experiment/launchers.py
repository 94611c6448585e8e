"""Where episodes are driven, on which no result depends: the base class, its check, and this process."""

import os
from abc import ABC, abstractmethod
from collections.abc import Callable, Generator, Sequence
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


class Account:
    """Of what a launcher was given, what it has not reported yet."""

    def __init__(self, units: Sequence[Unit], launcher: Launcher, is_saved: Callable[[Unit], bool]) -> None:
        self._name, self._due, self._is_saved = type(launcher).__name__, dict.fromkeys(units), is_saved
        self._given = len(units)

    def note(self, report: Report) -> None:
        """Cross a unit off.

        Raises:
            LauncherError: If it was not given or has not been saved, or is reported twice.
        """
        if report.unit not in self._due:
            raise LauncherError(
                f"the launcher {self._name} reports {report.unit}, which it was not given or reported before"
            )
        if not self._is_saved(report.unit):
            raise LauncherError(f"the launcher {self._name} reports {report.unit}, which it has not saved")
        del self._due[report.unit]

    def close(self) -> None:
        """Refuse an account in which units are left.

        Raises:
            LauncherError: If any are.
        """
        if self._due:
            rest = f" and {len(self._due) - NAMED} more" if len(self._due) > NAMED else ""
            shown = ", ".join(map(str, list(self._due)[:NAMED])) + rest
            raise LauncherError(
                f"the launcher {self._name} has lost {len(self._due)} of {self._given} episodes: {shown}"
            )


def worker_count(workers: int | str, units: int) -> int:
    """Return how many workers to use, at least 1."""
    return max(1, min(available_cores() if workers == "auto" else int(workers), units))


def available_cores() -> int:
    """Return the number of cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
