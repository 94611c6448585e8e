"""The commands: what each takes from the command line, handed on to the room that does it."""

import shutil
import sys
import textwrap
from pathlib import Path
from typing import Annotated

import typer

from codriving.cli.arguments import ConfigDir, Overrides, ShowConfig
from codriving.cli.completion import (
    PLURALS,
    complete_axis,
    complete_experiment,
    complete_format,
    complete_group,
    complete_layout,
    complete_table,
)
from codriving.errors import ConfigError


def run(overrides: Overrides = None, config_dir: ConfigDir = None, cfg: ShowConfig = False) -> None:
    """Drive a seeded batch of episodes and print its table.

    The same command with the same run=NAME goes on where it was interrupted.
    """
    from codriving.commands import RUN, run_command

    raise typer.Exit(run_command(RUN, overrides or [], config_dir, cfg))


def ablate(overrides: Overrides = None, config_dir: ConfigDir = None, cfg: ShowConfig = False) -> None:
    """Run the full method, each reasoning sub-module removed, and the controls, on the same seeds, into one table.

    controls=false leaves the controls out.
    """
    from codriving.commands import ABLATE, run_command

    raise typer.Exit(run_command(ABLATE, overrides or [], config_dir, cfg))


def compare(
    table: Annotated[
        str | None,
        typer.Argument(
            metavar="TABLE",
            help="Which table: baselines, single-vehicle, all, methods, load, orders, filters or models.",
            autocompletion=complete_table,
        ),
    ] = None,
    overrides: Overrides = None,
    bound: Annotated[
        bool, typer.Option("--bound", help="Say how far each row is above the bound; 0.1 to 0.5 s a seed.")
    ] = False,
    config_dir: ConfigDir = None,
    cfg: ShowConfig = False,
) -> None:
    """Drive every method of the paper on the same seeds, into one table beside the paper's.

    baselines: each method against codriving. single-vehicle: those by which each CAV is on its own. all: both.
    methods: those that method=NAME,NAME names. load: baselines with 4, 6, 8 and 12 CAVs. orders: codriving with each
    passing order. filters: each method with and without the safety check behind it. models: codriving with each model
    that llm=NAME,NAME names, and with controls and rules in its place; epochs=N drives each seed N times.

    To other tables method=NAME adds a method of your own; controls=false leaves controls out.
    """
    from codriving.commands import comparison_command, run_command

    raise typer.Exit(run_command(comparison_command(table, bound), overrides or [], config_dir, cfg))


def stress(
    axes: Annotated[
        str | None,
        typer.Argument(
            metavar="AXIS", help="What is made worse: one axis, several as a,b, or all.", autocompletion=complete_axis
        ),
    ] = None,
    overrides: Overrides = None,
    config_dir: ConfigDir = None,
    cfg: ShowConfig = False,
) -> None:
    """Drive methods at rising levels of an axis, on the same seeds: curves, breaking points, area under each curve.

    codriving list axes shows the axes. method=NAME,NAME takes other methods than the usual ones; controls=false leaves
    controls out. The same command with the same run=NAME goes on where it was interrupted.
    """
    from codriving.commands import run_command, stress_command

    raise typer.Exit(run_command(stress_command(axes, config_dir), overrides or [], config_dir, cfg))


def bound(
    overrides: Overrides = None,
    driven: Annotated[
        bool, typer.Option("--driven", help="Look for a drive that is nearly as fast, too: some seconds a seed.")
    ] = False,
    margin: Annotated[
        float | None, typer.Option(metavar="T", help="Bound an executor that keeps so many seconds at zones.")
    ] = None,
    one_order: Annotated[
        bool, typer.Option("--one-order", help="With --margin: CAVs keep one order of vehicles at all zones.")
    ] = False,
    measure: Annotated[
        bool, typer.Option("--measure", help="Measure how CAVs turn on a road of which that is not known; a minute.")
    ] = False,
    config_dir: ConfigDir = None,
) -> None:
    """Say how fast the CAVs of each seed can arrive at most, by any way of driving.

    A proven bound at intersection and roundabout, human drivers left out; at merge and highway the time alone. The same
    command with the same run=NAME goes on where it was interrupted.
    """
    from codriving.commands import BoundOptions, run_bound

    raise typer.Exit(run_bound(overrides or [], BoundOptions(measure, margin, one_order, driven, config_dir)))


