"""`codriving join`: the parts that shards have driven become one run, with the tables of the command."""

import shlex
import sys
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

from codriving.commands.ablation import ABLATE
from codriving.commands.compare import comparison_command
from codriving.commands.experiment import experiment_command
from codriving.commands.learn import run_learn
from codriving.commands.run import RUN, Command, run_command
from codriving.commands.stress import stress_command
from codriving.config import experiment_file, experiment_names
from codriving.errors import RunFolderError
from codriving.experiment import FoundPart, Joining, check_alike, find_parts, make_plan
from codriving.runs import locked, unwritable


@dataclass(frozen=True, slots=True)
class JoinOptions:
    """What the command line says beside the runs."""

    config_dir: Path | None = None
    plugins: bool = False  # Whether plug-ins may be run that the command of the parts names
    mixed: bool = False  # Whether the parts may be of different versions


def run_join(runs: Sequence[Path], options: JoinOptions) -> int:
    """Join the parts of a run, print its tables, and give the exit code of a run.

    Args:
        runs: Folders of runs, or their names below ``outputs/``; the parts of all are joined into the first.

    Raises:
        UserError: If they do not belong together, or one is missing.
    """
    run, folders = find_parts(runs)
    with ExitStack() as held:
        for folder in folders:
            try:
                held.enter_context(locked(folder))
            except OSError as error:
                raise unwritable(folder, error) from error
        parts = [FoundPart.of(folder) for folder in folders]
        check_alike(parts, options.mixed)
        _refuse_code(parts[0], options)
        joining, part, own = Joining(run, parts), parts[0].part, options.config_dir
        overrides = [*part.arguments, "shard=null"]
        print(f"Joining {len(parts)} parts into {run}.", file=sys.stderr)
        if part.command == "learn":
            return run_learn(overrides, own, joins=joining)
        match shlex.split(part.command):
            case ["experiment", name] if name in experiment_names(own):
                spec = experiment_file(name, own)
                if spec.table == "learning":
                    return run_learn(overrides, own, joins=joining, spec=spec, named=part.command)
                command = experiment_command(spec, part.command)
            case _:
                command = _command(parts[0], own)
        plan = joining.joined(make_plan(command.points(overrides, own), own, drives=False))
        return run_command(command, part.arguments, own, plan=plan)


def _refuse_code(found: FoundPart, options: JoinOptions) -> None:
    """Let nothing but the user choose code: a part may come from elsewhere."""
    part = found.part
    if part.config_dir and options.config_dir is None:
        raise RunFolderError(
            f"{found.folder} was driven with --config-dir {part.config_dir}; give that folder to codriving join, too"
        )
    plugins = [token for token in part.arguments if "plugins" in token.partition("=")[0].split(".")]
    if plugins and not options.plugins:
        raise RunFolderError(
            f"the command of {found.folder} names plug-ins, {plugins[0]:.100}, which are code; if you know them, join "
            "with --plugins"
        )


def _command(found: FoundPart, config_dir: Path | None) -> Command:
    match found.part.command.split():
        case ["run"]:
            return RUN
        case ["ablate"]:
            return ABLATE
        case ["compare", table]:
            return comparison_command(table)
        case ["compare", table, "--bound"]:
            return comparison_command(table, bounded=True)
        case ["stress", axes]:
            return stress_command(axes, config_dir)
    raise RunFolderError(f"{found.folder} was driven by no command that has shards; drive it again")
