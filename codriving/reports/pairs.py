"""One method against another on the same seeds: who succeeds where, and how far apart they are where both do."""

from collections.abc import Callable, Mapping, Sequence

from codriving.datatypes.outcome import Ending
from codriving.datatypes.record import EpisodeRecord
from codriving.metrics.paired import mcnemar, mean_interval
from codriving.reports.rows import Value
from codriving.reports.statistics import mean

SIGNIFICANT = 0.05
"""A p-value below this counts as a difference."""

PAIRED = (
    "pairs",
    "success_difference",
    "only_method_succeeds",
    "only_codriving_succeeds",
    "mcnemar_p",
    "pet_pairs",
    "pet_difference",
    "pet_difference_low",
    "pet_difference_high",
    "velocity_pairs",
    "velocity_difference",
    "velocity_difference_low",
    "velocity_difference_high",
)
"""Columns of the paired comparison; every difference is the method minus codriving."""


def paired(records: Sequence[EpisodeRecord], reference: Sequence[EpisodeRecord]) -> Mapping[str, Value]:
    """Compare the episodes of a method with those of codriving.

    Returns:
        A value for each column of ``PAIRED``; None where nothing defines it. Pairs of which one ended in an error are
        left out. PET and velocity are means of an episode, over the seeds on which both succeed.
    """
    by_seed = {record.seed: record for record in reference}
    pairs = [(record, by_seed[record.seed]) for record in records if record.seed in by_seed]
    driven = [(a, b) for a, b in pairs if Ending.ERROR not in (a.outcome.ending, b.outcome.ending)]
    gained = sum(_succeeds(a) and not _succeeds(b) for a, b in driven)
    lost = sum(_succeeds(b) and not _succeeds(a) for a, b in driven)
    both = [(a, b) for a, b in driven if _succeeds(a) and _succeeds(b)]
    return {
        "pairs": len(driven),
        "success_difference": (gained - lost) / len(driven) if driven else None,
        "only_method_succeeds": gained,
        "only_codriving_succeeds": lost,
        "mcnemar_p": mcnemar(gained, lost) if driven else None,
        **_difference("pet", both, _pet),
        **_difference("velocity", both, _velocity),
    }


def better_in(row: Mapping[str, Value]) -> tuple[str, ...]:
    """List in what a method is shown to be better than codriving.

    Args:
        row: A row with the columns of ``PAIRED``.

    Returns:
        Of ``success``, ``velocity`` and ``PET`` those in which it is: p below 0.05, or an interval above 0.
    """
    return _shown(row, 1)


def worse_in(row: Mapping[str, Value]) -> tuple[str, ...]:
    """List in what a method is shown to be worse than codriving.

    Args:
        row: A row with the columns of ``PAIRED``.

    Returns:
        Of ``success``, ``velocity`` and ``PET`` those in which it is: p below 0.05, or an interval below 0.
    """
    return _shown(row, -1)


def _shown(row: Mapping[str, Value], sign: int) -> tuple[str, ...]:
    p, success = row.get("mcnemar_p"), row.get("success_difference")
    found = ["success"] if isinstance(p, float) and isinstance(success, float) and _holds(p, success * sign) else []
    for what, name in (("velocity", "velocity"), ("pet", "PET")):
        limits = row.get(f"{what}_difference_low"), row.get(f"{what}_difference_high")
        if all(isinstance(limit, float) and limit * sign > 0 for limit in limits):
            found.append(name)
    return tuple(found)


def _holds(p: float, difference: float) -> bool:
    return p < SIGNIFICANT and difference > 0


def _difference(
    what: str,
    both: Sequence[tuple[EpisodeRecord, EpisodeRecord]],
    measure: Callable[[EpisodeRecord], float | None],
) -> dict[str, Value]:
    measured = [(measure(a), measure(b)) for a, b in both]
    differences = [a - b for a, b in measured if a is not None and b is not None]
    low, high = mean_interval(differences) or (None, None)
    return {
        f"{what}_pairs": len(differences),
        f"{what}_difference": mean(differences),
        f"{what}_difference_low": low,
        f"{what}_difference_high": high,
    }


def _succeeds(record: EpisodeRecord) -> bool:
    return record.score is not None and record.score.success


def _pet(record: EpisodeRecord) -> float | None:
    return mean([pet.value for pet in record.score.pets]) if record.score else None


def _velocity(record: EpisodeRecord) -> float | None:
    return mean([travel.velocity for travel in record.score.travels]) if record.score else None
