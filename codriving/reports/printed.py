"""Tables as people read them: plain and never cut in a pipe, fitted to a terminal, or Markdown."""

import sys
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import TextIO, TypeAlias

from codriving.reports.columns import Row, Table
from codriving.reports.fitting import Drawn, Fitted, fit, record, upright

_PIPE_WIDTH = 1000  # Columns of a pipe: wide enough that nothing wraps

LEFT_OUT = "Left out at this width: {}; the files of the run folder have them."
CUT = "The first value alone is shown of: {}."

_Line: TypeAlias = tuple[str, str]  # A line and its style


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
    ranks: tuple[int, ...]  # When each column gives way on a narrow terminal
    briefs: tuple[tuple[str, str] | None, ...]  # The short form of each there

    def with_notes(self, notes: Iterable[str]) -> "PrintedTable":
        """Say more below it."""
        return replace(self, notes=(*self.notes, *notes))

    @property
    def shapes(self) -> tuple[Drawn, ...]:
        """The columns as a terminal draws them."""
        return tuple(
            Drawn(
                head,
                tuple(" ".join(row.cells[index].split()) for row in self.rows),
                head in self.words,
                self.ranks[index],
                self.briefs[index],
            )
            for index, head in enumerate(self.columns)
        )


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
    heads, ranks, briefs = (tuple(getattr(column, name) for column in shown) for name in ("head", "rank", "brief"))
    return PrintedTable(title, heads, words, tuple(made), tuple(notes), ranks, briefs)


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
    """Print a table: whole in a pipe, within the width of a terminal."""
    from rich.console import Console
    from rich.text import Text

    stream = stream or sys.stdout
    terminal = stream.isatty()
    console = Console(file=stream, highlight=False, width=None if terminal else _PIPE_WIDTH)
    lines, further = _terminal_lines(table, console.width) if terminal else (_pipe_lines(table), [])
    console.print(Text(table.title, style="bold"))
    for text, style in lines:
        console.print(Text(text, style=style, no_wrap=True, overflow="ignore"), crop=False)
    for note in [*table.notes, *further]:
        console.print(Text(note, style="dim"))


def _pipe_lines(table: PrintedTable) -> list[_Line]:
    shapes = table.shapes
    whole = Fitted(shapes, tuple(max(map(len, (shape.head, *shape.cells))) for shape in shapes))
    lines = [*whole.head(), *(line for index in range(len(table.rows)) for line in whole.row(index))]
    return [(line, "") for line in lines]


def _terminal_lines(table: PrintedTable, room: int) -> tuple[list[_Line], list[str]]:
    """Draw a table for a terminal; gives the lines with their styles, and notes on what is not shown."""
    fitted = fit(table.shapes, room)
    changed = fitted is None or fitted.left_out or fitted.columns != table.shapes
    if changed and sum(row.ours for row in table.rows) == 1 and (turned := upright(table.shapes, room)):
        body = [line for index in range(len(turned.columns[0].cells)) for line in turned.row(index)]
        return [("", ""), *((line, "bold") for line in turned.head()), *((line, "") for line in body), ("", "")], []
    lines: list[_Line] = [("", "")]
    if fitted is None:
        for index, row in enumerate(table.rows):
            lines += [*((line, _style(row)) for line in record(table.shapes, index, room)), ("", "")]
        return lines, []
    lines += [*((line, "bold") for line in fitted.head()), ("\u2500" * fitted.width, "")]
    for index, row in enumerate(table.rows):
        lines += [(line, _style(row)) for line in fitted.row(index)]
        lines += [("", "")] if row.last or index == len(table.rows) - 1 else []
    notes = [(CUT, fitted.cut), (LEFT_OUT, fitted.left_out)]
    return lines, [text.format(", ".join(heads)) for text, heads in notes if heads]


def _style(row: PrintedRow) -> str:
    return "" if row.ours else "dim"