def learn(overrides: Overrides = None, config_dir: ConfigDir = None, cfg: ShowConfig = False) -> None:
    """Learn from so many interactions, then test what was learnt: success after each, as table and figure.

    interactions=0,2,5,10,20 says after how many; scenario=all and three CDA levels are tested unless you name some.
    The same command with the same run=NAME goes on where it was interrupted.
    """
    from codriving.commands import run_learn

    raise typer.Exit(run_learn(overrides or [], config_dir, cfg))


def experiment(
    name: Annotated[
        str | None,
        typer.Argument(
            metavar="[NAME|FILE]",
            help="An experiment of codriving list experiments, a YAML of yours, or paper for those of the paper.",
            autocompletion=complete_experiment,
        ),
    ] = None,
    overrides: Overrides = None,
    config_dir: ConfigDir = None,
    cfg: ShowConfig = False,
) -> None:
    """Drive what a file says: rows and columns of settings, on the same seeds, into one table.

    Without a name it lists them. ablate, learn and compare are such files; those of the paper say suite=paper. The same
    command with the same run=NAME goes on where it was interrupted.
    """
    from codriving.config import ALL_OF_PAPER, check_config_dir, describe, experiment_names

    if name is None:
        if config_dir is not None:
            check_config_dir(config_dir)
        for known, file in experiment_names(config_dir).items():
            print(_entry(known, describe(file)))
        print(_entry(ALL_OF_PAPER, "Those of the paper, one after another, and a page of all of them."))
        return
    if name == ALL_OF_PAPER:
        from codriving.commands import run_paper

        raise typer.Exit(run_paper(overrides or [], config_dir, cfg))
    from codriving.commands import run_experiment_file

    raise typer.Exit(run_experiment_file(name, overrides or [], config_dir, cfg))


def join(
    runs: Annotated[
        list[Path],
        typer.Argument(metavar="RUN...", help="Folders of a run, or its name under outputs/; the first gets the rest."),
    ],
    mixed: Annotated[bool, typer.Option("--mixed", help="Join parts of different versions, too.")] = False,
    plugins: Annotated[
        bool, typer.Option("--plugins", help="Run the plug-ins that the command of the parts names.")
    ] = False,
    config_dir: ConfigDir = None,
) -> None:
    """Join what was driven with shard=1/4, shard=2/4 and so on, and print the tables of the run.

    Each shard leaves a part in the folder of the run. The joined run is as if one process had driven it.
    """
    from codriving.commands import JoinOptions, run_join

    raise typer.Exit(run_join(runs, JoinOptions(config_dir, plugins, mixed)))


def check(overrides: Overrides = None, config_dir: ConfigDir = None) -> None:
    """Ask a language model for one order and one decision, and show answer, form, latency, tokens and cost.

    Exit code 0 if both were answered in form, 1 if a fallback was needed, 2 if the model cannot be reached.
    """
    from codriving.commands import run_check

    raise typer.Exit(run_check(overrides or [], config_dir))


def exam(
    overrides: Overrides = None,
    most: Annotated[
        int | None, typer.Option("--most", metavar="N", help="Ask so many questions at most, evenly taken of all.")
    ] = None,
    file: Annotated[
        Path | None, typer.Option("--file", metavar="FILE", help="Another exam, of docs/exam/build.py.")
    ] = None,
    config_dir: ConfigDir = None,
) -> None:
    """Ask a language model stored questions, without driving: is its action safe, acceptable, in form, repeatable?

    llm=NAME,NAME names models; the rules and the controls have their rows beside them, controls=false leaves the
    controls out, and epochs=N asks everything N times.
    """
    from codriving.commands import ExamOptions, run_exam

    raise typer.Exit(run_exam(overrides or [], ExamOptions(most, file, config_dir)))


