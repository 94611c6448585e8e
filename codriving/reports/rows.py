"""Rows of a table and their CSV: undefined is empty, numbers have six significant digits."""

import csv
import io
from collections.abc import Iterable, Mapping, Sequence
from typing import TypeAlias

Value: TypeAlias = str | int | float | None
"""What stands in a cell of a table; None where something is not defined."""

Row: TypeAlias = Mapping[str, Value]
"""One row, by column."""


def csv_text(columns: Sequence[str], rows: Iterable[Row]) -> str:
    """Write rows as CSV."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows([_text(row.get(column)) for column in columns] for row in rows)
    return out.getvalue()


def _text(value: Value) -> str:
    if value is None:
        return ""
    if isinstance(value, float):
        # Adding zero turns -0.0 into 0.0.
        return format(value + 0.0, ".6g")
    return str(value)
