"""Scores of files and runs as data frames."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

from codriving.api.page import page_of
from codriving.commands import Scored
from codriving.reports import pet_table, score_table

if TYPE_CHECKING:
    from pandas import DataFrame


@dataclass(frozen=True, eq=False)
class Scores:
    """What was measured."""

    table: "DataFrame"  # A row a file or episode, and one of ``all``
    pets: "DataFrame"  # A row a PET
    notes: tuple[str, ...]  # What has to be said of them
    metric: str

    @classmethod
    def of(cls, scored: Scored) -> "Scores":
        """Make frames of scores."""
        files = scored.files
        return cls(score_table(files).frame(), pet_table(files).frame(), tuple(scored.notes), scored.metric)

    def __repr__(self) -> str:
        return f"<{self._heading}; .table, .pets, .notes>"

    def _repr_html_(self) -> str:
        return page_of(self._heading, self.table, self.notes)

    @property
    def _heading(self) -> str:
        number = len(self.table) - 1
        return f"scores of {number} file{'s' * (number != 1)} by metrics={self.metric}"
