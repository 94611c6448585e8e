"""Rules that stand in for a language model: what they call themselves, and what readers are told of them."""

from collections.abc import Sequence

from codriving.reports.rows import Row

STANDS_IN = {"dilu-rule": "dilu"}
"""What a method calls itself if built-in rules stand in for its language model, and what it would be with one."""


def stand_in_notes(rows: Sequence[Row]) -> list[str]:
    """Say of every method whose language model rules stand in for that it is not that method.

    Args:
        rows: Rows with the column ``method``.
    """
    names = dict.fromkeys(str(row["method"]) for row in rows if row["method"] in STANDS_IN)
    return [
        f"{name}: built-in rules in the place of {STANDS_IN[name]}'s language model; it is not that method."
        for name in names
    ]
