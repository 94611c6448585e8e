"""What a language model was asked and what that cost, as people read it."""

import math
from collections.abc import Sequence

from codriving.reports.model_columns import ASKED, COST, FALLBACK_RATE
from codriving.reports.rows import Row, Value
from codriving.reports.wording import fixed, percent

CALLS = "calls"
TOKENS = "tokens prompt + completion"
MONEY = "cost [USD]"
FALLBACKS = "fallbacks"
STEP = "step [s]"
"""Head of the column of wall-clock time; on the screen alone, since it differs from run to run."""

STEP_NOTE = "Step: wall-clock time of one decision step, all CAVs and all questions together; see timing.csv."


FALLBACK_NOTE = "Fallbacks: share of questions to which the model gave no usable answer, so that rules answered."


def asks(row: Row) -> bool:
    """Tell whether a language model reasons in a row of the summary."""
    return "model_calls" in row and FALLBACK_RATE in row


def model_heads(rows: Sequence[Row], timed: bool) -> tuple[str, ...]:
    """Give the heads of the columns of a language model."""
    if not any(map(asks, rows)):
        return ()
    return (CALLS, TOKENS, MONEY, FALLBACKS, *([STEP] if timed else []))


def model_texts(row: Row, seconds: float | None = None) -> dict[str, str]:
    """Give the texts of these columns; none where no model reasons.

    Args:
        seconds: Wall-clock time of a decision step [s], if known.
    """
    if not asks(row):
        return {}
    return {
        CALLS: _thousands(row["model_calls"]),
        TOKENS: f"{_thousands(row['prompt_tokens'])} + {_thousands(row['completion_tokens'])}",
        MONEY: _money(row[COST]),
        FALLBACKS: percent(row[FALLBACK_RATE]) or "-",
        STEP: fixed(seconds, 2) or "-",
    }


def model_notes(rows: Sequence[Row], timed: bool) -> list[str]:
    """Sum up what the models of all rows were asked."""
    found = [row for row in rows if asks(row)]
    if not found:
        return []
    total = {name: sum(int(row[name] or 0) for row in found) for name in ASKED if name != COST}
    priced = [float(row[COST] or 0.0) for row in found if row[COST] is not None]
    price = f"{_money(math.fsum(priced))} USD" if priced else "cost not known"
    if priced and len(priced) < len(found):
        price += " and what is not known"
    return [
        f"In all: {total['model_calls']:,} calls, {total['prompt_tokens']:,} + {total['completion_tokens']:,} tokens, "
        f"{price}; {total['re_asks']:,} asked again, {total['fallbacks']:,} fallbacks, {total['repaired_orders']:,} "
        "repaired orders.",
        f"{FALLBACK_NOTE} Failed episodes count in all sums.",
        *([STEP_NOTE] if timed else []),
    ]


def _thousands(value: Value) -> str:
    return f"{value:,}" if isinstance(value, int | float) else "-"


def _money(value: Value) -> str:
    return f"{value:.4f}" if isinstance(value, int | float) else "-"