def replay(
    run: Annotated[Path, typer.Argument(metavar="RUN", help="A run folder, or the name of one under outputs/.")],
    overrides: Annotated[
        list[str] | None,
        typer.Argument(metavar="[suite=NAME]", help="The row that was driven in this world, if there are several."),
    ] = None,
    episode: Annotated[int | None, typer.Option(metavar="N", help="Its seed; the first one if not given.")] = None,
    cell: Annotated[
        str | None, typer.Option(metavar="NAME", help="Which row of the table, or a part of its name; for a sweep.")
    ] = None,
    format: Annotated[
        str | None, typer.Option(metavar="mp4|gif", help="mp4 if not given.", autocompletion=complete_format)
    ] = None,
    out: Annotated[Path | None, typer.Option(metavar="FILE", help="Beside the episode's record if not given.")] = None,
    speed: Annotated[float | None, typer.Option(metavar="X", help="Seconds of driving a second of film: 1.")] = None,
    fps: Annotated[float | None, typer.Option(metavar="X", help="Frames a second: 25, and 10 for a gif.")] = None,
    scale: Annotated[float, typer.Option(metavar="X", help="0.5 to 4; at 1 a frame has 1280 x 720 pixels.")] = 1.0,
    frame: Annotated[
        float | None, typer.Option(metavar="T", help="A PNG of one moment [s] in place of a film.")
    ] = None,
    config_dir: ConfigDir = None,
) -> None:
    """Show a stored episode: road, vehicles, conflicts, what every CAV decides and why."""
    from codriving.commands import ReplayOptions, run_replay

    options = ReplayOptions(cell, episode, format, out, speed, fps, scale, frame, config_dir, tuple(overrides or ()))
    print(run_replay(run, options))


def report(
    runs: Annotated[list[Path], typer.Argument(metavar="RUN...", help="Run folders, or names of some under outputs/.")],
    out: Annotated[
        Path | None, typer.Option(metavar="FILE", help="In the folder of the first run if not given.")
    ] = None,
    cell: Annotated[str | None, typer.Option(metavar="NAME", help="A row of the table, or a part of its name.")] = None,
    replays: Annotated[
        int | None, typer.Option(metavar="N", help="How many episodes can be replayed: 40, bad endings first.")
    ] = None,
    config_dir: ConfigDir = None,
) -> None:
    """Make one page of runs, a file for any browser: tables, figures, and every episode replayed.

    Beside the road of a replay: what a CAV knew at each step, conflicts, order, removed actions, memories, messages,
    prompt and answer. Of several runs it says where they part on equal seeds. The page asks nothing of the network.
    """
    from codriving.commands import ReportOptions, run_report

    print(run_report(runs, ReportOptions(out, cell, replays, config_dir)))


def figures(
    runs: Annotated[list[Path], typer.Argument(metavar="RUN...", help="Run folders, or names of some under outputs/.")],
    out: Annotated[
        Path | None, typer.Option(metavar="DIR", help="figures/ in the folder of the first run if not given.")
    ] = None,
    cell: Annotated[str | None, typer.Option(metavar="NAME", help="A row of the table, or a part of its name.")] = None,
    episode: Annotated[
        int | None, typer.Option(metavar="N", help="Draw the space-time diagram of this seed, and nothing else.")
    ] = None,
    config_dir: ConfigDir = None,
) -> None:
    """Draw runs, as PNG and SVG for print: endings, success, PETs, velocity against severe PETs, performance profiles.

    A panel for each scenario and setting, with all rows in it. With --episode: when each CAV was where along its route,
    and what ground others blocked for it.
    """
    from codriving.commands import FigureOptions, write_figures

    print(write_figures(runs, FigureOptions(out, cell, episode, config_dir)))


def score(
    words: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="FILE|RUN... [metrics=NAME]",
            help="Files with trajectories, or run folders; and the metric, standard if not given, with its keys.",
        ),
    ] = None,
    csv: Annotated[Path | None, typer.Option("--csv", metavar="OUT", help="Write a row each, and one of all.")] = None,
    pets: Annotated[Path | None, typer.Option("--pets", metavar="OUT", help="Write every PET, a row each.")] = None,
    config_dir: ConfigDir = None,
) -> None:
    """Score trajectories from anywhere, or a finished run by another metric, without driving.

    Files: trajectory.csv of an episode, a tidy CSV (time, id, x, y), tracks of INTERACTION or inD, SUMO's --fcd-output,
    or an .xlsx of the paper's authors.
    """
    from codriving.commands import ScoreOptions, run_score

    run_score(words or [], ScoreOptions(csv, pets, config_dir))


