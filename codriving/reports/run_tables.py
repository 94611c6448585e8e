"""All tables of a run from its records, and their files."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from codriving.datatypes.record import EpisodeRecord
from codriving.reports.display import Display, display
from codriving.reports.episodes_table import TEXT, episode_columns, episode_rows
from codriving.reports.markdown import markdown_text
from codriving.reports.paper import Paper
from codriving.reports.rows import Row, csv_text
from codriving.reports.summary import summary_columns, summary_row
from codriving.storage.atomic import write_text

if TYPE_CHECKING:
    from pandas import DataFrame


@dataclass(frozen=True, slots=True)
class Table:
    """Columns and rows.

    Attributes:
        columns: Columns in order.
        rows: The rows.
    """

    columns: tuple[str, ...]
    rows: tuple[Row, ...]

    def csv(self) -> str:
        """Write it as CSV."""
        return csv_text(self.columns, self.rows)

    def frame(self) -> "DataFrame":
        """Give it as a data frame; numbers that are not defined are NaN."""
        from pandas import DataFrame, to_numeric

        frame = DataFrame([[row.get(column) for column in self.columns] for row in self.rows], columns=self.columns)
        for column in self.columns:
            if column not in TEXT:
                frame[column] = to_numeric(frame[column])
        return frame


@dataclass(frozen=True, slots=True)
class RunTables:
    """The tables of one run.

    Attributes:
        episodes: One row an episode.
        summary: One row a cell.
        display: The summary as people read it.
    """

    episodes: Table
    summary: Table
    display: Display


def run_tables(cells: Sequence[Sequence[EpisodeRecord]], paper: Paper, metrics: str = "standard") -> RunTables:
    """Make all tables of a run.

    Args:
        cells: The records of each cell, by seed; cells in the order of the tables, none of them empty.
        paper: The paper's numbers.
        metrics: Name of the definitions by which they were scored.

    Returns:
        The tables; they depend on nothing else.
    """
    records = [record for cell in cells for record in cell]
    rows = tuple(summary_row(cell) for cell in cells)
    return RunTables(
        episodes=Table(episode_columns(records), tuple(episode_rows(records))),
        summary=Table(summary_columns(records), rows),
        display=display(rows, paper, metrics),
    )


def write_tables(tables: RunTables, folder: Path) -> None:
    """Write ``episodes.csv``, ``summary.csv`` and ``summary.md``.

    Args:
        tables: What to write.
        folder: The run folder.

    Raises:
        OSError: If the folder cannot be written.
    """
    write_text(folder / "episodes.csv", tables.episodes.csv())
    write_text(folder / "summary.csv", tables.summary.csv())
    write_text(folder / "summary.md", markdown_text(tables.display))
