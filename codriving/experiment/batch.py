"""A plan to a finished run folder: what is missing is driven, what is there is kept, tables are made from records."""

import sys
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import closing, contextmanager
from dataclasses import dataclass, field, fields, replace
from datetime import UTC, datetime
from functools import partial
from pathlib import Path
from signal import SIGINT
from typing import Any, TypeAlias

from codriving.config import experiments_dir, show
from codriving.datatypes import Ending, EpisodeRecord
from codriving.errors import ConfigError, DamagedEpisodeError, LauncherError, MemoryFileError, ModelError, UserError
from codriving.experiment.as_in_paper import results_of
from codriving.experiment.asking import Asked
from codriving.experiment.cells import Cell, with_metrics
from codriving.experiment.film import FilmEpisode
from codriving.experiment.flows import is_flow
from codriving.experiment.launchers import Account
from codriving.experiment.objects import BuildObjects, given_back, modules_to_preload
from codriving.experiment.places import FailuresInARow, places
from codriving.experiment.plan import Plan
from codriving.experiment.progress import show_progress
from codriving.experiment.remembering import growing, merged_notes, prepare
from codriving.experiment.scoring import scored
from codriving.experiment.stopping import StopSignal, stopped_by_signals
from codriving.experiment.worker import Job, Objects, Report, SaveEpisode, Unit
from codriving.reports import (
    PrintedTable,
    RunTables,
    Table,
    TimedEpisode,
    flow_tables,
    read_paper,
    run_tables,
    table,
    timing_columns,
)
from codriving.runs import (
    BEHAVIOUR,
    FORMAT,
    MANIFEST,
    RECORD,
    Manifest,
    RunFolder,
    Timing,
    changed_versions,
    commit,
    machine,
    new_run_path,
    only_old_world,
    read_timing,
    redact,
    removed,
    unwritable,
    variables_in,
    versions,
    whole_file,
    write_part,
    write_text,
)


class Interrupted(KeyboardInterrupt):
    """Raised when the user or the system stops a batch, after everything has been put in order."""

    def __init__(self, folder: Path, finished: int, planned: int, signal: int = SIGINT) -> None:
        super().__init__(f"stopped with {finished} of {planned} episodes finished")
        self.folder, self.finished, self.planned, self.signal = folder, finished, planned, int(signal)


class HaltedError(ModelError):
    """Raised when a batch stops since its model, memory or launcher cannot be used; everything is in order."""

    def __init__(self, reason: UserError, folder: Path, finished: int, planned: int) -> None:
        self.text = f"{str(reason).rstrip('.;')}; {finished} of {planned} episodes are finished and kept"
        super().__init__(f"{self.text} in {folder}")
        self.folder = folder


@dataclass(frozen=True, slots=True)
class Driven:
    """All episodes of a run."""

    cells: Sequence[Cell]
    records: Sequence[Sequence[EpisodeRecord]]
    timings: Sequence[Sequence[Timing | None]]  # What each of them cost, None where that is lost
    folder: Path = Path()
    notes: Sequence[str] = ()  # What has to be said of the cells below any table
    config_dir: Path | None = None  # Folder with YAMLs of the user

    @property
    def metrics(self) -> str:
        """Name of the definitions by which they were scored."""
        return ", ".join(dict.fromkeys(cell.metrics for cell in self.cells))

    @property
    def flows(self) -> bool:
        """Whether these are flows."""
        return is_flow(self.cells[0].resolved)


@dataclass(frozen=True, slots=True)
class Outputs:
    """What a command makes of its episodes beyond the tables of every run."""

    files: Mapping[str, bytes] = field(default_factory=dict)  # Content by path below the run folder
    printed: tuple[PrintedTable, ...] = ()  # What is printed in place of the summary
    tables: tuple[Table, ...] = ()
    below: bool = False  # Whether that is printed below the summary

    def write(self, folder: Path) -> None:
        """Write the files, each whole or not at all."""
        for name, content in self.files.items():
            path = folder / name
            path.parent.mkdir(exist_ok=True)
            with whole_file(path, beside=folder) as partial:
                partial.write_bytes(content)


