"""Rows against columns: the success of each row of an experiment in each column, and each against the first row."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from codriving.reports.columns import Column, Value, table
from codriving.reports.comparison import Compared, Condition, print_pairs
from codriving.reports.printed import PrintedTable, printed
from codriving.reports.results import CellResults
from codriving.reports.subject import Subject
from codriving.reports.wording import title

INTERVALS = "In brackets: Wilson 95 % intervals [%]. After the comma: clean success, without a near miss."


@dataclass(frozen=True)
class GridRow:
    """A row of an experiment."""

    name: str
    cells: Mapping[str, CellResults]  # Its cell in each column


def grid(rows: Sequence[GridRow], columns: Sequence[str], metrics: str) -> PrintedTable:
    """Prepare the table of success."""
    cells = [cell for row in rows for cell in row.cells.values()]

    def success(column: str) -> Column[Any]:
        return Column(column, lambda row: _rate(row.cells.get(column)), column or "success [%]", csv=False)

    heading = title("rows and columns", [c.first.scenario for c in cells], [c.first.reasoner for c in cells], metrics)
    made = table([Column("row", lambda row: row.name, "row", words=True), *map(success, columns)], rows)
    return printed(heading, made, [None] * len(rows), (INTERVALS,))


def _rate(cell: CellResults | None) -> Value:
    if cell is None:
        return ""
    share, low, high = cell.success
    if share is None or low is None or high is None:
        return "-"
    told, clean = f"{100 * share:.0f} ({100 * low:.0f} to {100 * high:.0f})", cell.clean[0]
    return told if clean is None else f"{told}, {100 * clean:.0f}"


def against_first(rows: Sequence[Compared], metrics: str, swept: Sequence[str], first: str) -> PrintedTable | None:
    """Prepare the table of what each row has more or less than the first one, on the same seeds."""
    return print_pairs(rows, metrics, swept, Condition("", "", True, Subject("rows", "row", first), tuple(rows)))
