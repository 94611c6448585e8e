"""`codriving compare`: methods on the same seeds, as cells, and as tables and figures."""

import json
from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from codriving.commands.compare_filters import NO_FLOWS, filter_points, make_filters
from codriving.commands.compare_models import check_models, make_models, model_points
from codriving.commands.compare_orders import ORDER, as_orders, order_points, subject_of
from codriving.commands.controls import split_controls
from codriving.commands.run import Command
from codriving.commands.settings import points_of
from codriving.config import (
    CONTROLS,
    SUITE,
    TABLES,
    ExperimentFile,
    Point,
    built_in,
    check_choice,
    choices,
    describe,
    expand,
    experiments_dir,
    parse,
    styles,
    taking_part,
    written,
)
from codriving.errors import ConfigError
from codriving.experiment import Cell, Driven, Outputs, refuse_flows, results_of
from codriving.reports import (
    METHOD_CHOICE,
    METHODS,
    REFERENCE,
    CellResults,
    Compared,
    Condition,
    Paper,
    Subject,
    comparison_rows,
    comparison_table,
    cpu_per_decision,
    flow_table,
    load_figure,
    load_rows,
    load_table,
    markdown_text,
    print_comparison,
    print_each_load,
    print_flows,
    print_loads,
    print_pairs,
    profile_figure,
    read_paper,
    with_corrected,
)

BASELINES, SINGLE_VEHICLE, ALL = "baselines", "single-vehicle", "all"
LOAD, ORDERS, FILTERS, MODELS = "load", "orders", "filters", "models"
NAMED = "methods"  # The table of those that method= names

CAVS = "scenario.cavs"  # The key that the load is

# Why there are no flows in it.
UNBOUNDED = "no bound is defined for a flow, in which vehicles keep coming; leave --bound out"
UNLOADED = (
    "codriving compare load varies the number of CAVs, which a flow does not have; write for instance codriving "
    "compare baselines flow=steady flow.arrivals=200,400,600"
)


def file_of(table: str) -> ExperimentFile:
    """Read what ``codriving compare`` drives for a table."""
    return built_in(f"compare_{table.replace('-', '_')}")


# The folder of each table's runs, if the user names none.
EXPERIMENT = {table: file_of(table).settings(())[0][0].partition("=")[2] for table in TABLES}


def comparison_command(
    table: str | None, bounded: bool = False, spec: ExperimentFile | None = None, named: str | None = None
) -> Command:
    """Return the command of a table of ``codriving compare``; bounded with columns of what is above the bound.

    Args:
        spec: Says what is compared; None takes the table's own file.
        named: What is typed after ``codriving``, if it is not ``compare``.
    """
    if not isinstance(table, str) or table not in TABLES:
        given = "compare needs the name of a table" if table is None else f"unknown table {table!r}"
        raise ConfigError(f"{given}; write codriving compare TABLE [KEY=VALUE]..., tables: {', '.join(TABLES)}")
    points, name = partial(comparison, table, spec=spec), named or f"compare {table}"
    if bounded and table in (LOAD, FILTERS, MODELS):
        raise ConfigError(f"compare {table} has no columns of the bound; write codriving compare baselines --bound")
    if table == LOAD:
        return Command(name, points, partial(refuse_flows, UNLOADED), make_loads)
    if table == FILTERS:
        return Command(name, points, partial(refuse_flows, NO_FLOWS), make_filters)
    if table == MODELS:
        return Command(name, points, check_models, make_models)
    if bounded:
        made = partial(make_comparison, table, bounded=True)
        return Command(f"{name} --bound", points, partial(refuse_flows, UNBOUNDED), made)
    return Command(name, points, make_outputs=partial(make_comparison, table, spec=spec))