def export(
    run: Annotated[Path, typer.Argument(metavar="RUN", help="A run folder, or the name of one under outputs/.")],
    to: Annotated[
        str, typer.Option("--to", metavar="fcd|interhub|csv|sft", help="The layout.", autocompletion=complete_layout)
    ],
    episode: Annotated[int | None, typer.Option(metavar="N", help="Its seed; all if not given.")] = None,
    cell: Annotated[str | None, typer.Option(metavar="NAME", help="A row of the table, or a part of its name.")] = None,
    out: Annotated[Path | None, typer.Option(metavar="DIR", help="exported/ in the run folder if not given.")] = None,
    config_dir: ConfigDir = None,
) -> None:
    """Write the episodes of a run for other programs.

    fcd: floating car data as SUMO's --fcd-output. interhub: the interactions, in the columns of InterHub's table.
    csv: a tidy table with sizes and routes. sft: a chat a line, question and answer, to tune a language model on.
    """
    from codriving.commands import ExportOptions, run_export

    print(run_export(run, ExportOptions(to, cell, episode, out, config_dir)))


def train(
    learner: Annotated[str, typer.Argument(metavar="LEARNER", help="What is trained: madqn, ppo or tell.")],
    overrides: Annotated[
        list[str] | None,
        typer.Argument(metavar="[KEY=VALUE]...", help="Settings, for instance seed=2, decisions=300000 or run=second."),
    ] = None,
    family: Annotated[
        str, typer.Option("--family", help="Roads to train for: junction (intersection, roundabout) or lanes.")
    ] = "junction",
    smoke: Annotated[bool, typer.Option("--smoke", help="A test of the machinery in less than two minutes.")] = False,
    config_dir: ConfigDir = None,
) -> None:
    """Train a learner on the environment; the same command goes on where it was stopped.

    Needs PyTorch: in a clone of the repository, make torch or pip install -e '.[train]'. Config, curve, checkpoint and
    weights are kept in outputs/train/NAME.
    """
    from codriving.training import run_training

    raise typer.Exit(run_training(learner, family, overrides or [], smoke, config_dir))


def list_choices(
    group: Annotated[
        str | None,
        typer.Argument(metavar="[GROUP]", help=f"One of {', '.join(PLURALS)}.", autocompletion=complete_group),
    ] = None,
    config_dir: ConfigDir = None,
) -> None:
    """List what a group offers, or all groups."""
    from codriving.config import ALL, SUITE, SWEPT, check_config_dir, choices, describe, members, suite_sets

    if config_dir is not None:
        check_config_dir(config_dir)
    if group is not None and group not in PLURALS and group not in PLURALS.values():
        raise ConfigError(f"unknown group {group!r}; choices: {', '.join(PLURALS)}")
    for plural, singular in PLURALS.items():
        found = choices(singular, config_dir)
        several = singular in SWEPT and len(found) > 1
        sets = suite_sets(config_dir) if singular == SUITE else {}
        if group in (plural, singular):
            for name, file in found.items():
                print(_entry(name, describe(file)))
            for name in sets:
                row = members(name, config_dir)
                named, days = ", ".join(m.suite for m in row), ", ".join(sorted({m.fixed for m in row}))
                print(_entry(name, f"A set, one row of the table each, fixed on {days}: {named}."))
            if several:
                print(_entry(ALL, "Every one of these, in this order: one row of the table each."))
        elif group is None:
            print(_entry(plural, ", ".join([*found, *sets, *([f"or {ALL}"] if several else [])]) or "-"))


def _entry(name: str, text: str) -> str:
    """A name and what it is, within the width of a terminal; on one line in a pipe."""
    line = f"{name:<20} {text}".rstrip()
    width = shutil.get_terminal_size().columns if sys.stdout.isatty() else len(line)
    return "\n".join(textwrap.wrap(line, max(width, 40), subsequent_indent=" " * 21, break_on_hyphens=False))
