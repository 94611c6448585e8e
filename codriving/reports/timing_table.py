"""``timing.csv``: what the episodes cost in time; the only table that differs from run to run."""

import math
from collections.abc import Iterable, Mapping, Sequence

from codriving.datatypes.record import EpisodeRecord
from codriving.reports.rows import Row
from codriving.runs.timing import Timing

LEADING = ("scenario", "method", "variant", "reasoner", "seed")

MEASURED = (
    "seconds",
    "decisions",
    "decision_seconds_mean",
    "decision_seconds_max",
    "decision_cpu_mean",
    "decision_cpu_max",
)


def timing_columns(swept: Sequence[str] = ()) -> tuple[str, ...]:
    """Give the columns of ``timing.csv``."""
    return (*LEADING, *swept, *MEASURED)


def timing_rows(
    timed: Iterable[tuple[EpisodeRecord, Timing | None]], swept: Mapping[str, str] | None = None
) -> list[Row]:
    """Give the rows of one cell in ``timing.csv``.

    Args:
        timed: Each record with its timing, None where that is lost.

    Returns:
        One row a record [s].
    """
    return [
        {
            **(swept or {}),
            "scenario": record.scenario,
            "method": record.method,
            "variant": record.variant,
            "reasoner": record.reasoner,
            "seed": record.seed,
            "seconds": timing.seconds if timing else None,
            "decisions": record.decisions,
            "decision_seconds_mean": timing.decision_mean if timing else None,
            "decision_seconds_max": timing.decision_max if timing else None,
            "decision_cpu_mean": timing.decision_cpu_mean if timing else None,
            "decision_cpu_max": timing.decision_cpu_max if timing else None,
        }
        for record, timing in timed
    ]


def seconds_per_decision(timings: Iterable[Timing | None]) -> float | None:
    """Give the wall-clock time that one decision took, over all decisions of a cell.

    Args:
        timings: Timing of each episode, None where that is lost.

    Returns:
        The mean [s], or None where nothing was measured.
    """
    return _mean([(t.decisions, t.decision_mean) for t in timings if t and t.decision_mean is not None])


def cpu_per_decision(timings: Iterable[Timing | None]) -> float | None:
    """Give the CPU time that one decision took, over all decisions of a cell.

    Args:
        timings: Timing of each episode, None where that is lost.

    Returns:
        The mean [s], or None where nothing was measured.
    """
    return _mean([(t.decisions, t.decision_cpu_mean) for t in timings if t and t.decision_cpu_mean is not None])


def _mean(known: Sequence[tuple[int, float]]) -> float | None:
    """The mean over all decisions of episodes of which number of decisions and mean are known."""
    decisions = sum(number for number, _ in known)
    return math.fsum(number * mean for number, mean in known) / decisions if decisions else None
