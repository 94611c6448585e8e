"""``stress.*``: one curve a method over the levels of an axis, where it breaks, and the area under it."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise
from typing import Any

from codriving.datatypes import StressAxis
from codriving.metrics import FEWEST
from codriving.reports.columns import Column, Table, Value, swept_columns, table
from codriving.reports.comparison import DRIVEN, notes_of, reasoner_column, setting_of, status_columns
from codriving.reports.pairs import PairedCells, PairedRate, points
from codriving.reports.printed import PrintedTable, printed
from codriving.reports.results import CellResults
from codriving.reports.summary import BY_KEY, clean_notes
from codriving.reports.wording import percent, title, two_digits

# By how much a rate has to be lower than at the first level for a curve to break.
BREAKS = {"success": 0.05, "clean": 0.10}

NEVER = "never"  # What stands in the place of a level that no curve breaks at

NOTES = (
    "Rates are over completed episodes, with Wilson 95 % intervals; velocity is the mean over successful episodes.",
    "Breaks at: the first level at which success is 5 points, or clean success 10 points, below the method's own first "
    "level on the same seeds, and the 95 % interval of that difference (Newcombe, 1998, method 10) is below 0; in "
    f"points. Of fewer than {FEWEST} pairs nothing is said. Intervals are not corrected for the number of curves.",
    "Area: mean rate between the first and the last level if every value between them counts the same; straight lines "
    "from level to level, the axis as long as its span.",
)


@dataclass(frozen=True)
class StressCurve:
    """One method at the levels of one axis."""

    axis: StressAxis
    # Its cell at each level, by number; a level that was not driven is missing.
    at: Mapping[int, CellResults]
    swept: Mapping[str, str] = field(default_factory=dict)
    status = DRIVEN

    @property
    def cell(self) -> CellResults:
        """A cell that says of what method it is."""
        return next(iter(self.at.values()))

    @property
    def scenario(self) -> str:
        """Where it was driven."""
        return self.cell.first.scenario

    @property
    def method(self) -> str:
        """Name of the method."""
        return self.cell.first.method

    @property
    def name(self) -> str:
        """The method, with its variant."""
        return self.cell.name

    @property
    def block(self) -> tuple[object, ...]:
        """What it shares with all curves of its block."""
        return self.scenario, *setting_of(self.swept).items()

    @cached_property
    def pairs(self) -> Mapping[int, PairedCells]:
        """Each further level against the first one."""
        first = self.at.get(0)
        return {} if first is None else {k: PairedCells(cell, first) for k, cell in self.at.items() if k > 0}

    def change(self, measure: str, level: int) -> PairedRate:
        """Compare success or clean success at a level with the first one, on the same seeds."""
        found: PairedRate = getattr(self.pairs[level], measure) if level in self.pairs else PairedRate(0, 0, 0)
        return found

    def breaks(self, measure: str) -> int | str | None:
        """Return the level at which success or clean success breaks; NEVER, or None where it cannot be said."""
        for level in range(1, len(self.axis.levels)):
            rate = self.change(measure, level)
            if rate.interval is None:
                return None
            # The difference of counts, since 5 of 100 is 5 points and 0.05 is not.
            fallen = rate.lost - rate.gained >= BREAKS[measure] * rate.pairs - 1e-9
            if fallen and rate.interval[1] < 0:
                return level
        return NEVER

    def area(self, measure: str) -> float | None:
        """Return the area under the curve of success or clean success, the axis as long as its span."""
        known = [getattr(self.at[k], measure)[0] for k in range(len(self.axis.levels)) if k in self.at]
        rates = [float(rate) for rate in known if rate is not None]
        if len(rates) < len(self.axis.levels):
            return None
        steps = pairwise(zip(self.axis.places, rates, strict=True))
        return sum((right - left) * (a + b) / 2 for (left, a), (right, b) in steps)


@dataclass(frozen=True, slots=True)
class LevelOfCurve:
    """One level of one curve, which is a row of ``stress.csv``."""

    curve: StressCurve
    level: int

    @property
    def cell(self) -> CellResults | None:
        """What was driven."""
        return self.curve.at.get(self.level)

    @property
    def swept(self) -> Mapping[str, str]:
        """What else was varied."""
        return self.curve.swept


def stress_table(curves: Sequence[StressCurve], swept: Sequence[str] = ()) -> Table:
    """Make the table of all levels of all curves."""

    def cell(*keys: str) -> list[Column[Any]]:
        return [replace(BY_KEY[key], head="").of(lambda row: row.cell) for key in keys]

    columns: list[Column[Any]] = [
        *_words(lambda row: row.curve, swept),
        Column("level", lambda row: row.level),
        Column("value", lambda row: row.curve.axis.levels[row.level].value, words=True),
        Column("unit", lambda row: row.curve.axis.unit, words=True),
        *cell("episodes", "completed", "success_rate", "success_low", "success_high"),
        *cell("clean_rate", "clean_low", "clean_high", "velocity_mean", "collision_rate", "timeout_rate"),
        *(column for measure in BREAKS for column in _change_columns(measure)),
    ]
    return table(columns, [LevelOfCurve(curve, k) for curve in curves for k in range(len(curve.axis.levels))])


def _words(curve: Callable[[Any], StressCurve], swept: Sequence[str]) -> list[Column[Any]]:
    """Give the columns that say of which curve a row is."""
    return [
        Column("axis", lambda row: curve(row).axis.key, words=True),
        *(column.of(curve) for column in status_columns(scenario=False) if column.csv and column.key != "status"),
        *swept_columns(swept),
    ]


def _change_columns(measure: str) -> Iterator[Column[LevelOfCurve]]:
    def of(value: Callable[[PairedRate], Value]) -> Callable[[LevelOfCurve], Value]:
        return lambda row: value(rate) if (rate := row.curve.change(measure, row.level)).pairs else None

    yield Column(f"{measure}_pairs", of(lambda rate: rate.pairs))
    yield Column(f"{measure}_difference", of(lambda rate: rate.difference))
    yield Column(f"{measure}_difference_low", of(lambda rate: rate.interval[0] if rate.interval else None))
    yield Column(f"{measure}_difference_high", of(lambda rate: rate.interval[1] if rate.interval else None))
    yield Column(f"{measure}_mcnemar_p", of(lambda rate: rate.p))


def breaking_table(curves: Sequence[StressCurve], swept: Sequence[str] = ()) -> Table:
    """Make the table of breaking points and areas."""
    columns: list[Column[Any]] = [
        *_words(lambda curve: curve, swept),
        Column("unit", lambda curve: curve.axis.unit, words=True),
        *(column for measure in BREAKS for column in _curve_columns(measure)),
    ]
    return table(columns, curves)


def _curve_columns(measure: str) -> Iterator[Column[StressCurve]]:
    def breaks(curve: StressCurve) -> Value:
        found = curve.breaks(measure)
        return curve.axis.levels[found].value if isinstance(found, int) else found

    yield Column(f"{measure}_breaks_at", breaks, words=True)
    yield Column(f"{measure}_area", lambda curve: curve.area(measure))


def stress_notes(curves: Sequence[StressCurve]) -> tuple[str, ...]:
    """Say what the numbers of the curves of all axes mean."""
    cells = [cell for curve in curves for cell in curve.at.values()]
    rows = [(curve.method, curve.status, curve.cell) for curve in curves]
    return (*NOTES, *clean_notes(cells), *notes_of(rows, screen=False))


def print_stress(
    curves: Sequence[StressCurve], metrics: str, swept: Sequence[str] = (), further: Sequence[str] = ()
) -> tuple[PrintedTable, ...]:
    """Prepare the tables of one axis: one a quantity, with a column for each level.

    Args:
        further: What has to be said besides what the axis is.
    """
    axis, cells = curves[0].axis, [cell for curve in curves for cell in curve.at.values()]
    notes = (axis.sentence, *further)
    shown = {"success": "success (95 %)", **({"clean": "clean success (95 %)"} if any(c.judged for c in cells) else {})}
    tables = [(name, [*_levels(axis, _rate(m)), *_judged(m)]) for m, name in shown.items()]
    tables.append(("velocity [m/s]", _levels(axis, _velocity)))
    heading = title(
        f"stress: {axis.title}", [c.scenario for c in curves], [c.cell.first.reasoner for c in curves], metrics
    )
    several = len({curve.scenario for curve in curves}) > 1
    made = []
    for number, (name, columns) in enumerate(tables, 1):
        words = [*status_columns(scenario=several), *swept_columns(swept), reasoner_column(curves)]
        what = f"{heading} - {name}" if number == 1 else f"{axis.title} - {name}"
        found = table([*words, *columns], curves)
        blocks = [(curve.block, curve.cell.is_control) for curve in curves]
        made.append(printed(what, found, blocks, notes if number == len(tables) else ()))
    return tuple(made)


def _levels(axis: StressAxis, text: Callable[[CellResults], str]) -> list[Column[StressCurve]]:
    def column(level: int, label: str) -> Column[StressCurve]:
        return Column(
            f"level_{level}",
            lambda c: text(c.at[level]) if level in c.at else "-",
            label,
            csv=False,
            brief=(label, " ("),
        )

    return [column(level, label) for level, label in enumerate(axis.labels)]


def _rate(measure: str) -> Callable[[CellResults], str]:
    def text(cell: CellResults) -> str:
        rate, low, high = map(percent, getattr(cell, measure))
        return f"{rate} ({low.removesuffix(' %')} to {high.removesuffix(' %')})" if rate else "-"

    return text


def _velocity(cell: CellResults) -> str:
    return two_digits(BY_KEY["velocity_mean"].value(cell)) or "-"


def _judged(measure: str) -> list[Column[StressCurve]]:
    return [
        Column("breaks", lambda c: _break_text(c, measure), "breaks at", csv=False, brief=("breaks at", ": ")),
        Column("area", lambda c: c.area(measure), "area", lambda value: percent(value) or "-", csv=False),
    ]


def _break_text(curve: StressCurve, measure: str) -> str:
    level = curve.breaks(measure)
    if not isinstance(level, int):
        return level or "-"
    rate = curve.change(measure, level)
    low, high = rate.interval or (None, None)
    return f"{curve.axis.labels[level]}: {points(rate.difference)} ({points(low)} to {points(high)})"
