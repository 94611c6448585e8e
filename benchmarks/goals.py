"""Rows of a table of speed: what was measured, the goal, whether it is reached, and what was stored before."""

import json
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

STORED = Path(__file__).with_name("stored.json")
WIDTH = 52


@dataclass(frozen=True, slots=True)
class Row:
    """A ratio of two sides that were measured alternately.

    Attributes:
        name: What was measured.
        ours: This version.
        other: The other side, in the same unit.
        unit: Their unit.
        goal: What ``ratio`` should be.
        least: Whether the goal is how many times faster ours is at least; else it is its share at most.
    """

    name: str
    ours: float
    other: float
    unit: str
    goal: float
    least: bool = False

    @property
    def ratio(self) -> float:
        """The other over ours where that should be large, else ours over the other."""
        return self.other / self.ours if self.least else self.ours / self.other

    @property
    def reached(self) -> bool:
        """Whether the goal is reached."""
        return self.ratio >= self.goal if self.least else self.ratio <= self.goal

    def as_dict(self) -> dict[str, Any]:
        """What is printed as JSON."""
        numbers = {"ours": round(self.ours, 3), "other": round(self.other, 3), "unit": self.unit}
        goal = {"goal": self.goal, "at": "least" if self.least else "most"}
        return {"name": self.name, **numbers, "ratio": round(self.ratio, 3), **goal, "reached": self.reached}


def show(title: str, other: str, rows: Iterable[Row], *, as_json: bool, store: bool) -> None:
    """Print rows with the ratios that were stored last, and store these if that is wanted.

    Args:
        title: Name of the benchmark.
        other: Who the other side is.
        rows: What was measured.
        as_json: Whether JSON is printed, not a table.
        store: Whether the ratios are stored.
    """
    stored, measured = load(), []
    if not as_json:
        print(f"{title:{WIDTH}}  {'ours':>9} {other:>11}        ratio    goal  reached  stored", flush=True)
    for row in rows:
        measured.append(row)
        if not as_json:
            print(line(row, stored.get(row.name)), flush=True)
    if as_json:
        print(json.dumps({title: [{**row.as_dict(), "stored": stored.get(row.name)} for row in measured]}))
    if store:
        kept = {**stored, **{row.name: round(row.ratio, 3) for row in measured}}
        STORED.write_text(json.dumps(kept, indent=2) + "\n", encoding="utf-8")


def load() -> dict[str, float]:
    """Return the ratios that were stored last, by name of the row."""
    if not STORED.exists():
        return {}
    kept: dict[str, float] = json.loads(STORED.read_text(encoding="utf-8"))
    return kept


def line(row: Row, stored: float | None) -> str:
    """Return a row as text."""
    sign, before = ">=" if row.least else "<=", "" if stored is None else f"{stored:.2f}"
    numbers = f"{row.ours:9.2f} {row.other:11.2f} {row.unit:4} {row.ratio:7.2f} {sign} {row.goal:4g}"
    return f"{row.name:{WIDTH}}  {numbers}  {'yes' if row.reached else 'no':7}  {before:>6}"
