"""Where episodes are driven: here one after another, or in several processes of this machine."""

from abc import ABC, abstractmethod
from collections.abc import Generator, Sequence

from codriving.experiment.episodes.job import Job, Report
from codriving.experiment.episodes.pool import available_cores, run_parallel, run_serial
from codriving.experiment.episodes.process import warm
from codriving.experiment.episodes.unit import Unit


class Launcher(ABC):
    """Drives units somewhere; results are kept by the job, so they do not depend on where."""

    def prepare(self, workers: int | str, units: int, preload: Sequence[str]) -> None:
        """Get ready in the background.

        Args:
            workers: A number, or ``auto`` for one a core.
        """
        return None

    @abstractmethod
    def launch(
        self, units: Sequence[Unit], job: Job, workers: int | str, preload: Sequence[str]
    ) -> Generator[Report, None, None]:
        """Drive units.

        Args:
            workers: A number, or ``auto`` for one a core.

        Raises:
            UserError: If the batch has to stop.
        """


class Serial(Launcher):
    """One after another in this process, for debugging and profiling."""

    def launch(
        self, units: Sequence[Unit], job: Job, workers: int | str, preload: Sequence[str]
    ) -> Generator[Report, None, None]:
        """Drive units; ``workers`` has no meaning here.

        Raises:
            UserError: If the batch has to stop.
        """
        yield from run_serial(units, job)


class Processes(Launcher):
    """In several processes of this machine; a single one is this process itself."""

    def prepare(self, workers: int | str, units: int, preload: Sequence[str]) -> None:
        """Start importing, which takes longer than anything else before the first step.

        Args:
            workers: A number, or ``auto`` for one a core.
        """
        if worker_count(workers, units) > 1:
            warm(preload)

    def launch(
        self, units: Sequence[Unit], job: Job, workers: int | str, preload: Sequence[str]
    ) -> Generator[Report, None, None]:
        """Drive units.

        Args:
            workers: A number, or ``auto`` for one a core.

        Raises:
            UserError: If the batch has to stop.
        """
        processes = worker_count(workers, len(units))
        if processes == 1:
            yield from run_serial(units, job)
        else:
            yield from run_parallel(units, job, processes, preload)


def worker_count(workers: int | str, units: int) -> int:
    """Give the number of processes to use.

    Args:
        workers: A number, or ``auto`` for one a core that this process may use.

    Returns:
        At least 1.
    """
    wanted = available_cores() if workers == "auto" else int(workers)
    return max(1, min(wanted, units))
