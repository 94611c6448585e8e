"""`codriving compare filters`: each method with and without the safety check behind it, so that nothing else varies."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from codriving.config import Point, compose, expand, parse
from codriving.errors import ConfigError
from codriving.experiment import Cell, Driven, Outputs, results_of
from codriving.reports import REFERENCE, CellResults, FilterRow, filter_rows, filter_table, markdown_text, print_filters

FILTER = "filter"  # The key that varies

NO_FLOWS = (
    "codriving compare filters pairs episodes, and in flows nothing is paired; write for instance codriving run "
    "method=ppo filter=false,true flow=steady"
)


def filter_points(
    base: Sequence[str], overrides: Sequence[str], methods: Sequence[str], config_dir: Path | None
) -> list[Point]:
    """Give the cells: each method as it is, then behind the safety check; the reference once, if it has the check.

    Args:
        base: Tokens that come first.
        overrides: What the user typed, ``method=`` apart.
    """
    if any(parse(token).key_or_group == FILTER for token in overrides):
        raise ConfigError("codriving compare filters sets filter itself; leave filter= out, or use codriving run")
    both, points = ("false", "true"), []
    for point in expand(overrides, config_dir):
        checked = compose(point.overrides, config_dir)["cda"].get("safety_check", True)
        for name in methods:
            for value in both[:1] if checked and name == REFERENCE else both:
                tokens = (*base, *point.overrides, f"{FILTER}={value}", f"method={name}")
                points.append(Point(tokens, {**point.swept, "method": name, FILTER: value}, point.removed))
    return points


def make_filters(driven: Driven) -> Outputs:
    """Make the table of methods with and without the safety check."""
    rows = filter_rows(_pairs(driven))
    swept = tuple(dict.fromkeys(key for row in rows for key in row.plain.swept))
    table, display = filter_table(rows, swept), print_filters(rows, driven.metrics, swept).with_notes(driven.notes)
    files = {"filters.csv": table.csv().encode(), "filters.md": markdown_text(display).encode()}
    return Outputs(files, (display,), (table,))


def _pairs(driven: Driven) -> list[FilterRow]:
    """Put the two cells of each method into a row."""
    plain: dict[tuple[object, ...], CellResults] = {}
    behind: dict[tuple[object, ...], CellResults] = {}
    for cell, records in zip(driven.cells, driven.records, strict=True):
        swept = {key: value for key, value in cell.swept.items() if key != FILTER}
        found = behind if cell.resolved.get(FILTER) is not None else plain
        found[_row(cell, swept)] = results_of(cell, records, swept)
    return [FilterRow(cell, behind.get(row)) for row, cell in plain.items()]


def _row(cell: Cell, swept: Mapping[str, str]) -> tuple[object, ...]:
    """What two cells have in common that differ in the filter alone."""
    labels = cell.labels
    chosen = cell.choices.get("method")
    return (labels.scenario, labels.method, labels.reasoner, chosen, *swept.items())
