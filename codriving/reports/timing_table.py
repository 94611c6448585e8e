"""``timing.csv``: what the episodes cost in wall-clock time; the only table that differs from run to run."""

from collections.abc import Iterable

from codriving.datatypes.record import EpisodeRecord
from codriving.reports.rows import Row
from codriving.storage.timing import Timing

COLUMNS = (
    "scenario",
    "method",
    "variant",
    "reasoner",
    "seed",
    "seconds",
    "decisions",
    "decision_seconds_mean",
    "decision_seconds_max",
)


def timing_rows(timed: Iterable[tuple[EpisodeRecord, Timing | None]]) -> list[Row]:
    """Give the rows of ``timing.csv``.

    Args:
        timed: Each record with its timing, None where that is lost.

    Returns:
        One row a record [s].
    """
    return [
        {
            "scenario": record.scenario,
            "method": record.method,
            "variant": record.variant,
            "reasoner": record.reasoner,
            "seed": record.seed,
            "seconds": timing.seconds if timing else None,
            "decisions": record.decisions,
            "decision_seconds_mean": timing.decision_mean if timing else None,
            "decision_seconds_max": timing.decision_max if timing else None,
        }
        for record, timing in timed
    ]
