"""The summary on a terminal; plain and never cut when piped."""

import sys
from typing import Literal, TextIO

from codriving.reports.display import Display

_PIPE_WIDTH = 1000
"""Columns of a pipe: wide enough that nothing wraps."""

_GAP = 2
"""Characters between two columns on a terminal."""


def print_table(table: Display, stream: TextIO | None = None) -> None:
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
    for line in table.lines:
        drawn.add_row(*(Text(cell) for cell in line.cells), style=None if line.ours else "dim", end_section=line.last)
    # What the terminal breaks can be read, what is cut cannot.
    console.width = max(console.width, sum(widths) + _GAP * len(widths))
    # Not as the table's own title, which would be padded to its width and wrapped to it.
    console.print(Text(table.title, style="bold"))
    console.print(drawn)
    for note in table.notes:
        console.print(Text(note, style="dim"))


def _widths(table: Display, room: int) -> list[int]:
    """Share a terminal's width among the columns: numbers may go into several lines, no word is broken."""
    columns = [[head, *cells] for head, cells in zip(table.columns, _transposed(table), strict=True)]
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


def _transposed(table: Display) -> list[tuple[str, ...]]:
    return [tuple(line.cells[index] for line in table.lines) for index in range(len(table.columns))]
