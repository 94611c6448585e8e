"""A batch: many units, wherever they are driven, counted as they end."""

from collections.abc import Callable, Sequence
from contextlib import closing
from dataclasses import dataclass

from codriving.datatypes.outcome import Ending
from codriving.experiment.episodes.job import Job, Report
from codriving.experiment.episodes.launcher import Launcher
from codriving.experiment.episodes.progress import Progress, Silent
from codriving.experiment.episodes.unit import Unit


@dataclass(frozen=True, slots=True)
class BatchReport:
    """What became of a batch."""

    done: int
    failed: tuple[Report, ...]


def run_batch(
    units: Sequence[Unit],
    job: Job,
    launcher: Launcher,
    workers: int | str = 1,
    preload: Sequence[str] = (),
    progress: Progress | None = None,
    watch: Callable[[Report], None] = lambda report: None,
) -> BatchReport:
    """Drive a batch; results are kept by the job, this only counts.

    Args:
        workers: Number of processes or threads, or ``auto`` for one a core.

    Raises:
        UserError: If the config cannot be built, a result cannot be saved, or a language model cannot be used any more.
        KeyboardInterrupt: After the processes have been ended; what was saved stays.
    """
    progress = progress or Silent()
    failed: list[Report] = []
    done = 0
    with closing(launcher.launch(units, job, workers, preload)) as reports:
        for report in reports:
            done += 1
            if report.ending is Ending.ERROR:
                failed.append(report)
            progress.update(report.unit.cell, report.ending is Ending.ERROR)
            watch(report)
    return BatchReport(done, tuple(sorted(failed, key=lambda r: (r.unit.cell, r.unit.seed))))
