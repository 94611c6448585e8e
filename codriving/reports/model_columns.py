"""Columns of what methods count, above all of what a language model was asked and what that cost."""

import math
from collections.abc import Iterable, Sequence

from codriving.datatypes.record import EpisodeRecord
from codriving.reports.rows import Value
from codriving.reports.statistics import share

COST = "cost_usd"

SECONDS = "step_seconds"
"""Time that a decision step waited for the model, on average [s]; of a cached answer, the time that it took then."""

WAITED = "model_seconds"
"""Counter of the time that was waited for the model [s]; it has no column but the mean of a step."""

ASKED = (
    "model_calls",
    "prompt_tokens",
    "completion_tokens",
    COST,
    SECONDS,
    "re_asks",
    "fallbacks",
    "shortened",
    "repaired_orders",
    "plain_decisions",
    "kept_orders",
)
"""The columns of every table of a run in which a language model reasons, in their fixed order."""

FALLBACK_RATE = "fallback_rate"
"""Share of the questions that the model gave no usable answer to, so that rules answered."""

UNPRICED = "unpriced_calls"
"""Counter of calls whose price is not known; it has no column, it empties that of the cost."""


def reasoned(record: EpisodeRecord) -> bool:
    """Tell whether a language model was there to be asked."""
    return not {"model_calls", COST}.isdisjoint(record.counts)


def counter_columns(records: Iterable[EpisodeRecord], known: Sequence[str], rate: bool = False) -> tuple[str, ...]:
    """List the columns of counters: those of a language model first, all others by name."""
    records = list(records)
    names = {name for record in records for name in record.counts} - {UNPRICED, WAITED}
    model = any(map(reasoned, records))
    asked = [name for name in ASKED if model or name in names]
    columns = [*asked, *([FALLBACK_RATE] if model and rate else []), *sorted(names.difference(asked))]
    return tuple(name for name in dict.fromkeys(columns) if name not in known)


def counted(records: Sequence[EpisodeRecord]) -> dict[str, Value]:
    """Add up what was counted, failed episodes included: they have been paid for."""
    values: dict[str, list[int | float]] = {}
    for record in records:
        for name, number in record.counts.items():
            values.setdefault(name, []).append(number)
    sums: dict[str, Value] = {name: _sum(numbers) for name, numbers in values.items()}
    if any(map(reasoned, records)):
        sums = {**dict.fromkeys(ASKED, 0), COST: 0.0, **sums}
        if sums.pop(UNPRICED, 0):
            sums[COST] = None
        steps, waited = sum(record.decisions for record in records), sums.pop(WAITED, 0)
        sums[SECONDS] = float(waited or 0) / steps if steps else None
    return sums


def fallback_rate(sums: dict[str, Value]) -> float | None:
    """Give the share of questions that ended in a fallback, each question counting once however often it was asked.

    Returns:
        The share, or None if nothing was asked.
    """
    calls, again, shortened, fallbacks = (
        int(sums.get(name) or 0) for name in ("model_calls", "re_asks", "shortened", "fallbacks")
    )
    return share(fallbacks, max(calls - again - shortened, fallbacks))


def _sum(numbers: Sequence[int | float]) -> int | float:
    # Exact summation makes the sum of amounts the same in any order.
    return math.fsum(numbers) if any(isinstance(number, float) for number in numbers) else sum(numbers)
