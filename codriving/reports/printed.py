"""Tables as people read them: plain and never cut in a pipe, fitted to a terminal, or Markdown."""

import sys
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Literal, TextIO

from codriving.reports.columns import Row, Table

_PIPE_WIDTH = 1000  # Columns of a pipe: wide enough that nothing wraps

_GAP = 2  # Characters between two columns on a terminal


@dataclass(frozen=True, slots=True)
class PrintedRow:
    """One printed row."""

    cells: tuple[str, ...]
    ours: bool = True  # Whether it was measured here; the paper's own are dim
    last: bool = False  # Whether a block ends with it


@dataclass(frozen=True, slots=True)
class PrintedTable:
    """A table that only has to be drawn."""

    title: str
    columns: tuple[str, ...]
    words: frozenset[str]  # Heads of the columns that stand left
    rows: tuple[PrintedRow, ...]
    notes: tuple[str, ...]


def printed(
    title: str,
    table: Table,
    blocks: Iterable[object],
    notes: Iterable[str],
    theirs: Mapping[int, Row] = MappingProxyType({}),
    screen: bool = False,
) -> PrintedTable:
    """Prepare a table for people."""
    shown = [
        c
        for c in table.columns
        if c.head and (c.page or screen) and (not c.sparse or any(row.get(c.key) for row in table.rows))
    ]
    made: list[PrintedRow] = []
    previous: object = None
    for index, (block, row) in enumerate(zip(blocks, table.rows, strict=True)):
        if made and block != previous:
            made[-1] = replace(made[-1], last=True)
        previous = block
        for values in [row, theirs[index]] if index in theirs else [row]:
            made.append(PrintedRow(tuple(column.text(values.get(column.key)) for column in shown), values is row))
    words = frozenset(column.head for column in shown if column.words)
    return PrintedTable(title, tuple(column.head for column in shown), words, tuple(made), tuple(notes))


def markdown_text(table: PrintedTable, level: int = 1) -> str:
    """Write a table as Markdown, for a page or an issue: ``summary.md`` and its like."""
    rules = ["---" if head in table.words else "---:" for head in table.columns]
    lines = [f"{'#' * level} {table.title}", "", _markdown_row(table.columns), _markdown_row(rules)]
    for row in table.rows:
        cells = [cell.replace("|", "\\|").replace("\n", " ") for cell in row.cells]
        lines.append(_markdown_row([cell if row.ours or not cell else f"*{cell}*" for cell in cells]))
    return "\n".join([*lines, "", *table.notes]) + "\n"


def _markdown_row(cells: Iterable[str]) -> str:
    return f"| {' | '.join(cells)} |"


def print_table(table: PrintedTable, stream: TextIO | None = None) -> None:
    """Print a table."""
    from rich import box
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    stream = stream or sys.stdout
    terminal = stream.isatty()
    console = Console(file=stream, highlight=False, width=None if terminal else _PIPE_WIDTH)
    drawn = Table(
        box=box.SIMPLE_HEAD if terminal else None,
        pad_edge=False,
        padding=(0, 1) if terminal else (0, 2, 0, 0),
        collapse_padding=terminal,
    )
    widths = _widths(table, console.width - _GAP * len(table.columns))
    for head, width in zip(table.columns, widths, strict=True):
        justify: Literal["left", "right"] = "left" if head in table.words else "right"
        drawn.add_column(Text(head), justify=justify, width=width if terminal else None)
    for row in table.rows:
        drawn.add_row(*map(Text, row.cells), style=None if row.ours else "dim", end_section=row.last)
    # What the terminal breaks can be read, what is cut cannot.
    console.width = max(console.width, sum(widths) + _GAP * len(widths))
    # Not as the table's own title, which would be padded to its width and wrapped to it.
    console.print(Text(table.title, style="bold"))
    console.print(drawn)
    for note in table.notes:
        console.print(Text(note, style="dim"))


def _widths(table: PrintedTable, room: int) -> list[int]:
    """Share a terminal's width among the columns: numbers may go into several lines, no word is broken."""
    columns = [[head, *(row.cells[index] for row in table.rows)] for index, head in enumerate(table.columns)]
    widths = [max(map(len, texts)) for texts in columns]
    least = [max(len(word) for text in texts for word in text.split() or [""]) for texts in columns]
    # What tells the rows apart stays whole.
    first_number = next((i for i, head in enumerate(table.columns) if head not in table.words), 0)
    labels = table.columns.index("episodes") if "episodes" in table.columns else first_number
    least[:labels] = widths[:labels]
    while sum(widths) > room and widths != least:
        widest = max(range(len(widths)), key=lambda i: widths[i] - least[i])
        widths[widest] -= 1
    return widths
