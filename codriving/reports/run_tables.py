"""All tables of a run from its records, and their files."""

from collections.abc import Mapping, Sequence
from contextlib import suppress
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
from codriving.runs.atomic import write_text

if TYPE_CHECKING:
    from pandas import DataFrame


@dataclass(frozen=True, slots=True)
class Table:
    """Columns and rows."""

    columns: tuple[str, ...]
    rows: tuple[Row, ...]
    swept: tuple[str, ...] = ()
    text: frozenset[str] = TEXT

    def csv(self) -> str:
        """Write it as CSV."""
        return csv_text(self.columns, self.rows)

    def frame(self) -> "DataFrame":
        """Give it as a data frame; numbers that are not defined are NaN."""
        from pandas import DataFrame, to_numeric

        frame = DataFrame([[row.get(column) for column in self.columns] for row in self.rows], columns=self.columns)
        for column in self.columns:
            if column in self.swept:
                # A key may take words as well as numbers.
                with suppress(ValueError, TypeError):
                    frame[column] = to_numeric(frame[column])
            elif column not in self.text:
                frame[column] = to_numeric(frame[column])
        return frame


@dataclass(frozen=True, slots=True)
class RunTables:
    """The tables of one run.

    Attributes:
        display: The summary as people read it, of ``summary.md``.
    """

    episodes: Table
    summary: Table
    display: Display
    printed: Display


def run_tables(
    cells: Sequence[Sequence[EpisodeRecord]],
    paper: Paper,
    metrics: str = "standard",
    swept: Sequence[Mapping[str, str]] = (),
    notes: Sequence[str] = (),
    seconds: Sequence[float | None] = (),
) -> RunTables:
    """Make all tables of a run.

    Args:
        seconds: Wall-clock time of a decision step in each cell [s], None where that is lost; nothing where it is not
            to be shown.
    """
    values = swept or [{}] * len(cells)
    keys = tuple(dict.fromkeys(key for cell in values for key in cell))
    records = [record for cell in cells for record in cell]
    episodes = [row for cell, value in zip(cells, values, strict=True) for row in episode_rows(cell, value)]
    rows = tuple(summary_row(cell, value) for cell, value in zip(cells, values, strict=True))
    return RunTables(
        episodes=Table(episode_columns(records, keys), tuple(episodes), keys),
        summary=Table(summary_columns(records, keys), rows, keys),
        display=display(rows, paper, metrics, keys, notes),
        printed=display(rows, paper, metrics, keys, notes, seconds),
    )


def write_tables(tables: RunTables, folder: Path) -> None:
    """Write ``episodes.csv``, ``summary.csv`` and ``summary.md``.

    Raises:
        OSError: If the folder cannot be written.
    """
    write_text(folder / "episodes.csv", tables.episodes.csv())
    write_text(folder / "summary.csv", tables.summary.csv())
    write_text(folder / "summary.md", markdown_text(tables.display))
