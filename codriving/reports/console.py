"""The summary on a terminal; plain and never cut when piped."""

import sys
from typing import TextIO

from codriving.reports.display import Display

_PIPE_WIDTH = 240
"""Columns of a pipe: wide enough that nothing wraps."""


def print_table(table: Display, stream: TextIO | None = None) -> None:
    """Print a table.

    Args:
        table: What to print.
        stream: Where; standard output by default.
    """
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
    )
    for index, head in enumerate(table.columns):
        words = index < table.words or head == "the paper says"
        drawn.add_column(Text(head), justify="left" if words else "right")
    for line in table.lines:
        drawn.add_row(*(Text(cell) for cell in line.cells), style=None if line.ours else "dim")
    # Not as the table's own title, which would be padded to its width and wrapped to it.
    console.print(Text(table.title, style="bold"))
    console.print(drawn)
    for note in table.notes:
        console.print(Text(note, style="dim"))
