"""What a command makes of its episodes beyond the tables of every run."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from codriving.datatypes.record import EpisodeRecord
from codriving.experiment.cells import Cell
from codriving.reports.columns import Table
from codriving.reports.printed import PrintedTable
from codriving.runs.atomic import whole_file
from codriving.runs.episode_folder import Timing


@dataclass(frozen=True, slots=True)
class Driven:
    """All episodes of a run.

    Attributes:
        timings: What each of them cost, None where that is lost.
    """

    cells: Sequence[Cell]
    records: Sequence[Sequence[EpisodeRecord]]
    timings: Sequence[Sequence[Timing | None]]
    folder: Path = Path()

    @property
    def metrics(self) -> str:
        """Name of the definitions by which they were scored."""
        return ", ".join(dict.fromkeys(cell.metrics for cell in self.cells))


@dataclass(frozen=True, slots=True)
class Further:
    """What was made of them."""

    files: Mapping[str, bytes] = field(default_factory=dict)
    displays: tuple[PrintedTable, ...] = ()
    tables: tuple[Table, ...] = ()

    def write(self, folder: Path) -> None:
        """Write the files, each whole or not at all.

        Raises:
            OSError: If it cannot be written.
        """
        for name, content in self.files.items():
            path = folder / name
            path.parent.mkdir(exist_ok=True)
            with whole_file(path, beside=folder) as partial:
                partial.write_bytes(content)
