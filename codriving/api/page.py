"""What a notebook shows of a result: the columns that people look at first, rates with their intervals in one."""

import re
from collections.abc import Mapping, Sequence
from html import escape
from math import isfinite
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pandas import DataFrame

MOST = 40  # Rows that are shown

NAMES = (
    *("file", "scenario", "method", "variant", "reasoner", "status", "suite", "cda", "method_choice"),
    *("interactions", "control", "axis", "level"),
)

# What is shown where it is there, and how it is called; of a table of loads for each load.
HEADS = {
    **{name: name.replace("_", " ") for name in ("episodes", "completed", "success", "clean", "better_in", "worse_in")},
    **{"success_rate": "success", "clean_rate": "clean success", "pet_below_1_5": "PETs below 1.5 s"},
    **{f"pet_{what}": f"PET {what} [s]" for what in ("mean", "max", "min")},
    "velocity_mean": "velocity [m/s]",
}

SHARES = ("success_rate", "clean_rate", "pet_below_1_5")


def page_of(heading: str, frame: "DataFrame", notes: Sequence[str] = ()) -> str:
    """Write a table as HTML, everything in it escaped."""
    rows = [{str(key): value for key, value in row.items()} for row in frame.to_dict("records")]
    heads = {key: text for key in map(str, frame.columns) if (text := _head(key)) is not None}
    kept = {key: text for key, text in heads.items() if any(_text(row, key) for row in rows)}
    cells = "".join(f"<th>{escape(text)}</th>" for text in kept.values())
    body = "".join(
        f"<tr>{''.join(f'<td>{escape(_text(row, key))}</td>' for key in kept)}</tr>\n" for row in rows[:MOST]
    )
    more = [f"{len(rows) - MOST} more rows are in .table."] if len(rows) > MOST else []
    below = "".join(f"<p>{escape(note)}</p>\n" for note in [*more, *notes])
    return f"<p>{escape(heading)}</p>\n<table>\n<tr>{cells}</tr>\n{body}</table>\n{below}"


def _head(key: str) -> str | None:
    """What a column is called; None for one that is not shown."""
    if key in NAMES or "." in key:
        return key
    name, load = _parts(key)
    return f"{HEADS[name]}{load and f', {load} CAVs'}" if name in HEADS else None


def _parts(key: str) -> tuple[str, str]:
    """A key without the number of CAVs that it is for, and that number."""
    found = None if key in HEADS else re.fullmatch(r"(.+)_(\d+)", key)
    return (found[1], found[2]) if found else (key, "")


def _text(row: Mapping[str, object], key: str) -> str:
    value, (name, load) = row.get(key), _parts(key)
    if isinstance(value, bool) or not isinstance(value, int | float):
        return "" if value is None else str(value)
    if not isfinite(value):
        return ""
    if name not in SHARES:
        return str(value) if isinstance(value, int) else f"{value:.4g}"
    low, high = (row.get(f"{name.removesuffix('_rate')}_{end}{load and f'_{load}'}") for end in ("low", "high"))
    known = isinstance(low, float | int) and isinstance(high, float | int) and isfinite(low) and isfinite(high)
    return f"{100 * value:.3g} %" + (f" ({100 * low:.3g} to {100 * high:.3g})" if known else "")  # type: ignore[operator]
