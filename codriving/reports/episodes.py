"""``episodes.csv`` and ``timing.csv``: one row an episode; the latter alone differs from run to run."""

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from codriving.datatypes import Ending, EpisodeRecord, NamedNumber
from codriving.reports.columns import Column, mean, swept_columns
from codriving.reports.results import LABELS, CellResults, ScoredEpisode, counter_names, named_numbers
from codriving.reports.wording import two_digits
from codriving.runs import Timing

# The columns that users rely on, in their fixed order.
LEADING: tuple[Column[ScoredEpisode], ...] = (
    *(column.of(lambda e: e.record) for column in LABELS),
    Column("seed", lambda e: e.record.seed),
    Column("outcome", lambda e: e.record.outcome.ending.value, words=True),
    Column("pet_mean", lambda e: mean(e.pets)),
    Column("pet_min", lambda e: min(e.pets, default=None)),
    Column("velocity_mean", lambda e: mean(e.velocities)),
    # How long something lasted that broke off says nothing.
    Column("duration", lambda e: None if e.record.outcome.ending is Ending.ERROR else e.record.outcome.time),
)

FURTHER: tuple[Column[ScoredEpisode], ...] = (
    Column("pet_count", lambda e: len(e.pets) if e.score else None),
    Column("travel_time_mean", lambda e: mean(e.times)),
    Column("delay_mean", lambda e: mean(e.delays)),
    Column("cavs", lambda e: sum(p.kind == "CAV" for p in e.record.participants)),
    Column("hdvs", lambda e: sum(p.kind == "HDV" for p in e.record.participants)),
    Column("arrived", lambda e: len(e.record.outcome.arrivals)),
    Column("decisions", lambda e: e.record.decisions),
    Column("collision_pair", lambda e: c.pair if (c := e.record.outcome.collision) else None, words=True),
    Column("striker", lambda e: c.striker if (c := e.record.outcome.collision) else None, words=True),
    Column("struck", lambda e: c.struck if (c := e.record.outcome.collision) else None, words=True),
    Column("bystander_collisions", lambda e: len(e.record.outcome.bystander_collisions)),
    Column("off_road", lambda e: " ".join(e.record.outcome.off_road) or None, words=True),
    Column("clean", lambda e: None if e.clean is None else int(e.clean)),
    Column("message", lambda e: e.record.outcome.message or None, words=True),
)

# What was recalled from; only where something was.
MEMORY: Column[ScoredEpisode] = Column("memory", lambda e: e.record.memory or None, words=True)


def episode_columns(cells: Sequence[CellResults], swept: Iterable[str] = ()) -> list[Column[Any]]:
    """Give the columns of ``episodes.csv``: fixed ones, swept keys, numbers of metrics, and the counters of methods."""
    records = [record for cell in cells for record in cell.records]
    known: list[Column[Any]] = [*LEADING, *swept_columns(swept), *FURTHER]
    known += [MEMORY] if any(record.memory for record in records) else []
    known += number_columns(named_numbers(cells), known)
    return [*known, *counter_columns(records, known)]


def number_columns(numbers: Iterable[NamedNumber], known: Iterable[Column[Any]]) -> list[Column[Any]]:
    """Give the columns of further numbers of metrics, of what has a mapping `numbers`."""
    taken = {column.key for column in known}

    def column(number: NamedNumber) -> Column[Any]:
        key = f"metric_{number.name}" if number.name in taken else number.name
        head = number_head(number) if number.shown else ""
        return Column(key, lambda item: item.numbers.get(number.name), head, two_digits, rank=5)

    return [column(number) for number in numbers]


def number_head(number: NamedNumber) -> str:
    """Name a number with its unit."""
    return number.name.replace("_", " ") + (f" [{number.unit}]" if number.unit else "")


def counter_columns(records: Sequence[EpisodeRecord], known: Iterable[Column[Any]]) -> list[Column[Any]]:
    """Give the columns of counters, of what has a mapping `counters`; one never takes the place of another column."""

    def column(name: str) -> Column[Any]:
        return Column(name, lambda item: item.counters.get(name))

    taken = {column.key for column in known}
    return [column(name) for name in counter_names(records) if name not in taken]


class TimedEpisode(NamedTuple):
    """An episode and what it cost; None where that is lost."""

    record: EpisodeRecord
    timing: Timing | None
    swept: Mapping[str, str]


def timing_columns(swept: Iterable[str] = ()) -> list[Column[Any]]:
    """Give the columns of ``timing.csv``; times are in seconds."""
    labels = [column.of(lambda e: e.record) for column in (*LABELS, Column[EpisodeRecord]("seed", lambda r: r.seed))]
    measured: list[Column[TimedEpisode]] = [
        Column("seconds", lambda e: e.timing.seconds if e.timing else None),
        Column("decisions", lambda e: e.record.decisions),
        Column("decision_seconds_mean", lambda e: e.timing.decision_mean if e.timing else None),
        Column("decision_seconds_max", lambda e: e.timing.decision_max if e.timing else None),
        Column("decision_cpu_mean", lambda e: e.timing.decision_cpu_mean if e.timing else None),
        Column("decision_cpu_max", lambda e: e.timing.decision_cpu_max if e.timing else None),
    ]
    return [*labels, *swept_columns(swept), *measured]


def cpu_per_decision(timings: Iterable[Timing | None]) -> float | None:
    """Give the CPU time of a decision [s], over all decisions of a cell; None where nothing was measured."""
    return _mean([(t.decisions, t.decision_cpu_mean) for t in timings if t and t.decision_cpu_mean is not None])


def _mean(known: Sequence[tuple[int, float]]) -> float | None:
    """The mean over all decisions of episodes of which number of decisions and mean are known."""
    decisions = sum(number for number, _ in known)
    return math.fsum(number * mean for number, mean in known) / decisions if decisions else None
