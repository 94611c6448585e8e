"""``filters.*``: each method with and without the safety check behind it, on the same seeds."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from codriving.reports.columns import Column, Table, Value, share, swept_columns, table
from codriving.reports.pairs import PairedCells, corrected, p_text, points
from codriving.reports.printed import PrintedTable, printed
from codriving.reports.results import CellResults
from codriving.reports.summary import BY_KEY, NOTE, clean_notes, remarks
from codriving.reports.wording import percent, stand_in_notes, title, two_digits

FILTERED = "filtered"  # The last word of the variant of a method that the filter was put behind

FILTER_NOTES = (
    "Safety check: own, the method has that of codriving in it, or gives no actions; none, the first number is without "
    "any, the second one with filter=true. One thing varies in a row, the filter.",
    "Replaced: share of the actions of all CAVs that the check removed and another one took the place of.",
    "Differences are with the filter minus without, on the same seeds; exact McNemar test, two-sided, corrected for "
    "the number of rows (Holm). Velocity: over seeds on which both succeed, with 95 % bootstrap intervals.",
)


@dataclass(frozen=True)
class FilterRow:
    """One method without and with the filter."""

    plain: CellResults
    filtered: CellResults | None = None  # None for a method that has the check itself, or gives no actions
    pairs: PairedCells | None = None

    @property
    def swept(self) -> Mapping[str, str]:
        """What both cells were driven with."""
        return self.plain.swept

    @property
    def check(self) -> str:
        """Who checks its actions."""
        return "none" if self.filtered is not None else "own"


def filter_rows(rows: Sequence[FilterRow]) -> list[FilterRow]:
    """Compare the two cells of each row, where the filter was put behind the method."""
    known = [r if r.filtered and r.filtered.first.variant.endswith(FILTERED) else FilterRow(r.plain) for r in rows]
    found = iter(corrected([PairedCells(row.filtered, row.plain) for row in known if row.filtered]))
    return [replace(row, pairs=next(found)) if row.filtered else row for row in known]


def filter_table(rows: Sequence[FilterRow], swept: Sequence[str] = ()) -> Table:
    """Make the table."""
    several = len({row.plain.first.scenario for row in rows}) > 1
    columns: list[Column[Any]] = [
        Column("scenario", lambda r: r.plain.first.scenario, "scenario" if several else "", words=True),
        Column("method", lambda r: r.plain.first.method, words=True),
        Column("variant", lambda r: r.plain.first.variant, words=True),
        Column("reasoner", lambda r: r.plain.first.reasoner, words=True),
        Column("name", lambda r: r.plain.name, "method", words=True, csv=False),
        *swept_columns(swept),
        Column("safety_check", lambda r: r.check, "safety check", words=True),
        Column("episodes", lambda r: len(r.plain.records), "episodes", rank=3),
        *_both("success_rate", "success", percent),
        Column("success_difference", lambda r: r.pairs.success.difference if r.pairs else None, "[points]", _points),
        Column("only_filtered_succeeds", lambda r: r.pairs.success.gained if r.pairs else None),
        Column("only_plain_succeeds", lambda r: r.pairs.success.lost if r.pairs else None),
        Column("mcnemar_p", lambda r: r.pairs.success.p if r.pairs else None),
        Column("mcnemar_p_holm", lambda r: r.pairs.success_p if r.pairs else None, "p (Holm)", _p),
        *_both("collision_rate", "collision", percent, rank=2),
        *_both("clean_rate", "clean", percent),
        Column("clean_mcnemar_p_holm", lambda r: r.pairs.clean_p if r.pairs else None, "clean p (Holm)", _p, rank=4),
        *_both("velocity_mean", "velocity [m/s]", two_digits, rank=1),
        Column("velocity_difference", lambda r: r.pairs.velocity.mean if r.pairs else None),
        Column("velocity_difference_low", lambda r: r.pairs.velocity.low if r.pairs else None),
        Column("velocity_difference_high", lambda r: r.pairs.velocity.high if r.pairs else None),
        Column(
            "velocity",
            lambda r: str(r.pairs.velocity) if r.pairs else "",
            "difference (95 %)",
            csv=False,
            rank=5,
            brief=("difference", " ("),
        ),
        *_both("pet_below_1_5", "", percent),
        Column("replaced", _replaced, "replaced", percent, rank=2),
    ]
    return table(columns, rows)


def _both(key: str, head: str, text: Any, rank: int = 0) -> list[Column[Any]]:  # noqa: ANN401 - writes any value
    column = replace(BY_KEY[key], csv=True, page=True, sparse=False, text=text, rank=rank)
    plain = replace(column.of(lambda r: r.plain, f"{key}_plain"), head=head)
    behind = replace(column.of(lambda r: r.filtered, f"{key}_filtered"), head=f"{head}, filtered" if head else "")
    return [plain, behind]


def _replaced(row: FilterRow) -> Value:
    counters = row.filtered.counters if row.filtered else {}
    return share(int(counters.get("replaced") or 0), int(counters.get("checked") or 0))


def _points(value: Value) -> str:
    return "" if value is None else points(value)


def _p(value: Value) -> str:
    return "" if value is None else p_text(value)


def print_filters(rows: Sequence[FilterRow], metrics: str, swept: Sequence[str] = ()) -> PrintedTable:
    """Prepare the table for people."""
    cells = [row.plain for row in rows]
    heading = title(
        "safety check behind each method",
        [cell.first.scenario for cell in cells],
        [cell.first.reasoner for cell in cells],
        metrics,
    )
    blocks = [(row.plain.first.scenario, *row.plain.swept.items()) for row in rows]
    models = stand_in_notes((cell.first.method, cell.first.reasoner) for cell in cells)
    notes = (NOTE, *clean_notes(cells), *FILTER_NOTES, *models, *remarks(cells))
    return printed(heading, filter_table(rows, swept), blocks, notes)
