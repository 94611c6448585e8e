"""A call for each command that drives or scores: it prints no table, and raises what a command says in a line."""

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

from codriving.api.methods import NONE, ChosenMethods
from codriving.api.result import Result, read_result
from codriving.api.scores import Scores
from codriving.commands import ABLATE, RUN, Command, Lessons, comparison_command, score_files
from codriving.config import Point, config_folder
from codriving.errors import EpisodeError, require
from codriving.experiment import BuildWithGiven, Driven, Outputs, Plan, drive, make_plan


def run(*overrides: str, method: object = None, config_dir: str | Path | None = None) -> Result:
    """Drive a seeded batch, as ``codriving run`` does.

    Args:
        *overrides: ``key=value`` tokens, for instance ``"scenario=intersection", "episodes=5"``.
        method: A name, an object or a class that is a method or an order rule, or a list of such, a row each.

    Raises:
        UserError: If the config or the run folder cannot be used.

    Example:
        >>> result = codriving.run("scenario=intersection", "episodes=5")  # doctest: +SKIP
        >>> result.summary[["success_rate", "velocity_mean"]]  # doctest: +SKIP
    """
    methods = ChosenMethods.of(method)
    return _called(RUN, methods.tokens(overrides), config_folder(config_dir), methods, methods.each)


def compare(
    table: str, *overrides: str, method: object = None, bound: bool = False, config_dir: str | Path | None = None
) -> Result:
    """Drive the methods of a table on the same seeds, as ``codriving compare`` does.

    Args:
        table: ``"baselines"``, ``"single-vehicle"``, ``"all"``, ``"load"``, ``"orders"``, ``"filters"``, ``"models"``.
        *overrides: ``key=value`` tokens.
        method: What is compared besides, as for ``run``.
        bound: Whether it is said how far each row is above the bound of its scenes.

    Raises:
        UserError: If the table, the config or the run folder cannot be used.
    """
    command, methods = comparison_command(table, bound), ChosenMethods.of(method)
    methods.refuse_in(table)
    tokens = [*methods.tokens(overrides), *methods.named]
    return _called(command, tokens, config_folder(config_dir), methods, methods.beside)


def ablate(*overrides: str, config_dir: str | Path | None = None) -> Result:
    """Drive the full method, each sub-module removed, and controls, as ``codriving ablate`` does."""
    return _called(ABLATE, NONE.tokens(overrides), config_folder(config_dir), NONE, NONE.each)


def learn(*overrides: str, config_dir: str | Path | None = None) -> Result:
    """Learn from so many interactions and test what was learnt, as ``codriving learn`` does.

    Raises:
        EpisodeError: If an episode that is learnt from ended in an error.
    """
    lessons = Lessons.of(overrides, config_folder(config_dir))
    learnt, files = lessons.learn()
    if learnt.failed:
        first, number = learnt.failed[0], len(learnt.failed)
        raise EpisodeError(
            f"{number} episode{'s' * (number > 1)} to learn from ended in an error, the first with {first.message} "
            f"(see {learnt.folder}/episodes/{first.unit.cell}/{first.unit.seed}/error.txt); the same call with "
            f"run={lessons.run} repeats them"
        )
    return _driven(lessons.tests(files), lessons.outputs)


def load(run: str | Path, config_dir: str | Path | None = None) -> Result:
    """Read a run that is there, by its folder or its name below ``outputs/``; nothing is driven.

    Tables are read from the files of the run, in which numbers have six significant digits.

    Raises:
        RunFolderError: If there is no such run, or it has no tables yet.
    """
    return read_result(run, config_folder(config_dir))


def score(*sources: str | Path, config_dir: str | Path | None = None) -> Scores:
    """Score files of trajectories and finished runs, as ``codriving score`` does.

    Args:
        *sources: Files, run folders or names of runs; and ``"metrics=authors"`` with keys of the metric.
    """
    for source in sources:
        require(isinstance(source, str | Path), f"a source is the path of a file, or a run, got {source!r:.100}")
    return Scores.of(score_files([str(source) for source in sources], config_folder(config_dir)))


def _called(
    command: Command,
    tokens: Sequence[str],
    config_dir: Path | None,
    methods: ChosenMethods,
    put: Callable[[Sequence[Point]], Sequence[Point]],
) -> Result:
    plan = make_plan(put(command.points(tokens, config_dir)), config_dir)
    command.check(plan)
    return _driven(plan, command.make_outputs, methods)


def _driven(plan: Plan, make_outputs: Callable[[Driven], Outputs], methods: ChosenMethods = NONE) -> Result:
    finished = drive(plan, make_outputs, partial(BuildWithGiven, methods.given) if methods.given else None)
    own = [table.frame() for table in finished.outputs.tables]
    summary = finished.tables.summary.frame()
    table = own[0] if own else summary
    return Result(finished.folder, finished.tables.episodes.frame(), summary, table, plan.config_dir)
