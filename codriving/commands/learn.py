"""`codriving learn`: memories of so many interactions, then the same tests with each (paper, learning figure)."""

import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import datetime
from pathlib import Path

from codriving.commands.controls import split_controls
from codriving.commands.memory_build import FIRST_SEED, MOST, count_of, refuse_forgetful, split_interactions
from codriving.commands.run import Command, as_part, print_configs, report, resume_command, run_command, stopped
from codriving.commands.settings import points_of
from codriving.config import ExperimentFile, Point, built_in, experiments_dir, key_of, parse, written
from codriving.errors import ConfigError
from codriving.experiment import (
    Driven,
    Finished,
    HaltedError,
    Interrupted,
    Joining,
    Outputs,
    Plan,
    drive,
    make_plan,
    memory_file,
    refuse_nameless,
    refuse_part,
    results_of,
    without_shard,
)
from codriving.reports import (
    LearningRow,
    learning_figure,
    learning_rows,
    learning_table,
    markdown_text,
    print_learning,
    read_learning,
)

KEY = "memory.interactions"  # The key that is swept

CONTROL = "memory.control"  # The key by which a memory becomes a control

ALTERED = ("verdicts", "situations", "rule")  # The controls, each of the most interactions

SITE, ELSEWHERE = "drivers.site", "elsewhere"  # Where several sites are named: the memory of the next one


@dataclass(frozen=True)
class Lessons:
    """What is learnt in which settings, and after how many interactions it is tested."""

    others: Sequence[str]  # What is asked for besides, as ``key=value`` tokens
    points: Sequence[Point]  # The settings
    sizes: Sequence[int]
    controls: Sequence[str]
    run: str  # One name for both runs, so that the same command goes on with both
    named: bool  # Whether that is the user's
    config_dir: Path | None = None

    @classmethod
    def of(
        cls, overrides: Sequence[str], config_dir: Path | None = None, spec: ExperimentFile | None = None
    ) -> "Lessons":
        """Read ``key=value`` tokens, among them ``interactions=0,2,5``; what they leave open is as a file says."""
        usual = built_in("learn")
        spec = spec or usual
        controlled, others = split_controls([*usual.words, *spec.words, *written(overrides)], usual=True)
        sizes, others = _sizes(others)
        # Of no interactions there is nothing to mix up.
        controls = ALTERED if controlled and max(sizes) > 0 else ()
        names = [t.partition("=")[2] for t in others if t.partition("=")[0] == "run"]
        run = names[-1] if names else datetime.now().strftime("%Y-%m-%d_%H%M%S")
        return cls(others, settings_of(others, config_dir, spec), sizes, controls, run, bool(names), config_dir)

    @property
    def shares(self) -> bool:
        """Whether a shard of the tests is driven."""
        return without_shard(self.others) != self.others

    def learn(self, joins: Joining | None = None) -> tuple[Finished, list[Path]]:
        """Drive what is learnt from; gives the memories, too, one a setting."""
        if self.shares:
            refuse_nameless(self.run if self.named else None)
        builds = make_plan(build_points(self.points, max(self.sizes), self.run), self.config_dir, drives=joins is None)
        refuse_forgetful(builds)
        if self.shares:
            refuse_part(builds.cells, self.others)
        builds = joins.learnt(builds) if joins else replace(builds, waits=self.shares)
        if joins is None:
            told = "; one shard learns, the others wait for it" if self.shares else ""
            settings = f"{builds.episodes} interactions in each of {len(builds.cells)} settings"
            print(f"Learning: {settings}{told}.", file=sys.stderr)
        learnt = drive(builds)
        return learnt, [memory_file(learnt.folder, cell.folder) for cell in builds.cells]

    def tests(self, files: Sequence[Path], drives: bool = True) -> Plan:
        """Plan the tests with memories."""
        points = frozen_points(self.points, files, self.sizes, self.run, self.controls)
        plan = make_plan(points, self.config_dir, drives=drives)
        if drives:
            print(f"Testing: {plan.episodes} episodes in each of {len(plan.cells)} cells.", file=sys.stderr)
        return plan

    def outputs(self, driven: Driven) -> Outputs:
        """Make the learning table and figure of the tests."""
        return learned(driven, len(self.points))


def run_learn(
    overrides: Sequence[str],
    config_dir: Path | None = None,
    show_only: bool = False,
    joins: Joining | None = None,
    spec: ExperimentFile | None = None,
    named: str = "learn",
) -> int:
    """Build memories, test with them, and print how success depends on what was learnt: ``codriving learn``.

    Of several shards one learns, in order, while the others wait; then each drives its share of the tests.

    Args:
        overrides: ``key=value`` tokens, among them ``interactions=0,2,5``.
        show_only: Print the configs with which it learns and drive nothing: the files of the tests are yet to be made.
        joins: Brings the episodes of the tests from parts; nothing is driven.
        spec: Says what is learnt; None takes what the command does.
        named: What is typed after ``codriving``.

    Returns:
        Exit code: 0, 1 if episodes ended in an error, 130 if the user stopped it.

    Raises:
        UserError: If the config or a run folder cannot be used.
    """
    lessons = Lessons.of(overrides, config_dir, spec)
    if show_only:
        print_configs(build_points(lessons.points, max(lessons.sizes), "learn"), config_dir)
        return 0
    again = resume_command(named, overrides, config_dir, lessons.run)
    try:
        learnt, files = lessons.learn(joins)
    except (Interrupted, HaltedError) as stop:
        return stopped(stop, again)
    if learnt.failed:
        return report(learnt, again)
    tests = lessons.tests(files, drives=joins is None)
    tests = joins.joined(tests) if joins else as_part(tests, named, overrides, config_dir)
    return run_command(Command(named, make_outputs=lessons.outputs), overrides, config_dir, plan=tests)


