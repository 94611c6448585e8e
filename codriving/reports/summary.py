"""``summary.csv``: one row a cell, with Wilson intervals; PET and velocity over successful episodes only."""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence

from codriving.datatypes.outcome import Ending
from codriving.datatypes.record import EpisodeRecord
from codriving.metrics.wilson import wilson_interval
from codriving.reports.episodes_table import LABELS, MEMORY, memory_column
from codriving.reports.model_columns import FALLBACK_RATE, counted, counter_columns, fallback_rate, reasoned
from codriving.reports.rows import Row, Value
from codriving.reports.statistics import mean, median, share

SEVERE_PET = 1.5
"""Below this a PET counts as severe in the paper [s]."""

LEADING = (
    *LABELS,
    "episodes",
    "completed",
    "success_rate",
    "success_low",
    "success_high",
    "collision_rate",
    "timeout_rate",
    "error_rate",
    "pet_mean",
    "pet_max",
    "pet_min",
    "pet_below_1_5",
    "velocity_mean",
    "velocity_max",
    "velocity_min",
)
"""The columns that users rely on, in their fixed order."""

FURTHER = (
    "off_road_rate",
    "success_planned",
    "success_planned_low",
    "success_planned_high",
    "pet_median",
    "pet_count",
    "travel_time_mean",
    "delay_mean",
    "duration_mean",
    "collision_cav_cav",
    "collision_cav_hdv",
    "collision_cav_block",
    "bystander_collisions",
    "decisions",
)


def summary_columns(records: Iterable[EpisodeRecord], swept: Sequence[str] = ()) -> tuple[str, ...]:
    """Give the columns of ``summary.csv``: fixed ones, swept keys, and the counters of methods."""
    records = list(records)
    known = (*LEADING, *swept, *FURTHER, *memory_column(records))
    return (*known, *counter_columns(records, known, rate=True))


def summary_row(records: Sequence[EpisodeRecord], swept: Mapping[str, str] | None = None) -> Row:
    """Sum up one cell.

    Returns:
        Its row. Rates are over completed episodes, ``success_planned`` is over all; what nothing defines is None.
    """
    first = records[0]
    planned = len(records)
    completed = [record for record in records if record.outcome.ending is not Ending.ERROR]
    endings = Counter(record.outcome.ending for record in records)
    successes = [record for record in completed if record.score is not None and record.score.success]
    low, high = _interval(len(successes), len(completed))
    planned_low, planned_high = _interval(len(successes), planned)
    pairs = Counter(record.outcome.collision.pair for record in completed if record.outcome.collision is not None)
    counters = counted(records)
    return {
        **counters,
        **({FALLBACK_RATE: fallback_rate(counters)} if any(map(reasoned, records)) else {}),
        "scenario": first.scenario,
        "method": first.method,
        "variant": first.variant,
        "reasoner": first.reasoner,
        "episodes": planned,
        "completed": len(completed),
        "success_rate": share(len(successes), len(completed)),
        "success_low": low,
        "success_high": high,
        "collision_rate": share(endings[Ending.COLLISION], len(completed)),
        "timeout_rate": share(endings[Ending.TIMEOUT], len(completed)),
        "error_rate": share(endings[Ending.ERROR], planned),
        "off_road_rate": share(endings[Ending.OFF_ROAD], len(completed)),
        "success_planned": share(len(successes), planned),
        "success_planned_low": planned_low,
        "success_planned_high": planned_high,
        "collision_cav_cav": pairs["CAV-CAV"],
        "collision_cav_hdv": pairs["CAV-HDV"],
        "collision_cav_block": pairs["CAV-block"],
        "bystander_collisions": sum(len(record.outcome.bystander_collisions) for record in completed),
        "decisions": sum(record.decisions for record in records),
        **({MEMORY: first.memory} if first.memory else {}),
        **_quality(successes),
        **(swept or {}),
    }


def _quality(successes: Sequence[EpisodeRecord]) -> dict[str, Value]:
    """PET, velocity and times of the successful episodes, every pair and every vehicle counting once."""
    scores = [record.score for record in successes if record.score is not None]
    pets = [pet.value for score in scores for pet in score.pets]
    travels = [travel for score in scores for travel in score.travels]
    velocities = [travel.velocity for travel in travels]
    return {
        "pet_mean": mean(pets),
        "pet_max": max(pets, default=None),
        "pet_min": min(pets, default=None),
        "pet_median": median(pets),
        "pet_below_1_5": share(sum(pet < SEVERE_PET for pet in pets), len(pets)),
        "pet_count": len(pets),
        "velocity_mean": mean(velocities),
        "velocity_max": max(velocities, default=None),
        "velocity_min": min(velocities, default=None),
        "travel_time_mean": mean([travel.time for travel in travels]),
        "delay_mean": mean([travel.delay for travel in travels if travel.delay is not None]),
        "duration_mean": mean([record.outcome.time for record in successes]),
    }


def _interval(successes: int, n: int) -> tuple[float | None, float | None]:
    """The Wilson 95 % interval; of no episodes there is none."""
    return wilson_interval(successes, n) if n else (None, None)
