"""Rows and prints of a few records, for tests that look at one thing in them."""

import io
from collections.abc import Mapping, Sequence

from codriving.datatypes.record import EpisodeRecord
from codriving.reports.columns import Row, Table, table
from codriving.reports.episodes import episode_columns
from codriving.reports.paper import Paper
from codriving.reports.printed import PrintedTable, print_table
from codriving.reports.results import CellResults
from codriving.reports.summary import print_summary, summary_table


def episodes_of(records: Sequence[EpisodeRecord], swept: Mapping[str, str] | None = None) -> Table:
    """The table of the episodes of one cell."""
    cell = CellResults(records, swept or {})
    return table(episode_columns([cell], swept or {}), cell.episodes)


def summary_of(records: Sequence[EpisodeRecord], swept: Mapping[str, str] | None = None) -> Table:
    """The summary of one cell."""
    return summary_table([CellResults(records, swept or {})], list(swept or {}))


def summary_row(records: Sequence[EpisodeRecord], swept: Mapping[str, str] | None = None) -> Row:
    """The row of one cell in the summary."""
    return summary_of(records, swept).rows[0]


def print_cells(*cells: Sequence[EpisodeRecord], paper: Paper | None = None, screen: bool = False) -> PrintedTable:
    """The printed summary of cells."""
    return print_summary([CellResults(records) for records in cells], paper or Paper(), screen=screen)


def printed_text(table: PrintedTable) -> str:
    """What a pipe gets."""
    stream = io.StringIO()
    print_table(table, stream)
    return stream.getvalue()


def column_of(table: PrintedTable, head: str) -> list[str]:
    """All cells below a head."""
    return [row.cells[table.columns.index(head)] for row in table.rows]
