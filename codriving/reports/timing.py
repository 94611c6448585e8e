"""``timing.csv``: what the episodes cost in time; the only table that differs from run to run."""

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from codriving.datatypes.record import EpisodeRecord
from codriving.reports.columns import Column, swept_columns
from codriving.reports.results import LABELS
from codriving.runs.episode_folder import Timing


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


def seconds_per_decision(timings: Iterable[Timing | None]) -> float | None:
    """Give the wall-clock time of a decision [s], over all decisions of a cell; None where nothing was measured."""
    return _mean([(t.decisions, t.decision_mean) for t in timings if t and t.decision_mean is not None])


def cpu_per_decision(timings: Iterable[Timing | None]) -> float | None:
    """Give the CPU time of a decision [s], over all decisions of a cell; None where nothing was measured."""
    return _mean([(t.decisions, t.decision_cpu_mean) for t in timings if t and t.decision_cpu_mean is not None])


def _mean(known: Sequence[tuple[int, float]]) -> float | None:
    """The mean over all decisions of episodes of which number of decisions and mean are known."""
    decisions = sum(number for number, _ in known)
    return math.fsum(number * mean for number, mean in known) / decisions if decisions else None
