"""``timing.csv``: what the episodes cost in wall-clock time; the only table that differs from run to run."""

from collections.abc import Iterable, Mapping, Sequence

from codriving.datatypes.record import EpisodeRecord
from codriving.reports.rows import Row
from codriving.storage.timing import Timing

LEADING = ("scenario", "method", "variant", "reasoner", "seed")

MEASURED = ("seconds", "decisions", "decision_seconds_mean", "decision_seconds_max")


def timing_columns(swept: Sequence[str] = ()) -> tuple[str, ...]:
    """Give the columns of ``timing.csv``.

    Args:
        swept: Swept keys that need a column.
    """
    return (*LEADING, *swept, *MEASURED)


def timing_rows(
    timed: Iterable[tuple[EpisodeRecord, Timing | None]], swept: Mapping[str, str] | None = None
) -> list[Row]:
    """Give the rows of one cell in ``timing.csv``.

    Args:
        timed: Each record with its timing, None where that is lost.
        swept: The cell's value of each swept key that needs a column.

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
        }
        for record, timing in timed
    ]
