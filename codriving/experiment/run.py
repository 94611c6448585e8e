"""The faces of an experiment: for the command line, which prints, and for Python, which gets data frames."""

import shlex
import sys
from collections import defaultdict
from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from codriving.config.locate import experiments_dir
from codriving.config.sweep import Point, expand
from codriving.errors import ConfigError, ModelError
from codriving.experiment.ablation import ablation_points
from codriving.experiment.cells import Cell
from codriving.experiment.episodes.progress import Progress, show_progress
from codriving.experiment.execute import Finished, execute
from codriving.experiment.further import Driven, Further
from codriving.experiment.objects import BuildObjects, modules_to_preload
from codriving.experiment.plan import Plan, make_plan
from codriving.experiment.stopping import HaltedError, Interrupted
from codriving.reports.paper import read_paper
from codriving.reports.printed import print_table

if TYPE_CHECKING:
    from pandas import DataFrame

INTERRUPTED = 130
"""Exit code of a process that the user stopped (128 + SIGINT)."""


@dataclass(frozen=True)
class Results:
    """What a run gives to Python."""

    episodes: "DataFrame"
    summary: "DataFrame"
    folder: Path


def run_experiment(overrides: Sequence[str], config_dir: Path | None = None) -> int:
    """Run one cell, or one for each combination of several values, and print the table: ``codriving run``.

    Args:
        overrides: ``key=value`` tokens.

    Returns:
        Exit code: 0, 1 if episodes ended in an error, 130 if the user stopped it.

    Raises:
        UserError: If the config or the run folder cannot be used.
    """
    return command("run", expand(overrides, config_dir), overrides, config_dir)


def run_ablation(overrides: Sequence[str], config_dir: Path | None = None) -> int:
    """Run the full method and each sub-module removed, and print one table: ``codriving ablate``.

    Args:
        overrides: ``key=value`` tokens that hold for every cell; with several values, for one ablation each.

    Returns:
        Exit code: 0, 1 if episodes ended in an error, 130 if the user stopped it.

    Raises:
        UserError: If the config or the run folder cannot be used.
    """
    points = ablation_points(expand(overrides, config_dir))
    return command("ablate", points, overrides, config_dir, check=_refuse_alike)


def _refuse_alike(plan: Plan) -> None:
    """A method that does not reason has nothing to remove; its ablation would be one row many times over."""
    together: defaultdict[tuple[str, ...], list[Cell]] = defaultdict(list)
    for cell in plan.cells:
        together[cell.labels.scenario, cell.labels.method, *cell.swept.values()].append(cell)
    for cells in together.values():
        if len(cells) > 1 and len({cell.labels for cell in cells}) == 1:
            raise ConfigError(
                f"method {cells[0].labels.method!r} has no reasoning sub-modules to remove; choose one that has, "
                "method=codriving"
            )


def run_frames(*overrides: str, config_dir: Path | None = None) -> Results:
    """Run one cell, or those of a sweep, and give the tables as data frames; prints no table.

    Args:
        *overrides: ``key=value`` tokens.

    Raises:
        UserError: If the config or the run folder cannot be used.
        KeyboardInterrupt: If the user stops it; finished episodes are kept.
    """
    finished = drive(expand(overrides, config_dir), config_dir)
    return Results(finished.tables.episodes.frame(), finished.tables.summary.frame(), finished.folder)


def drive(
    points: Sequence[Point], config_dir: Path | None = None, extend: Callable[[Driven], Further] | None = None
) -> Finished:
    """Drive some cells, or what is missing of them, with a progress display and without a table.

    Raises:
        UserError: If the config or the run folder cannot be used.
        Interrupted: If the user stops it; finished episodes are kept.
    """
    return drive_plan(make_plan(points, config_dir), extend)


def drive_plan(plan: Plan, extend: Callable[[Driven], Further] | None = None) -> Finished:
    """Drive what a plan says, or what is missing of it, with a progress display and without a table.

    Raises:
        UserError: If the run folder cannot be used.
        Interrupted: If the user stops it; finished episodes are kept.
    """
    preload = [*modules_to_preload(plan.configs.values()), *(["codriving.animation.film"] if plan.render else [])]
    further = extend or (lambda _: Further())

    def progress(units: Mapping[str, int], note: Callable[[], str] | None) -> AbstractContextManager[Progress]:
        return show_progress(units, note=note)

    return execute(plan, BuildObjects, preload, read_paper(experiments_dir()), progress, further)


def command(
    name: str,
    points: Sequence[Point],
    overrides: Sequence[str],
    config_dir: Path | None,
    extend: Callable[[Driven], Further] | None = None,
    check: Callable[[Plan], None] = lambda _: None,
) -> int:
    """Do what a command of several cells does: drive them, print their table, say how to go on.

    Args:
        name: The command, for instance ``ablate``.

    Returns:
        Exit code: 0, 1 if episodes ended in an error, 130 if the user stopped it.

    Raises:
        UserError: If the config or the run folder cannot be used.
    """
    plan = make_plan(points, config_dir)
    check(plan)
    try:
        finished = drive_plan(plan, extend)
    except Interrupted as stop:
        again = resume_command(name, overrides, config_dir, stop.folder.name)
        print(f"\nStopped; {stop.finished} of {stop.planned} episodes are finished and kept.", file=sys.stderr)
        print(f"Go on with: {again}", file=sys.stderr)
        return INTERRUPTED
    except HaltedError as stop:
        again = resume_command(name, overrides, config_dir, stop.folder.name)
        raise ModelError(f"{stop.text}; go on with: {again}") from stop
    report(finished, resume_command(name, overrides, config_dir, finished.folder.name))
    return 1 if finished.failed or finished.unfilmed else 0


def resume_command(name: str, overrides: Sequence[str], config_dir: Path | None, run: str) -> str:
    """Give the command that goes on with a run."""
    kept = [override for override in overrides if not override.lstrip("+").startswith("run=")]
    folder = ["--config-dir", str(config_dir)] if config_dir else []
    return shlex.join(["codriving", *name.split(), *kept, f"run={run}", *folder])


def report(finished: Finished, again: str) -> None:
    """Print what a finished run has to say; the last line tells its folder."""
    if not finished.driven and not finished.filmed:
        print(f"Nothing to do: all {finished.kept} episodes of this run are finished already.")
    for index, display in enumerate(finished.displays):
        if index:
            print()
        print_table(display)
    if finished.failed:
        first = finished.failed[0]
        where = f"{finished.folder}/episodes/{first.unit.cell}/{first.unit.seed}/error.txt"
        print(f"{len(finished.failed)} episodes ended in an error, the first with {first.message} (see {where}).")
        print(f"Repeat them with: {again}")
    if finished.changed:
        print(
            f"Kept episodes may be of other versions than new ones: since the run began, {', '.join(finished.changed)}."
        )
    if finished.filmed:
        print(f"{finished.filmed} films made, replay.mp4 beside the record of each episode.")
    if finished.unfilmed:
        first_unit = finished.unfilmed[0]
        where = f"{finished.folder}/episodes/{first_unit.cell}/{first_unit.seed}/replay-error.txt"
        print(f"{len(finished.unfilmed)} episodes could not be filmed (see {where}). Try again with: {again}")
    if finished.further:
        print(f"{finished.further} more episodes in this run folder were not asked for and are left out of the table.")
    print(f"Run folder: {finished.folder}")
