"""All tables of a run from its records, and their files."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from codriving.reports.columns import Table, table
from codriving.reports.episodes import episode_columns
from codriving.reports.paper import Paper
from codriving.reports.printed import PrintedTable, markdown_text
from codriving.reports.results import CellResults
from codriving.reports.summary import print_summary, summary_table
from codriving.runs.atomic import write_text


@dataclass(frozen=True, slots=True)
class RunTables:
    """The tables of one run.

    Attributes:
        page: The summary as people read it, of ``summary.md``.
        printed: The same for the screen, with times.
    """

    episodes: Table
    summary: Table
    page: PrintedTable
    printed: PrintedTable

    def write(self, folder: Path) -> None:
        """Write ``episodes.csv``, ``summary.csv`` and ``summary.md``.

        Raises:
            OSError: If the folder cannot be written.
        """
        write_text(folder / "episodes.csv", self.episodes.csv())
        write_text(folder / "summary.csv", self.summary.csv())
        write_text(folder / "summary.md", markdown_text(self.page))


def run_tables(
    cells: Sequence[CellResults], paper: Paper, metrics: str = "standard", notes: Iterable[str] = ()
) -> RunTables:
    """Make all tables of a run."""
    swept = tuple(dict.fromkeys(key for cell in cells for key in cell.swept))
    notes = tuple(notes)
    return RunTables(
        table(episode_columns(cells, swept), [episode for cell in cells for episode in cell.episodes]),
        summary_table(cells, swept),
        print_summary(cells, paper, metrics, swept, notes),
        print_summary(cells, paper, metrics, swept, notes, screen=True),
    )
