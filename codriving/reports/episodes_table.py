"""``episodes.csv``: one row an episode."""

from collections.abc import Iterable, Mapping, Sequence

from codriving.datatypes.outcome import Ending
from codriving.datatypes.record import EpisodeRecord
from codriving.reports.model_columns import counted, counter_columns
from codriving.reports.rows import Row, Value
from codriving.reports.statistics import mean

LABELS = ("scenario", "method", "variant", "reasoner")

LEADING = (*LABELS, "seed", "outcome", "pet_mean", "pet_min", "velocity_mean", "duration")
"""The columns that users rely on, in their fixed order."""

FURTHER = (
    "pet_count",
    "travel_time_mean",
    "delay_mean",
    "cavs",
    "hdvs",
    "arrived",
    "decisions",
    "collision_pair",
    "striker",
    "struck",
    "bystander_collisions",
    "off_road",
    "message",
)

MEMORY = "memory"
"""Column of what was recalled from; only where something was."""

TEXT = frozenset({*LABELS, "outcome", "collision_pair", "striker", "struck", "off_road", "message", MEMORY})
"""Columns of words; all others are numbers."""


def episode_columns(records: Iterable[EpisodeRecord], swept: Sequence[str] = ()) -> tuple[str, ...]:
    """Give the columns of ``episodes.csv``: fixed ones, swept keys, and the counters of methods."""
    records = list(records)
    known = (*LEADING, *swept, *FURTHER, *memory_column(records))
    return (*known, *counter_columns(records, known))


def memory_column(records: Iterable[EpisodeRecord]) -> tuple[str, ...]:
    """Give the column of what was recalled from, if any episode had a memory."""
    return (MEMORY,) if any(record.memory for record in records) else ()


def episode_rows(records: Sequence[EpisodeRecord], swept: Mapping[str, str] | None = None) -> list[Row]:
    """Give the rows of one cell, or of several that are swept alike."""
    return [{**_row(record), **(swept or {})} for record in records]


def _row(record: EpisodeRecord) -> Row:
    outcome = record.outcome
    collision = outcome.collision
    pets = [pet.value for pet in record.score.pets] if record.score else []
    travels = record.score.travels if record.score else ()
    kinds = [participant.kind for participant in record.participants]
    row: dict[str, Value] = {
        **counted([record]),
        "scenario": record.scenario,
        "method": record.method,
        "variant": record.variant,
        "reasoner": record.reasoner,
        "seed": record.seed,
        "outcome": outcome.ending.value,
        "pet_mean": mean(pets),
        "pet_min": min(pets, default=None),
        "velocity_mean": mean([travel.velocity for travel in travels]),
        # How long something lasted that broke off says nothing.
        "duration": None if outcome.ending is Ending.ERROR else outcome.time,
        "pet_count": len(pets) if record.score else None,
        "travel_time_mean": mean([travel.time for travel in travels]),
        "delay_mean": mean([travel.delay for travel in travels if travel.delay is not None]),
        "cavs": kinds.count("CAV"),
        "hdvs": kinds.count("HDV"),
        "arrived": len(outcome.arrivals),
        "decisions": record.decisions,
        "collision_pair": collision.pair if collision else None,
        "striker": collision.striker if collision else None,
        "struck": collision.struck if collision else None,
        "bystander_collisions": len(outcome.bystander_collisions),
        "off_road": " ".join(outcome.off_road) or None,
        "message": outcome.message or None,
        **({MEMORY: record.memory} if record.memory else {}),
    }
    return row
