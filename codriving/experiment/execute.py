"""A plan to a finished run folder: what is missing is driven, what is there is kept, tables are made from records."""

from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from codriving.datatypes.outcome import Ending
from codriving.datatypes.record import EpisodeRecord
from codriving.episodes.batch import run_batch
from codriving.episodes.job import Job, Report
from codriving.episodes.progress import Progress, Silent
from codriving.episodes.unit import Objects, Unit
from codriving.experiment.keep import KeepEpisode
from codriving.experiment.plan import Plan
from codriving.reports.paper import Paper
from codriving.reports.rows import csv_text
from codriving.reports.run_tables import RunTables, run_tables, write_tables
from codriving.reports.timing_table import COLUMNS as TIMING_COLUMNS
from codriving.reports.timing_table import timing_rows
from codriving.storage.atomic import write_text
from codriving.storage.manifest import FORMAT, CellEntry, Manifest
from codriving.storage.provenance import commit, machine, versions
from codriving.storage.run_folder import RunFolder, new_run_path, unwritable
from codriving.storage.timing import read_timing


@dataclass(frozen=True, slots=True)
class Finished:
    """A run that is complete.

    Attributes:
        folder: The run folder.
        tables: Its tables.
        driven: Episodes driven now.
        kept: Episodes that were there already.
        failed: Those that ended in an error.
    """

    folder: Path
    tables: RunTables
    driven: int
    kept: int
    failed: tuple[Report, ...]


class Interrupted(KeyboardInterrupt):
    """Raised when the user stops a batch, after everything has been put in order."""

    def __init__(self, folder: Path, finished: int, planned: int) -> None:
        """Say what there is.

        Args:
            folder: The run folder.
            finished: Episodes that are kept.
            planned: Episodes of the whole run.
        """
        super().__init__(f"stopped with {finished} of {planned} episodes finished")
        self.folder = folder
        self.finished = finished
        self.planned = planned


def execute(
    plan: Plan,
    build: Callable[[str], Objects],
    preload: Sequence[str] = (),
    paper: Paper | None = None,
    progress: Callable[[int], AbstractContextManager[Progress]] = lambda _: nullcontext(Silent()),
) -> Finished:
    """Run a plan, or what is left of it.

    Args:
        plan: What to run.
        build: Builds the objects of a cell from the name of its folder; picklable.
        preload: Modules imported once for all processes.
        paper: The paper's numbers, to stand beside ours.
        progress: Opens a display of the progress of so many units.

    Returns:
        The finished run.

    Raises:
        UserError: If the folder cannot be used or the objects cannot be built.
        Interrupted: If the user stops it; finished episodes are kept.
    """
    entries = tuple(cell.entry() for cell in plan.cells)
    with RunFolder(_path(plan), _manifest(plan, entries), plan.config_text) as folder:
        records = _records(folder, entries, plan.seeds, {})
        units = [Unit(cell.folder, seed) for cell in entries for seed in plan.seeds]
        missing = [unit for unit in units if unit not in records]
        job = Job({cell.folder: cell.labels for cell in plan.cells}, build, KeepEpisode(folder.path))
        failed: tuple[Report, ...] = ()
        try:
            if missing:
                with progress(len(missing)) as display:
                    failed = run_batch(missing, job, plan.launcher, plan.workers, preload, display).failed
        except KeyboardInterrupt:
            finished = len(_records(folder, entries, plan.seeds, records))
            raise Interrupted(folder.path, finished, len(units)) from None
        finally:
            folder.clean()
        everything = _records(folder, entries, plan.seeds, records, errors=True)
        tables = run_tables(
            [[everything[Unit(c.folder, seed)] for seed in plan.seeds] for c in entries],
            paper or Paper(),
            ", ".join(dict.fromkeys(cell.metrics for cell in plan.cells)),
        )
        _write(folder, tables, [(unit, everything[unit]) for unit in units])
        return Finished(folder.path, tables, len(missing), len(units) - len(missing), failed)


def _path(plan: Plan) -> Path:
    experiment = plan.output / plan.experiment
    return experiment / plan.run if plan.run else new_run_path(experiment, datetime.now())


def _manifest(plan: Plan, entries: tuple[CellEntry, ...]) -> Manifest:
    return Manifest(
        format=FORMAT,
        experiment=plan.experiment,
        created=datetime.now(UTC).isoformat(timespec="seconds"),
        first_seed=plan.first_seed,
        episodes=plan.episodes,
        cells=entries,
        versions=versions(),
        commit=commit(),
        machine=machine(),
    )


def _records(
    folder: RunFolder,
    entries: Sequence[CellEntry],
    seeds: Sequence[int],
    known: dict[Unit, EpisodeRecord],
    errors: bool = False,
) -> dict[Unit, EpisodeRecord]:
    """Read the records that are not known yet; failed episodes only if asked for, since they are to be driven again."""
    found = dict(known)
    for cell in entries:
        for seed in seeds:
            unit = Unit(cell.folder, seed)
            if unit in found:
                continue
            record = folder.record(cell, seed)
            if record is not None and (errors or record.outcome.ending is not Ending.ERROR):
                found[unit] = record
    return found


def _write(folder: RunFolder, tables: RunTables, records: Sequence[tuple[Unit, EpisodeRecord]]) -> None:
    timed = [(record, read_timing(folder.episode(unit.cell, unit.seed))) for unit, record in records]
    try:
        write_tables(tables, folder.path)
        write_text(folder.path / "timing.csv", csv_text(TIMING_COLUMNS, timing_rows(timed)))
    except OSError as error:
        raise unwritable(folder.path, error) from error