def comparison(
    table: str, overrides: Sequence[str], config_dir: Path | None = None, spec: ExperimentFile | None = None
) -> list[Point]:
    """Find out what a comparison consists of.

    Every method of the table takes part. ``method=`` adds others to them; controls come last.
    """
    spec = spec or file_of(table)
    if table == MODELS:
        return points_of(spec, written([*spec.words, *overrides]), config_dir, make=partial(model_points, ()))
    usual = table not in (LOAD, ORDERS, FILTERS, NAMED)
    controlled, overrides = split_controls(written([*spec.words, *overrides]), usual)
    keys = [parse(token).key_or_group for token in overrides]
    added = [token for token, key in zip(overrides, keys, strict=True) if key == "method"]
    others = [token for token, key in zip(overrides, keys, strict=True) if key != "method"]
    methods = _methods_of(spec) or _having_place(table, config_dir)
    methods += _named(added, config_dir)
    if table == NAMED:
        methods = _against_reference(methods)
    methods += taking_part(CONTROLS) if controlled else ()
    methods = list(dict.fromkeys(methods))
    if table in (ORDERS, FILTERS):
        make = order_points if table == ORDERS else filter_points
        return points_of(spec, others, config_dir, make=lambda tokens, folder: make((), tokens, methods, folder))
    return [
        Point((*point.overrides, f"method={name}"), {**point.swept, "method": name}, point.removed)
        for point in points_of(spec, others, config_dir)
        for name in methods
    ]


def _having_place(table: str, config_dir: Path | None) -> list[str]:
    """The methods of a table that exist."""
    known = choices("method", config_dir)
    return [name for name in taking_part(ALL if table == FILTERS else table) if name in known]


def _against_reference(methods: Sequence[str]) -> list[str]:
    """The methods that were named, and the one that each is set against."""
    if set(methods) <= {REFERENCE}:
        raise ConfigError(
            f"compare {NAMED} needs the methods that are set against {REFERENCE}; write for instance codriving compare "
            f"{NAMED} method=fcfs,madqn, and codriving list methods shows them"
        )
    return [*(name for name in methods if name != REFERENCE), REFERENCE]


def _named(added: Sequence[str], config_dir: Path | None) -> list[str]:
    """The methods that the user adds."""
    own = [point.overrides[0].partition("=")[2] for token in added for point in expand([token], config_dir)]
    for name in own:
        check_choice("method", name, config_dir)
    return own


def _methods_of(spec: ExperimentFile) -> list[str]:
    """The methods that a file names, one a row."""
    return [token.partition("=")[2] for (token,) in spec.rows.values()]


def setting(resolved: Mapping[str, Any], varied: Sequence[str] = ()) -> str:
    """Mark the setting of a cell: cells with the same mark differ in the method, and what else is varied, alone."""
    kept = {key: value for key, value in resolved.items() if key not in ("method", "plugins", *varied)}
    return json.dumps(kept, sort_keys=True)


def make_comparison(table: str, driven: Driven, bounded: bool = False, spec: ExperimentFile | None = None) -> Outputs:
    """Make a comparison of methods."""
    asked = _methods_of(spec or file_of(table))
    methods = [name for name in taking_part(table) if name in asked or not asked]
    if driven.flows:
        return _compared_flows(table, driven)
    varied = (ORDER,) if table == ORDERS else ()
    paper, metrics = Paper() if varied else read_paper(experiments_dir()), driven.metrics
    blocks: dict[str, list[tuple[Cell, CellResults]]] = {}
    for cell, results in _results(driven):
        blocks.setdefault(setting(cell.resolved, varied), []).append((cell, results))
    found: list[Compared] = []
    bounds = None
    if bounded:
        # Nothing else of a comparison needs scipy's solvers.
        from codriving.commands.above import BoundsOfRun

        bounds = BoundsOfRun(driven.folder)
    for block in blocks.values():
        own = comparison_rows([results for _, results in block], methods, paper)
        found += bounds.over(own, block) if bounds else own
    rows = with_corrected(found)
    swept = tuple(dict.fromkeys(key for block in blocks.values() for _, results in block for key in results.swept))
    whole = comparison_table(rows, swept)
    pages, printed = [], []
    rows = as_orders(rows) if varied else rows
    conditions = conditions_of(rows, subject_of(rows) if varied else METHODS, driven.config_dir)
    further = (*(bounds.notes if bounds else ()), *driven.notes)
    for condition, members in conditions:
        # One table a suite, which its title names.
        keys = tuple(key for key in swept if not condition.name or key != SUITE)
        kept, screen = (
            print_comparison(members, metrics, keys, screen, condition, further) for screen in (False, True)
        )
        against = print_pairs(members, metrics, keys, condition)
        pages += [markdown_text(kept), *([markdown_text(against, level=2)] if against else [])]
        printed += [screen, *([against] if against else [])]
    files = {"comparison.csv": whole.csv().encode(), "comparison.md": "\n".join(pages).encode()}
    if len(conditions) > 1:
        figures = profile_figure([(c.name, members) for c, members in conditions], metrics)
        files |= {f"figures/{name}": content for name, content in figures.items()}
    return Outputs(files, tuple(printed), (whole,))


