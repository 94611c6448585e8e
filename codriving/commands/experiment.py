"""`codriving experiment`: what a file says, rows against columns on the same seeds, as the table that it asks for."""

import shlex
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

from codriving.commands.ablation import ablation_points, make_ablation, refuse_alike
from codriving.commands.compare import comparison_command
from codriving.commands.learn import run_learn
from codriving.commands.run import Command, run_command
from codriving.commands.settings import points_of
from codriving.config import TABLES, ExperimentFile, Point, compose, experiment_file, key_of, parse, validate, written
from codriving.errors import ConfigError
from codriving.experiment import Driven, Outputs, results_of
from codriving.reports import (
    CellResults,
    Compared,
    GridRow,
    Subject,
    ablation_rows,
    ablation_table,
    against_first,
    grid,
    markdown_text,
    with_corrected,
)

ROW = "row"  # The key by which rows are told apart


def run_experiment_file(
    name: str, overrides: Sequence[str], config_dir: Path | None = None, show_only: bool = False
) -> int:
    """Drive what a file says, print its tables, and give the exit code of a run.

    Args:
        name: Name of an experiment, or a file.
        overrides: ``key=value`` tokens.
        show_only: Print the config of every cell and drive nothing.

    Raises:
        UserError: If the file, the config or the run folder cannot be used.
    """
    spec, typed = experiment_file(name, config_dir), f"experiment {shlex.quote(name)}"
    _refuse_shards_of_files(spec, name, overrides)
    try:
        if spec.table == "learning":
            return run_learn(overrides, config_dir, show_only, None, spec, typed)
        return run_command(experiment_command(spec, typed), overrides, config_dir, show_only)
    except ConfigError as err:
        raise _blamed(spec, err, config_dir) from err


def experiment_command(spec: ExperimentFile, typed: str) -> Command:
    """Return the command of a file, other than one that learns."""
    if spec.table == "ablation":
        return Command(typed, partial(ablation_points, spec=spec), refuse_alike, make_ablation)
    if spec.table in TABLES:
        return comparison_command(spec.table, spec=spec, named=typed)
    return Command(typed, partial(row_points, spec), make_outputs=partial(make_rows, spec))


def row_points(spec: ExperimentFile, overrides: Sequence[str], config_dir: Path | None = None) -> list[Point]:
    """Give the cells: each row in each column."""
    given = {parse(token).key_or_group for token in written(overrides)}
    for name, tokens in spec.rows.items():
        if own := [key_of(token) for token in tokens if key_of(token) in given]:
            raise ConfigError(f"{own[0]} is what {spec.file} sets in rows.{name}; leave it out, or change the file")
    words = [key_of(token) for token in spec.words]
    if words or given & {"controls", "interactions", "epochs"}:
        word = [*words, *sorted(given & {"controls", "interactions", "epochs"})][0]
        raise ConfigError(f"{word} is no word of table: rows, which drives its rows alone; leave {word} out")
    return [
        Point((*point.overrides, *tokens), {ROW: name, **point.swept}, point.removed)
        for point in points_of(spec, overrides, config_dir, named=True)
        for name, tokens in spec.rows.items()
    ]


def make_rows(spec: ExperimentFile, driven: Driven) -> Outputs:
    """Set the rows of each column against the first one."""
    if driven.flows:
        return Outputs()
    first = next(iter(spec.rows))
    found: list[Compared] = []
    rows: dict[str, dict[str, CellResults]] = {name: {} for name in spec.rows}
    blocks: dict[tuple[tuple[str, str], ...], list[tuple[str, CellResults]]] = {}
    for name, rest, results in _each(driven):
        blocks.setdefault(tuple(rest.items()), []).append((name, results))
        rows[name][", ".join(rest.values())] = results
    for block in blocks.values():
        names = [name for name, _ in block]
        made = ablation_rows([results for _, results in block])
        found += [replace(row, label=name) for row, name in zip(made, names, strict=True)]
    found = with_corrected(found)
    keys = tuple(dict.fromkeys(key for rest in blocks for key, _ in rest))
    columns = [", ".join(value for _, value in rest) for rest in blocks]
    shown = [grid([GridRow(name, cells) for name, cells in rows.items()], columns, driven.metrics)]
    if against := against_first(found, driven.metrics, keys, first):
        shown.append(against)
    shown[-1] = shown[-1].with_notes(driven.notes)
    named = [replace(row, swept={ROW: row.label, **row.swept}) for row in found]
    table = ablation_table(named, (ROW, *keys), Subject(f"{ROW}s", ROW, first))
    pages = "\n".join(markdown_text(page, level=1 if page is shown[0] else 2) for page in shown)
    files = {"experiment.csv": table.csv().encode(), "experiment.md": pages.encode()}
    return Outputs(files, tuple(shown), (table,), below=True)


def _each(driven: Driven) -> Iterator[tuple[str, dict[str, str], CellResults]]:
    """Give row, column and results of every cell; of rows that are the same config, each has them."""
    for cell, records in zip(driven.cells, driven.records, strict=True):
        for point in cell.points:
            rest = {key: value for key, value in point.items() if key != ROW}
            yield point[ROW], rest, results_of(cell, records, rest)


def _refuse_shards_of_files(spec: ExperimentFile, name: str, overrides: Sequence[str]) -> None:
    """A part keeps its command, which has to say the same wherever it is joined, and chooses no files."""
    shard = [token.partition("=")[2] for token in overrides if key_of(token) == "shard"]
    if shard and shard[-1] != "null" and name != spec.name:
        raise ConfigError(
            f"shards need an experiment with a name; put {spec.file} into DIR/experiments/ and write codriving "
            f"experiment {spec.name} --config-dir DIR"
        )


def _blamed(spec: ExperimentFile, error: ConfigError, config_dir: Path | None) -> ConfigError:
    """Say in which row or column of the file a mistake is, if that is where it is."""
    bare = replace(spec, columns={}, rows={})
    places = [
        ("set", bare),
        *((f"columns.{name}", replace(bare, columns={name: tokens})) for name, tokens in spec.columns.items()),
        *((f"rows.{name}", replace(bare, columns={name: tokens})) for name, tokens in spec.rows.items()),
    ]
    for place, part in places:
        try:
            validate(compose(points_of(part, (), config_dir)[0].overrides, config_dir))
        except ConfigError as found:
            return type(error)(f"{spec.file}: {place}: {found}")
    return error
