"""``codriving score``: the scores of recorded files, one row each, and of all together."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from statistics import median
from typing import Any

from codriving.datatypes import Score
from codriving.reports.columns import Column, Table, mean, table
from codriving.reports.episodes import number_columns
from codriving.reports.printed import PrintedTable, printed
from codriving.reports.wording import three, two_digits

ALL = "all"

# What is on the screen besides, where a metric measures it.
SHOWN = ("ttc_min", "drac_max", "braking_max", "hard_braking", "hard_braking_cavs")


@dataclass(frozen=True, slots=True)
class ScoredFiles:
    """One file, or several together."""

    name: str
    scores: tuple[Score, ...]
    vehicles: int
    duration: float | None  # Mean of a file [s]
    group: str = ""  # What it is printed with; empty for a row of its own

    @property
    def success(self) -> float | None:
        """Share of the successes; None of flows."""
        return mean([float(score.success) for score in self.scores if score.success is not None])

    @property
    def clean(self) -> float | None:
        """Share of the clean successes, where the metric says."""
        return mean([float(score.clean) for score in self.scores if score.clean is not None])

    @property
    def pets(self) -> list[float]:
        """All PETs [s], those of files without success, too."""
        return [pet.value for score in self.scores for pet in score.pets]

    @property
    def velocities(self) -> list[float]:
        """Mean velocity of every vehicle that counts [m/s]."""
        return [travel.velocity for score in self.scores for travel in score.travels]

    @property
    def numbers(self) -> Mapping[str, float | None]:
        """Mean of each further number, where it is defined."""
        values: dict[str, list[float]] = {}
        for number in (number for score in self.scores for number in score.numbers):
            values.setdefault(number.name, []).extend([] if number.value is None else [number.value])
        return {name: mean(found) for name, found in values.items()}


def together(files: Sequence[ScoredFiles], name: str = ALL) -> ScoredFiles:
    """Put several into one row."""
    durations = [one.duration for one in files if one.duration is not None]
    scores = tuple(score for one in files for score in one.scores)
    return ScoredFiles(name, scores, sum(one.vehicles for one in files), mean(durations))


def score_table(files: Sequence[ScoredFiles]) -> Table:
    """Make the table of all files, in their order, with their sum in the last row."""
    rows = [*files, together(files)]
    known: list[Column[Any]] = [
        Column("file", lambda f: f.name, "file", words=True),
        Column("success", lambda f: f.success, "success", two_digits),
        Column("clean", lambda f: f.clean, "clean", two_digits, sparse=True),
        Column("pet_mean", lambda f: mean(f.pets)),
        Column("pet_max", lambda f: max(f.pets, default=None)),
        Column("pet_min", lambda f: min(f.pets, default=None)),
        Column("pets", _pets, "PET mean/max/min [s]", csv=False),
        Column("velocity_mean", lambda f: mean(f.velocities)),
        Column("velocity_max", lambda f: max(f.velocities, default=None)),
        Column("velocity_min", lambda f: min(f.velocities, default=None)),
        Column("velocities", _velocities, "velocity mean/max/min [m/s]", csv=False),
        Column("pet_count", lambda f: len(f.pets), "PETs"),
        Column("pet_median", lambda f: median(f.pets) if f.pets else None),
        Column("pet_below_1_5", lambda f: mean([float(pet < 1.5) for pet in f.pets])),
        Column("travel_time_mean", lambda f: mean([travel.time for score in f.scores for travel in score.travels])),
        Column("vehicles", lambda f: f.vehicles, "vehicles"),
        Column("duration", lambda f: f.duration, "duration [s]", two_digits),
        Column("files", lambda f: len(f.scores)),
    ]
    numbers = {number.name: number for one in files for score in one.scores for number in score.numbers}
    further = (replace(number, shown=number.shown or name in SHOWN) for name, number in numbers.items())
    return table([*known, *number_columns(further, known)], rows)


def _pets(files: ScoredFiles) -> str:
    return three(mean(files.pets), max(files.pets, default=None), min(files.pets, default=None))


def _velocities(files: ScoredFiles) -> str:
    return three(mean(files.velocities), max(files.velocities, default=None), min(files.velocities, default=None))


def print_scores(files: Sequence[ScoredFiles], metrics: str, notes: Iterable[str]) -> PrintedTable:
    """Prepare the table for people; what belongs together has one row."""
    groups: dict[str, list[ScoredFiles]] = {}
    for one in files:
        groups.setdefault(one.group or one.name, []).append(one)
    rows = [members[0] if len(members) == 1 else together(members, name) for name, members in groups.items()]
    shown = score_table(rows)
    # Of one row all are the same again.
    shown = Table(shown.columns, shown.rows if len(rows) > 1 else shown.rows[:-1])
    blocks = [True] * len(rows) + [False] * (len(rows) > 1)
    return printed(f"scores by metrics={metrics}", shown, blocks, notes, screen=True)


def pet_table(files: Sequence[ScoredFiles]) -> Table:
    """Make a table of every PET."""
    rows = [(one.name, pet) for one in files for score in one.scores for pet in score.pets]
    columns: list[Column[Any]] = [
        Column("file", lambda row: row[0], words=True),
        Column("first", lambda row: row[1].first, words=True),
        Column("second", lambda row: row[1].second, words=True),
        Column("kind", lambda row: row[1].kind, words=True),
        Column("pet", lambda row: row[1].value),
    ]
    return table(columns, rows)
