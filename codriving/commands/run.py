"""The commands that drive cells and print their tables."""

import shlex
import sys
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path

from codriving.config import Point, expand, show
from codriving.errors import ModelError
from codriving.experiment import (
    SHARD,
    Driven,
    Ended,
    Finished,
    HaltedError,
    Interrupted,
    Outputs,
    Plan,
    cell_name,
    composed,
    driving,
    make_plan,
    refuse_part,
    validated,
    without_shard,
)
from codriving.reports import print_table
from codriving.runs import Part, Shard

STOPPED = 128  # Exit code of a process that a signal stopped, less the number of the signal


@dataclass(frozen=True)
class Command:
    """A command that drives cells and prints their tables."""

    name: str  # What is typed after ``codriving``
    # Gives the configs that ``key=value`` tokens, with a folder of YAMLs of the user's or None, stand for.
    points: Callable[[Sequence[str], Path | None], Sequence[Point]] = expand
    check: Callable[[Plan], None] = lambda _: None  # Refuses a plan with a ``ConfigError``
    # What it makes of its episodes beyond the tables of every run.
    make_outputs: Callable[[Driven], Outputs] = lambda _: Outputs()


def run_command(
    command: Command,
    overrides: Sequence[str],
    config_dir: Path | None = None,
    show_only: bool = False,
    plan: Plan | None = None,
) -> int:
    """Drive the cells of a command, print their table, say how to go on.

    Args:
        overrides: ``key=value`` tokens.
        show_only: Print the config of every cell and drive nothing.
        plan: What is driven, or joined of parts; None plans what the tokens say.

    Returns:
        Exit code: 0, 1 if episodes ended in an error, or 128 and the number of the signal that stopped it.

    Raises:
        UserError: If the config or the run folder cannot be used.
    """
    if plan is None:
        points = command.points(overrides, config_dir)
        if show_only:
            print_configs(points, config_dir)
            return 0
        plan = as_part(make_plan(points, config_dir), command.name, overrides, config_dir)
    command.check(plan)
    try:
        with driving(plan) as batch:
            ended = batch.ended if plan.part else batch.finished(plan, command.make_outputs)
    except (Interrupted, HaltedError) as stop:
        join = shlex.join(["codriving", "join", str(stop.folder)])
        again = how_to_go_on(plan, command.name, overrides, stop.folder) if plan.launcher.drives else join
        return stopped(stop, again)
    again = how_to_go_on(plan, command.name, overrides, ended.folder)
    return report(ended, again) if isinstance(ended, Finished) else report_part(ended, again, plan.shard)


def how_to_go_on(plan: Plan, name: str, overrides: Sequence[str], folder: Path) -> str:
    """Give the command that goes on with a run; what cannot be repeated is begun again."""
    anew = any(cell.repeatable is False for cell in plan.cells)
    return resume_command(name, overrides, plan.config_dir, None if anew else plan.run or folder.name, plan.part)


def run_experiment(overrides: Sequence[str], config_dir: Path | None = None) -> int:
    """Do what ``codriving run`` does."""
    return run_command(RUN, overrides, config_dir)


RUN = Command("run")


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


def resume_command(
    name: str, overrides: Sequence[str], config_dir: Path | None, run: str | None, part: Part | None = None
) -> str:
    """Return the command that goes on with a run or a part of it, or drives it anew under the name of its time."""
    kept = [override for override in overrides if not override.lstrip("+").startswith("run=")]
    if part:
        # Outside of the array of a scheduler the place in it has to be written out.
        kept = [*without_shard(kept), f"{SHARD}={part.shard}"]
    folder = ["--config-dir", str(config_dir)] if config_dir else []
    return shlex.join(["codriving", *shlex.split(name), *kept, *([f"run={run}"] if run else []), *folder])


def as_part(plan: Plan, command: str, overrides: Sequence[str], config_dir: Path | None) -> Plan:
    """Note in the plan of a shard what was typed, by which ``codriving join`` makes the tables of the run."""
    if plan.shard is None:
        return plan
    refuse_part(plan.cells, kept := without_shard(overrides))
    part = Part(plan.shard.index, plan.shard.count, command, tuple(kept), str(config_dir) if config_dir else None)
    return replace(plan, part=part)


def report(finished: Finished, again: str) -> int:
    """Print what a finished run has to say; the last line tells its folder."""
    if not finished.driven and not finished.filmed:
        print(f"Nothing to do: all {finished.kept} episodes of this run are finished already.")
    for index, printed in enumerate(finished.printed):
        if index:
            print()
        print_table(printed)
    _report_troubles(finished, again)
    if finished.left_out:
        print(f"{finished.left_out} more episodes in this run folder were not asked for and are left out of the table.")
    print(f"Run folder: {finished.folder}")
    return _code(finished)


def report_part(ended: Ended, again: str, shard: Shard | None) -> int:
    """Print what a part has to say that is complete; the last line tells its folder."""
    there = f"{_counted(ended.driven + ended.kept, 'episode')} of shard {shard}"
    print(f"{there}: {ended.driven} driven, {ended.kept} kept.")
    _report_troubles(ended, again)
    run = ended.folder.parent.parent
    print(f"Once all parts are there: {shlex.join(['codriving', 'join', str(run)])}")
    print(f"Part: {ended.folder}")
    return _code(ended)


def _code(ended: Ended) -> int:
    return 1 if ended.failed or ended.unfilmed else 0


def _report_troubles(finished: Ended, again: str) -> None:
    """Print what went wrong, and what may differ."""
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


def _counted(number: int, noun: str) -> str:
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"