def conditions_of(
    rows: Sequence[Compared], subject: Subject, config_dir: Path | None = None
) -> list[tuple[Condition, list[Compared]]]:
    """Part the rows of a comparison by suite, if several were driven."""
    groups: dict[str, list[Compared]] = {}
    for row in rows:
        groups.setdefault(row.swept.get(SUITE, ""), []).append(row)
    last, files = next(reversed(groups), ""), choices(SUITE, config_dir)
    return [
        (Condition(name, describe(files[name]) if name in files else "", name == last, subject, tuple(rows)), members)
        for name, members in groups.items()
    ]


def _compared_flows(table: str, driven: Driven) -> Outputs:
    """Make a comparison of methods in flows, in which nothing is paired."""
    cells = [results for _, results in _results(driven)]
    swept = tuple(dict.fromkeys(key for results in cells for key in results.swept))
    rows = [Compared(cell.first.scenario, cell.first.method, cell=cell) for cell in cells]
    notes = (f"{REFERENCE} full goes by the negotiated order.", *subject_of(rows).notes) if table == ORDERS else ()
    notes = (*notes, *driven.notes)
    kept, printed = (print_flows(cells, driven.metrics, swept, notes, screen) for screen in (False, True))
    whole = flow_table(cells, swept)
    files = {"comparison.csv": whole.csv().encode(), "comparison.md": markdown_text(kept).encode()}
    return Outputs(files, (printed,), (whole,))


def make_loads(driven: Driven) -> Outputs:
    """Make the table and the figure of loads."""
    cells = [(int(cell.resolved["scenario"]["cavs"]), results) for cell, results in _results(driven, without=CAVS)]
    loads = list(dict.fromkeys(cavs for cavs, _ in cells))
    rows = load_rows(cells, taking_part(LOAD))
    swept = tuple(dict.fromkeys(key for _, results in cells for key in results.swept))
    table = load_table(rows, loads, swept)
    kept = print_loads(rows, loads, driven.metrics, swept).with_notes(driven.notes)
    *first, last = print_each_load(rows, loads, driven.metrics, swept)
    files = {"load.csv": table.csv().encode(), "load.md": markdown_text(kept).encode()}
    figures = load_figure(rows, loads, driven.metrics, styles())
    files |= {f"figures/{name}": content for name, content in figures.items()}
    return Outputs(files, (*first, last.with_notes(driven.notes)), (table,))


def _results(driven: Driven, without: str = "") -> Iterator[tuple[Cell, CellResults]]:
    dropped = {without}
    if len({_row(cell) for cell in driven.cells}) == len(driven.cells):
        dropped.add(METHOD_CHOICE)
    for cell, records, timings in zip(driven.cells, driven.records, driven.timings, strict=True):
        swept = {key: value for key, value in cell.swept.items() if key not in dropped}
        yield cell, results_of(cell, records, swept, cpu_per_decision(timings))


def _row(cell: Cell) -> tuple[object, ...]:
    """What tells a row from the others without the choice of its method."""
    return (cell.labels, *(pair for pair in cell.swept.items() if pair[0] != METHOD_CHOICE))