@dataclass(frozen=True, slots=True, kw_only=True)
class Ended:
    """A batch of which nothing is left to drive."""

    folder: Path
    driven: int
    kept: int
    failed: tuple[Report, ...]
    changed: tuple[str, ...] = ()  # Versions that differ between episodes
    filmed: int = 0
    unfilmed: tuple[Unit, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Finished(Ended):
    """A run that is complete, with its tables."""

    tables: RunTables
    left_out: int = 0  # Episodes of the folder that were not asked for
    outputs: Outputs = field(default_factory=Outputs)

    @property
    def printed(self) -> tuple[PrintedTable, ...]:
        """What is printed."""
        own = self.outputs.printed
        return (self.tables.printed, *own) if self.outputs.below or not own else own


# Builds the objects of a cell, whose name it is given, from the configs of all.
_Build: TypeAlias = Callable[[Mapping[str, Mapping[str, Any]]], Callable[[str], Objects]]


def drive(
    plan: Plan, make_outputs: Callable[[Driven], Outputs] = lambda _: Outputs(), build: _Build | None = None
) -> Finished:
    """Drive a plan, or what is missing of it, with a progress display; prints no table."""
    if plan.shard:
        raise ConfigError("a shard has no tables that could be given back; drive it with codriving run, or all of it")
    with driving(plan, build) as batch:
        return batch.finished(plan, make_outputs)


@dataclass(frozen=True, slots=True)
class _DrivenBatch:
    """What has been driven, in a folder that is still locked."""

    folder: RunFolder
    shown: Sequence[Cell]  # The rows of the table
    resolved: Mapping[str, Mapping[str, Any]]  # Config of each cell with the metrics of all its rows
    records: Mapping[Unit, EpisodeRecord]
    ended: Ended

    def finished(self, plan: Plan, make_outputs: Callable[[Driven], Outputs]) -> Finished:
        """Make the tables, and what a command makes beyond them."""
        rows = self.rows(plan.seeds)
        timings = [
            [read_timing(self.folder.episode(cell.folder, record.seed)) for record in row]
            for cell, row in zip(self.shown, rows, strict=True)
        ]
        driven = Driven(self.shown, rows, timings, self.folder.path, plan.notes, plan.config_dir)
        outputs = make_outputs(driven)
        tables = _write(plan, driven, outputs)
        ended = {item.name: getattr(self.ended, item.name) for item in fields(self.ended)}
        return Finished(**ended, tables=tables, left_out=self.folder.left_out(plan.seeds), outputs=outputs)

    def rows(self, seeds: Sequence[int]) -> list[list[EpisodeRecord]]:
        """Give the records of each row, scored by its metrics."""
        by_folder = {
            name: scored([(self.folder.episode(name, seed), self.records[Unit(name, seed)]) for seed in seeds], config)
            for name, config in self.resolved.items()
        }
        return [by_folder[cell.folder] for cell in self.shown]


@contextmanager
def driving(plan: Plan, build: _Build | None = None) -> Iterator[_DrivenBatch]:
    """Drive what is missing of a plan, or of its shard; the folder stays locked for the tables."""
    is_new = plan.folder is None or not (plan.folder / MANIFEST).exists()
    drives = plan.launcher.drives
    found = Asked(plan.cells if drives else ())
    if is_new and drives:
        # Before the folder is made: a model that cannot be reached leaves nothing behind.
        found.preflight()
        prepare(cell.resolved for cell in plan.driven)
        if only_old_world(plan.output) and any(cell.choices.get("limits") != "none" for cell in plan.cells):
            print(_new_world(plan.output), file=sys.stderr)
    asked = plan.launcher.noted(manifest_of(plan, found.served))
    path = plan.folder or new_run_path(plan.output / plan.experiment, datetime.now())
    configs = {cell.folder: show(redact(cell.resolved)) for cell in plan.driven}
    with RunFolder(path, asked, configs, waits=plan.waits, joins=not drives) as folder:
        if plan.part:
            write_part(path, plan.part)
        # A cell that is there already keeps its folder, whatever it would be called in this run.
        names = dict(zip((cell.folder for cell in plan.driven), folder.manifest.rows, strict=True))
        cells = [replace(cell, folder=names[cell.folder]) for cell in plan.driven]
        measured = {cell.folder for cell in folder.manifest.cells if cell.repeatable is False}
        shown = [replace(cell, folder=names[cell.folder]) for cell in plan.cells]
        shown = [replace(cell, repeatable=False if cell.folder in measured else None) for cell in shown]
        damaged: list[DamagedEpisodeError] = []
        # One batch of all cells: no core waits for the last episode of a cell.
        units = [Unit(cells[place].folder, seed) for place, seed in plan.units]
        records = _records(folder, cells, units, damaged=damaged)
        if damaged:
            print(_again(damaged), file=sys.stderr)
        missing = [unit for unit in units if unit not in records]
        film = FilmEpisode(folder.path, {cell.folder: cell.resolved for cell in cells}) if plan.render else None
        unfilmed = [unit for unit in units if film and unit in records and film.lacks(unit)]
        models = Asked(cell for cell in cells if drives and any(unit.cell == cell.folder for unit in missing))
        if not is_new:
            models.preflight()
        resolved = {cell.folder: growing(cell.resolved, folder.path, cell.folder) for cell in cells}
        resolved = {
            name: with_metrics(config, [c for c in shown if c.folder == name]) for name, config in resolved.items()
        }
        prepare(resolved[name] for name in dict.fromkeys(unit.cell for unit in missing if drives))
        save = SaveEpisode(folder.path, variables_in([cell.resolved for cell in cells]))
        job = Job({cell.folder: cell.labels for cell in cells}, (build or BuildObjects)(resolved), save, film)
        preload = [*modules_to_preload(plan.configs.values()), *(["codriving.animation.film"] if film else [])]
        failed: list[Report] = []
        todo = missing + unfilmed
        try:
            usage = models.usage if models.models else None
            with (
                given_back(),
                stopped_by_signals(),
                show_progress(Counter(unit.cell for unit in todo), usage) as update,
            ):
                for part, launcher, workers in places(missing, unfilmed, replace(plan, cells=tuple(cells)), models):
                    failures = FailuresInARow(models.names, models.patience)
                    account = Account(part, launcher, partial(_is_saved, folder))
                    with closing(launcher.launch(part, job, workers, preload)) as reports:
                        for report in reports:
                            account.note(report)
                            if report.ending is Ending.ERROR:
                                failed.append(report)
                            failures.note(report)
                            update(report.unit.cell, report.ending is Ending.ERROR)
                    account.close()
        except (KeyboardInterrupt, ModelError, MemoryFileError, LauncherError) as stop:
            finished = len(_records(folder, cells, units, records, damaged=[]))
            if isinstance(stop, UserError):
                raise HaltedError(stop, folder.path, finished, len(units)) from stop
            number = stop.number if isinstance(stop, StopSignal) else SIGINT
            raise Interrupted(folder.path, finished, len(units), number) from None
        finally:
            models.fall_silent()
            folder.clean()
        for note in merged_notes(resolved[name] for name in dict.fromkeys(unit.cell for unit in missing)):
            print(note, file=sys.stderr)
        models.complain()
        everything = _records(folder, cells, units, records, errors=True)
        if gone := [unit for unit in units if unit not in everything]:
            raise removed(folder.path, f"{len(gone)} of {len(units)} episodes are not there any more")
        kept = len(units) - len(missing)
        ended = Ended(
            folder=folder.path,
            driven=len(missing),
            kept=kept,
            failed=tuple(sorted(failed, key=lambda report: (report.unit.cell, report.unit.seed))),
            changed=_changed(folder.manifest, asked, models.served) if kept and missing else (),
            filmed=sum(film.path(unit).exists() for unit in todo) if film else 0,
            unfilmed=tuple(unit for unit in units if film and film.lacks(unit)),
        )
        yield _DrivenBatch(folder, shown, resolved, everything, ended)


def manifest_of(plan: Plan, served: dict[str, str]) -> Manifest:
    """Describe what is to be run, and with what."""
    return Manifest(
        format=FORMAT,
        behaviour=BEHAVIOUR,
        experiment=plan.experiment,
        created=datetime.now(UTC).isoformat(timespec="seconds"),
        first_seed=plan.first_seed,
        episodes=plan.episodes,
        rows=tuple(cell.folder for cell in plan.driven),
        cells=tuple(cell.entry() for cell in plan.driven),
        versions=versions() | served,
        commit=commit(),
        machine=machine(),
    )


def _changed(there: Manifest, here: Manifest, served: Mapping[str, str]) -> tuple[str, ...]:
    """Compare versions, and what servers call their models where that is known of both times."""
    known = {name: served.get(name, was) for name, was in there.versions.items() if name.startswith("model ")}
    own = {name: version for name, version in here.versions.items() if not name.startswith("model ")}
    return changed_versions(there, replace(here, versions=own | known))


def _is_saved(folder: RunFolder, unit: Unit) -> bool:
    """Whether an episode is there; of a folder that was taken away more is said later."""
    return (folder.episode(unit.cell, unit.seed) / RECORD).exists() or not folder.path.is_dir()


def _records(
    folder: RunFolder,
    cells: Sequence[Cell],
    units: Sequence[Unit],
    known: Mapping[Unit, EpisodeRecord] | None = None,
    errors: bool = False,
    damaged: list[DamagedEpisodeError] | None = None,
) -> dict[Unit, EpisodeRecord]:
    """Read the records that are not known yet; failed episodes only on demand, since they are to be driven again.

    Args:
        damaged: Takes what is wrong with each damaged episode, which then counts as not driven; None lets it be raised.
    """
    found = dict(known or {})
    entries = {cell.folder: cell.entry() for cell in cells}
    for unit in units:
        try:
            record = None if unit in found else folder.record(entries[unit.cell], unit.seed)
        except DamagedEpisodeError as error:
            if damaged is None:
                raise
            damaged.append(error)
            continue
        if record is not None and (errors or record.outcome.ending is not Ending.ERROR):
            found[unit] = record
    return found


def _new_world(output: Path) -> str:
    return (
        f"The runs in {output} are of a release before 0.2. The default world has changed: vehicles have limits "
        "and human drivers differ (limits=road drivers=attentive). suite=paper is the world of before, though not its "
        "methods."
    )


def _again(damaged: Sequence[DamagedEpisodeError]) -> str:
    """Say which episodes are driven although they are there."""
    first = str(damaged[0]).partition("; ")[0]
    more = f", and {len(damaged) - 1} more" if len(damaged) > 1 else ""
    return f"{first}{more}: driven again."


def _write(plan: Plan, driven: Driven, outputs: Outputs) -> RunTables:
    """Write the tables of every run, and what the command adds."""
    each = list(zip(driven.cells, driven.records, driven.timings, strict=True))
    results = [results_of(cell, records, cell.swept) for cell, records, _ in each]
    if driven.flows:
        tables = flow_tables(results, driven.metrics, plan.notes)
    else:
        tables = run_tables(results, read_paper(experiments_dir()), driven.metrics, plan.notes)
    # What was driven once has cost time once, by however many metrics it was scored.
    once = {cell.folder: (cell, records, timings) for cell, records, timings in each}
    timed = [
        TimedEpisode(record, timing, cell.swept)
        for cell, records, timings in once.values()
        for record, timing in zip(records, timings, strict=True)
    ]
    try:
        tables.write(driven.folder)
        outputs.write(driven.folder)
        write_text(driven.folder / "timing.csv", table(timing_columns(driven.cells[0].swept), timed).csv())
    except OSError as error:
        raise unwritable(driven.folder, error) from error
    return tables
