"""What a report is of: runs, their rows, and the episodes of each."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from urllib.parse import quote

from codriving.datatypes import EpisodeRecord, Road
from codriving.geometry import RoadMap, road_map
from codriving.reports import CellResults, stored_results
from codriving.runs import CellEntry, Manifest


@dataclass(frozen=True, slots=True)
class ReportedEpisode:
    """An episode of a run folder."""

    record: EpisodeRecord
    folder: Path


@dataclass(frozen=True)
class ReportedRow:
    """One cell of a run, with the episodes that are there."""

    cell: CellEntry
    road: Road
    episodes: tuple[ReportedEpisode, ...]
    run: str = ""  # Name of its run, where there are several
    alone: bool = False  # Whether each run has one row, so that the run says which it is

    @cached_property
    def road_map(self) -> RoadMap:
        """The geometry of its road."""
        return road_map(self.road)

    @property
    def name(self) -> str:
        """What it is called beside others."""
        if self.run and self.alone:
            return self.run
        return f"{self.run}: {self.cell.folder}" if self.run else self.cell.folder

    @property
    def seeds(self) -> Mapping[int, ReportedEpisode]:
        """Its episodes by seed."""
        return {episode.record.seed: episode for episode in self.episodes}

    @cached_property
    def results(self) -> CellResults:
        """Its episodes as tables take them."""
        swept = {**({"run": self.run} if self.run else {}), **self.cell.swept}
        return stored_results([episode.record for episode in self.episodes], swept)

    def key(self, seed: int) -> str:
        """The name of an episode in links."""
        return quote("/".join(filter(None, (self.run, self.cell.folder, str(seed)))), safe="/")


@dataclass(frozen=True, slots=True)
class ReportedRun:
    """A run folder."""

    name: str
    manifest: Manifest
    rows: tuple[ReportedRow, ...]


def pairs(runs: Sequence[ReportedRun]) -> list[tuple[ReportedRow, ReportedRow]]:
    """Choose which rows are set against each other: those of the first run, or its first one, against the others."""
    if len(runs) == 1:
        found = []
        for row in runs[0].rows:
            first = next(one for one in runs[0].rows if one.cell.scenario == row.cell.scenario)
            found += [(first, row)] if first is not row else []
        return found
    found = []
    for row in (row for run in runs[1:] for row in run.rows):
        alike = [one for one in runs[0].rows if one.cell.scenario == row.cell.scenario]
        named = [one for one in alike if one.cell.folder == row.cell.folder]
        found += [(one, row) for one in (named or (alike if len(alike) == 1 else []))]
    return found
