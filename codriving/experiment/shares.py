"""One batch in shares: who computes in processes, who waits for a language model in threads, who learns in order."""

from collections.abc import Sequence

from codriving.experiment.asking import Asked
from codriving.experiment.episodes.batch import run_batch
from codriving.experiment.episodes.failures import FailuresInARow
from codriving.experiment.episodes.job import Job, Report
from codriving.experiment.episodes.launcher import Launcher, Processes, Serial
from codriving.experiment.episodes.progress import Progress
from codriving.experiment.episodes.threads import Threads
from codriving.experiment.episodes.unit import Unit
from codriving.experiment.plan import Plan
from codriving.experiment.remembering import learns


def run_shares(
    missing: Sequence[Unit],
    unfilmed: Sequence[Unit],
    job: Job,
    plan: Plan,
    asked: Asked,
    preload: Sequence[str],
    progress: Progress,
) -> tuple[Report, ...]:
    """Drive a batch.

    Episodes whose method asks no language model are driven as the plan says. Those that ask one wait for its server
    nearly all the time, and share one client with its limits: they are driven in threads of this process, as many at
    once as requests may be under way, unless the plan says otherwise than in processes. Episodes that learn from one
    another come one after the other, each cell in the order of its seeds.

    Returns:
        Reports of those that ended in an error, by cell and seed.

    Raises:
        UserError: If the batch has to stop.
        KeyboardInterrupt: If the user stops it; what was saved stays.
    """
    in_order = {cell.folder for cell in plan.cells if learns(cell.resolved)} & {unit.cell for unit in missing}
    learning = [unit for unit in missing if unit.cell in in_order]
    independent = [unit for unit in missing if unit.cell not in in_order]
    waiting = [unit for unit in independent if unit.cell in asked.models]
    computing = [*(unit for unit in independent if unit.cell not in asked.models), *unfilmed]
    failed: list[Report] = []
    if learning:
        watch = FailuresInARow(asked.names, asked.patience)
        failed += run_batch(learning, job, Serial(), 1, preload, progress, watch.note).failed
    if computing:
        failed += run_batch(computing, job, plan.launcher, plan.workers, preload, progress).failed
    if waiting:
        watch = FailuresInARow(asked.names, asked.patience)
        launcher: Launcher = Threads() if isinstance(plan.launcher, Processes) else plan.launcher
        threads = side_by_side(plan.workers, asked.concurrency)
        failed += run_batch(waiting, job, launcher, threads, preload, progress, watch.note).failed
    return tuple(sorted(failed, key=lambda report: (report.unit.cell, report.unit.seed)))


def side_by_side(workers: int | str, concurrency: int) -> int:
    """Give the number of episodes that ask a language model to drive at once.

    Args:
        workers: A number, or ``auto`` for as many as requests may be under way.
    """
    return concurrency if workers == "auto" else min(int(workers), concurrency)
