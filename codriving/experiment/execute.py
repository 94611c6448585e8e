"""A plan to a finished run folder: what is missing is driven, what is there is kept, tables are made from records."""

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from codriving.datatypes.outcome import Ending
from codriving.datatypes.record import EpisodeRecord
from codriving.errors import ModelError
from codriving.experiment.asking import Asked
from codriving.experiment.cells import Cell
from codriving.experiment.episodes.job import Job, Report
from codriving.experiment.episodes.progress import Progress, Silent
from codriving.experiment.episodes.unit import Objects, Unit
from codriving.experiment.film import FilmEpisode
from codriving.experiment.further import Driven, Further
from codriving.experiment.keep import KeepEpisode
from codriving.experiment.plan import Plan
from codriving.experiment.remembering import growing
from codriving.experiment.shares import run_shares
from codriving.experiment.stopping import HaltedError, Interrupted
from codriving.reports.columns import table
from codriving.reports.paper import Paper
from codriving.reports.printed import PrintedTable
from codriving.reports.results import CellResults
from codriving.reports.run_tables import RunTables, run_tables
from codriving.reports.timing import TimedEpisode, seconds_per_decision, timing_columns
from codriving.runs.atomic import write_text
from codriving.runs.continuation import changed_versions
from codriving.runs.episode_folder import Timing, read_timing
from codriving.runs.manifest import FORMAT, MANIFEST, CellEntry, Manifest
from codriving.runs.provenance import commit, machine, versions
from codriving.runs.redaction import variables_in
from codriving.runs.run_folder import RunFolder, new_run_path, unwritable


@dataclass(frozen=True, slots=True)
class Finished:
    """A run that is complete."""

    folder: Path
    tables: RunTables
    driven: int
    kept: int
    failed: tuple[Report, ...]
    further: int = 0
    changed: tuple[str, ...] = ()
    filmed: int = 0
    unfilmed: tuple[Unit, ...] = ()
    extra: Further = field(default_factory=Further)

    @property
    def displays(self) -> tuple[PrintedTable, ...]:
        """What is printed."""
        return self.extra.displays or (self.tables.printed,)


def execute(
    plan: Plan,
    build: Callable[[Mapping[str, Mapping[str, Any]]], Callable[[str], Objects]],
    preload: Sequence[str] = (),
    paper: Paper | None = None,
    progress: Callable[[Mapping[str, int], Callable[[], str] | None], AbstractContextManager[Progress]] = (
        lambda units, note: nullcontext(Silent())
    ),
    extend: Callable[[Driven], Further] = lambda _: Further(),
) -> Finished:
    """Run a plan, or what is left of it.

    Raises:
        UserError: If the folder cannot be used, the objects cannot be built or a language model cannot be reached.
        HaltedError: If the language model must not be used any more; finished episodes are kept.
        Interrupted: If the user stops it; finished episodes are kept.
    """
    is_new = plan.run is None or not (plan.output / plan.experiment / plan.run / MANIFEST).exists()
    if is_new:
        # Before the folder is made: a model that cannot be reached leaves nothing behind.
        Asked(plan.cells).preflight()
    configs = {cell.folder: cell.config_text for cell in plan.cells}
    asked = _manifest(plan)
    with RunFolder(_path(plan), asked, configs) as folder:
        # A cell that is there already keeps its folder, whatever it would be called in this run.
        cells = [replace(cell, folder=name) for cell, name in zip(plan.cells, folder.manifest.rows, strict=True)]
        entries = tuple(cell.entry() for cell in cells)
        records = _records(folder, entries, plan.seeds, {})
        # One batch of all cells: nobody waits for the last episode of a cell.
        units = [Unit(cell.folder, seed) for cell in cells for seed in plan.seeds]
        missing = [unit for unit in units if unit not in records]
        film = FilmEpisode(folder.path, {entry.folder: entry for entry in entries}) if plan.render else None
        unfilmed = [unit for unit in units if film and unit in records and film.lacks(unit)]
        resolved = {cell.folder: growing(cell.resolved, folder.path, cell.folder) for cell in cells}
        keep = KeepEpisode(folder.path, variables_in([cell.resolved for cell in cells]))
        job = Job({cell.folder: cell.labels for cell in cells}, build(resolved), keep, film)
        failed: tuple[Report, ...] = ()
        todo = missing + unfilmed
        incomplete = {unit.cell for unit in missing}
        models = Asked(cell for cell in cells if cell.folder in incomplete)
        if not is_new:
            models.preflight()
        try:
            if todo:
                with progress(Counter(unit.cell for unit in todo), models.usage if models.models else None) as display:
                    failed = run_shares(missing, unfilmed, job, plan, models, preload, display)
        except KeyboardInterrupt:
            finished = len(_records(folder, entries, plan.seeds, records))
            raise Interrupted(folder.path, finished, len(units)) from None
        except ModelError as error:
            finished = len(_records(folder, entries, plan.seeds, records))
            raise HaltedError(error, folder.path, finished, len(units)) from error
        finally:
            folder.clean()
        everything = _records(folder, entries, plan.seeds, records, errors=True)
        rows = [[everything[Unit(cell.folder, seed)] for seed in plan.seeds] for cell in cells]
        driven = Driven(cells, rows, _timings(folder, cells, rows), folder.path)
        tables = _tables(plan, driven, paper or Paper())
        extra = extend(driven)
        _write(folder, tables, _timing_table(driven), extra)
        kept = len(units) - len(missing)
        changed = changed_versions(folder.manifest, asked) if kept and missing else ()
        further, filmed = folder.further(plan.seeds), sum(film.path(unit).exists() for unit in todo) if film else 0
        lacking = tuple(unit for unit in units if film and film.lacks(unit))
        return Finished(folder.path, tables, len(missing), kept, failed, further, changed, filmed, lacking, extra)


def _path(plan: Plan) -> Path:
    experiment = plan.output / plan.experiment
    return experiment / plan.run if plan.run else new_run_path(experiment, datetime.now())


def _manifest(plan: Plan) -> Manifest:
    return Manifest(
        format=FORMAT,
        experiment=plan.experiment,
        created=datetime.now(UTC).isoformat(timespec="seconds"),
        first_seed=plan.first_seed,
        episodes=plan.episodes,
        rows=tuple(cell.folder for cell in plan.cells),
        cells=tuple(cell.entry() for cell in plan.cells),
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


def _tables(plan: Plan, driven: Driven, paper: Paper) -> RunTables:
    cells = [
        CellResults(records, cell.swept, seconds_per_decision(timings), metric=cell.metrics)
        for cell, records, timings in zip(driven.cells, driven.records, driven.timings, strict=True)
    ]
    return run_tables(cells, paper, driven.metrics, plan.notes)


def _timings(
    folder: RunFolder, cells: Sequence[Cell], rows: Sequence[Sequence[EpisodeRecord]]
) -> list[list[Timing | None]]:
    return [
        [read_timing(folder.episode(cell.folder, record.seed)) for record in records]
        for cell, records in zip(cells, rows, strict=True)
    ]


def _timing_table(driven: Driven) -> str:
    timed = [
        TimedEpisode(record, timing, cell.swept)
        for cell, records, timings in zip(driven.cells, driven.records, driven.timings, strict=True)
        for record, timing in zip(records, timings, strict=True)
    ]
    return table(timing_columns(driven.cells[0].swept), timed).csv()


def _write(folder: RunFolder, tables: RunTables, timing: str, extra: Further) -> None:
    try:
        tables.write(folder.path)
        extra.write(folder.path)
        write_text(folder.path / "timing.csv", timing)
    except OSError as error:
        raise unwritable(folder.path, error) from error
