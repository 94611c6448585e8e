"""The commands that drive cells: for the command line, which prints, and for Python, which gets data frames."""

import shlex
import sys
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from codriving.config import Point, config_folder, expand, show
from codriving.errors import ModelError
from codriving.experiment.drive import Driven, Finished, HaltedError, Interrupted, Outputs, drive
from codriving.experiment.plan import Plan, cell_name, composed, make_plan, validated
from codriving.reports import print_table

if TYPE_CHECKING:
    from pandas import DataFrame

STOPPED = 128  # Exit code of a process that a signal stopped, less the number of the signal


@dataclass(frozen=True)
class Command:
    """A command that drives cells and prints their tables."""

    name: str  # What is typed after ``codriving``
    # Gives the configs that ``key=value`` tokens, with a folder of YAMLs of the user's or None, stand for.
    points: Callable[[Sequence[str], Path | None], Sequence[Point]]
    check: Callable[[Plan], None] = lambda _: None  # Refuses a plan with a ``ConfigError``
    # What it makes of its episodes beyond the tables of every run.
    make_outputs: Callable[[Driven], Outputs] = lambda _: Outputs()


@dataclass(frozen=True)
class Results:
    """What a run gives to Python."""

    episodes: "DataFrame"
    summary: "DataFrame"
    folder: Path


def run_command(
    command: Command, overrides: Sequence[str], config_dir: Path | None = None, show_only: bool = False
) -> int:
    """Drive the cells of a command, print their table, say how to go on.

    Args:
        overrides: ``key=value`` tokens.
        show_only: Print the config of every cell and drive nothing.

    Returns:
        Exit code: 0, 1 if episodes ended in an error, or 128 and the number of the signal that stopped it.

    Raises:
        UserError: If the config or the run folder cannot be used.
    """
    points = command.points(overrides, config_dir)
    if show_only:
        print_configs(points, config_dir)
        return 0
    plan = make_plan(points, config_dir)
    command.check(plan)
    # What cannot be repeated is not gone on with, but begun again.
    anew = any(cell.repeatable is False for cell in plan.cells)

    def again(folder: Path) -> str:
        return resume_command(command.name, overrides, config_dir, None if anew else folder.name)

    try:
        finished = drive(plan, command.make_outputs)
    except (Interrupted, HaltedError) as stop:
        return stopped(stop, again(stop.folder))
    return report(finished, again(finished.folder))


def run_experiment(overrides: Sequence[str], config_dir: Path | None = None) -> int:
    """Do what ``codriving run`` does."""
    return run_command(RUN, overrides, config_dir)


def run_frames(*overrides: str, config_dir: str | Path | None = None) -> Results:
    """Run one cell, or those of a sweep, and give the tables as data frames; prints no table.

    Args:
        *overrides: ``key=value`` tokens.

    Raises:
        UserError: If the config or the run folder cannot be used.
        KeyboardInterrupt: If the user stops it; finished episodes are kept.
    """
    folder = config_folder(config_dir)
    finished = drive(make_plan(expand(overrides, folder), folder))
    return Results(finished.tables.episodes.frame(), finished.tables.summary.frame(), finished.folder)


RUN = Command("run", expand)


def print_configs(points: Sequence[Point], config_dir: Path | None = None) -> None:
    """Print the composed config of every cell, once all of them are known to be valid."""
    configs, _ = composed(points, config_dir)
    validated(points, configs)
    for index, (point, config) in enumerate(zip(points, configs, strict=True)):
        if len(points) > 1:
            print(f"---\n# cell {index + 1} of {len(points)}: {cell_name(point)}")
        print(show(config), end="")


def stopped(stop: Interrupted | HaltedError, again: str) -> int:
    """Say how to go on with a run that has been stopped."""
    if isinstance(stop, HaltedError):
        raise ModelError(f"{stop.text}; go on with: {again}") from stop
    # The terminal may be gone, which is what SIGHUP says.
    with suppress(OSError):
        print(f"\nStopped; {stop.finished} of {stop.planned} episodes are finished and kept.", file=sys.stderr)
        print(f"Go on with: {again}", file=sys.stderr, flush=True)
    return STOPPED + stop.signal


def resume_command(name: str, overrides: Sequence[str], config_dir: Path | None, run: str | None) -> str:
    """Return the command that goes on with a run, or drives it anew under the name of its time."""
    kept = [override for override in overrides if not override.lstrip("+").startswith("run=")]
    folder = ["--config-dir", str(config_dir)] if config_dir else []
    return shlex.join(["codriving", *name.split(), *kept, *([f"run={run}"] if run else []), *folder])


def report(finished: Finished, again: str) -> int:
    """Print what a finished run has to say; the last line tells its folder."""
    if not finished.driven and not finished.filmed:
        print(f"Nothing to do: all {finished.kept} episodes of this run are finished already.")
    for index, printed in enumerate(finished.printed):
        if index:
            print()
        print_table(printed)
    episodes = f"{finished.folder}/episodes"
    if finished.failed:
        first = finished.failed[0]
        where = f"{episodes}/{first.unit.cell}/{first.unit.seed}/error.txt"
        ended = f"{_counted(len(finished.failed), 'episode')} ended in an error"
        print(f"{ended}, the first with {first.message} (see {where}).")
        print(f"Repeat them with: {again}")
    if finished.changed:
        print(
            f"Kept episodes may be of other versions than new ones: since the run began, {', '.join(finished.changed)}."
        )
    if finished.filmed:
        print(f"{_counted(finished.filmed, 'film')} made, replay.mp4 beside the record of each episode.")
    if finished.unfilmed:
        unit = finished.unfilmed[0]
        where = f"{episodes}/{unit.cell}/{unit.seed}/replay-error.txt"
        print(
            f"{_counted(len(finished.unfilmed), 'episode')} could not be filmed (see {where}). Try again with: {again}"
        )
    if finished.left_out:
        print(f"{finished.left_out} more episodes in this run folder were not asked for and are left out of the table.")
    print(f"Run folder: {finished.folder}")
    return 1 if finished.failed or finished.unfilmed else 0


def _counted(number: int, noun: str) -> str:
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"
