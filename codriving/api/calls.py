"""A call for each command that drives or scores: it prints no table, and raises what a command says in a line."""

from collections.abc import Callable, Sequence
from pathlib import Path

from codriving.api.result import Result, read_result
from codriving.api.scores import Scores
from codriving.commands import ABLATE, RUN, Command, Lessons, comparison_command, score_files
from codriving.config import Point, config_folder, written
from codriving.errors import EpisodeError, require
from codriving.experiment import Driven, Outputs, Plan, drive, make_plan


def run(*overrides: str, config_dir: str | Path | None = None) -> Result:
    """Drive a seeded batch, as ``codriving run`` does.

    Args:
        *overrides: ``key=value`` tokens, for instance ``"scenario=intersection", "episodes=5"``.

    Raises:
        UserError: If the config or the run folder cannot be used.

    Example:
        >>> result = codriving.run("scenario=intersection", "episodes=5")  # doctest: +SKIP
        >>> result.summary[["success_rate", "velocity_mean"]]  # doctest: +SKIP
    """
    return _called(RUN, overrides, config_folder(config_dir))


def compare(table: str, *overrides: str, bound: bool = False, config_dir: str | Path | None = None) -> Result:
    """Drive the methods of a table on the same seeds, as ``codriving compare`` does.

    Args:
        table: ``"baselines"``, ``"single-vehicle"``, ``"all"``, ``"load"``, ``"orders"``, ``"filters"``, ``"models"``.
        *overrides: ``key=value`` tokens; ``"method=mine"`` adds a method of your own.
        bound: Whether it is said how far each row is above the bound of its scenes.

    Raises:
        UserError: If the table, the config or the run folder cannot be used.
    """
    return _called(comparison_command(table, bound), overrides, config_folder(config_dir))


def ablate(*overrides: str, config_dir: str | Path | None = None) -> Result:
    """Drive the full method, each sub-module removed, and controls, as ``codriving ablate`` does."""
    return _called(ABLATE, overrides, config_folder(config_dir))


def learn(*overrides: str, config_dir: str | Path | None = None) -> Result:
    """Learn from so many interactions and test what was learnt, as ``codriving learn`` does.

    Raises:
        EpisodeError: If an episode that is learnt from ended in an error.
    """
    lessons = Lessons.of(written(overrides), config_folder(config_dir))
    learnt, files = lessons.learn()
    if learnt.failed:
        first, number = learnt.failed[0], len(learnt.failed)
        raise EpisodeError(
            f"{number} episode{'s' * (number > 1)} to learn from ended in an error, the first with {first.message} "
            f"(see {learnt.folder}/episodes/{first.unit.cell}/{first.unit.seed}/error.txt); the same call with "
            f"run={lessons.run} repeats them"
        )
    return _driven(lessons.tests(files), lessons.outputs)


def load(run: str | Path) -> Result:
    """Read a run that is there, by its folder or its name below ``outputs/``; nothing is driven.

    Tables are read from the files of the run, in which numbers have six significant digits.

    Raises:
        RunFolderError: If there is no such run, or it has no tables yet.
    """
    return read_result(run)


def score(*sources: str | Path, config_dir: str | Path | None = None) -> Scores:
    """Score files of trajectories and finished runs, as ``codriving score`` does.

    Args:
        *sources: Files, run folders or names of runs; and ``"metrics=authors"`` with keys of the metric.
    """
    for source in sources:
        require(isinstance(source, str | Path), f"a source is the path of a file, or a run, got {source!r:.100}")
    return Scores.of(score_files([str(source) for source in sources], config_folder(config_dir)))


def _called(command: Command, overrides: Sequence[str], config_dir: Path | None) -> Result:
    points: Sequence[Point] = command.points(written(overrides), config_dir)
    plan = make_plan(points, config_dir)
    command.check(plan)
    return _driven(plan, command.make_outputs)


def _driven(plan: Plan, make_outputs: Callable[[Driven], Outputs]) -> Result:
    finished = drive(plan, make_outputs)
    own = [table.frame() for table in finished.outputs.tables]
    summary = finished.tables.summary.frame()
    return Result(finished.folder, finished.tables.episodes.frame(), summary, own[0] if own else summary)