def settings_of(
    overrides: Sequence[str], config_dir: Path | None = None, spec: ExperimentFile | None = None
) -> tuple[Point, ...]:
    """Give the settings that are learnt and tested in, one config each, without a memory."""
    keys = [parse(token).key_or_group for token in overrides]
    if "memory" in keys:
        raise ConfigError("codriving learn sets memory itself; memory.shots and memory.least_similarity can be given")
    # Whoever sets a key of a group does so in one choice of it, unless several are named.
    heads = {key.partition(".")[0] for key in keys}
    spec = spec or built_in("learn")
    kept = tuple(t for t in spec.common if not (key_of(t) in heads and parse(t).is_sweep_override()))
    kept = tuple(t for t in kept if not (t == "scenario=all" and "scenario" in heads))
    return tuple(points_of(replace(spec, common=kept), overrides, config_dir))


def build_points(points: Sequence[Point], interactions: int, run: str) -> list[Point]:
    """Give what is driven to learn, one config a setting."""
    base = ("memory=online", "experiment=learn-memory")
    own = ("experiment", "episodes", "seed", "run", "render", "shard")
    ends = (f"episodes={max(interactions, 1)}", f"seed={FIRST_SEED}", f"run={run}")
    return [
        replace(p, overrides=(*base, *(t for t in p.overrides if t.lstrip("+").partition("=")[0] not in own), *ends))
        for p in points
    ]


def frozen_points(
    points: Sequence[Point], files: Sequence[Path], sizes: Sequence[int], run: str, controls: Sequence[str] = ()
) -> list[Point]:
    """Give what is tested: every setting with the first interactions of its memory, then with its controls."""
    cells = []
    for point, file in zip(points, files, strict=True):
        named = any(t.lstrip("+").startswith("experiment=") for t in point.overrides)
        base = ("memory=frozen", *(() if named else ("experiment=learn",)))
        kept = tuple(t for t in point.overrides if t.lstrip("+").partition("=")[0] != "run")
        other = _elsewhere(point, points, files) if controls else None
        altered = (*controls, *((ELSEWHERE,) if other is not None else ()))
        for size, control in [*((size, "none") for size in sizes), *((max(sizes), control) for control in altered)]:
            used = other if control == ELSEWHERE else file
            own = (f"run={run}", f"{KEY}={size}", f"memory.file='{used}'", f"{CONTROL}={control}")
            swept = {**point.swept, KEY: str(size), CONTROL: control}
            cells.append(Point((*base, *kept, *own), swept, point.removed))
    return cells


def _elsewhere(point: Point, points: Sequence[Point], files: Sequence[Path]) -> Path | None:
    """Return the memory of the next site in the same setting; None where no other site is named."""

    def setting(swept: Mapping[str, str]) -> dict[str, str]:
        return {key: value for key, value in swept.items() if key != SITE}

    same = [(p, file) for p, file in zip(points, files, strict=True) if setting(p.swept) == setting(point.swept)]
    names = [p.swept.get(SITE) for p, _ in same]
    return same[(names.index(point.swept[SITE]) + 1) % len(same)][1] if len(set(names)) > 1 else None


def learned(driven: Driven, settings: int) -> Outputs:
    """Make the learning table and figure."""
    paper, each = read_learning(experiments_dir()), len(driven.cells) // settings
    cells = []
    for index, (cell, records) in enumerate(zip(driven.cells, driven.records, strict=True)):
        other = {key: value for key, value in cell.swept.items() if key not in (KEY, CONTROL)}
        results, memory = results_of(cell, records, other), cell.resolved["memory"]
        size, control = int(memory["interactions"]), str(memory["control"])
        cells.append(LearningRow(results, size, index // each, int(memory["shots"]), control=control))
    rows = learning_rows(cells, paper)
    swept = tuple(dict.fromkeys(key for row in rows for key in row.cell.swept))
    table = learning_table(rows, swept)
    display = print_learning(rows, driven.metrics, swept).with_notes(driven.notes)
    figures = {f"figures/{name}": content for name, content in learning_figure(rows, paper, driven.metrics).items()}
    files = {"learn.csv": table.csv().encode(), "learn.md": markdown_text(display).encode(), **figures}
    return Outputs(files, (display,), (table,))


def _sizes(overrides: Sequence[str]) -> tuple[list[int], list[str]]:
    """Take ``interactions=`` out of the tokens."""
    given, others = split_interactions(overrides)
    texts = given[-1].split(",")
    sizes = [count_of(text) for text in texts]
    counts = {size for size in sizes if size is not None and size <= MOST}
    if None in sizes or len(counts) != len(set(sizes)):
        raise ConfigError(
            f"interactions must be whole numbers from 0 to {MOST}, for instance interactions=0,2,5, "
            f"got {given[-1]!r:.100}"
        )
    return sorted(counts), others
