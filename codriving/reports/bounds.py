"""``codriving bound``: the least time in which the CAVs of each world arrive, as people read it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from codriving.reports.columns import Column, mean, swept_columns, table
from codriving.reports.printed import PrintedTable, printed
from codriving.reports.wording import two_digits

PROVEN = (
    "All times are means a CAV from the start of the episode on. Bound: no way of driving is faster, given how "
    "CAVs were measured to turn; human drivers are left out."
)

KEPT = "Bound: no executor is faster that keeps {margin:g} s at zones{order}; human drivers are left out."

ALONE = "Alone: each CAV by itself. Where CAVs choose their lanes ({names}) no more is proven, so that is the bound."

DRIVEN = (
    "Driven: CAVs drove so in the environment, without human drivers, and none touched; "
    "gap: to the bound of the same seeds."
)

NONE = "In {count} of {seeds} seeds no such drive was found."

OPEN = "In {count} of {seeds} seeds the search ended at its limit of nodes; their bound is valid, and may be larger."


@dataclass(frozen=True, slots=True)
class BoundRow:
    """The bounds of one world."""

    scenario: str
    swept: Mapping[str, str]
    seeds: int
    bound: float  # Mean a CAV [s]
    alone: float  # The same
    driven: float | None  # Mean a CAV of the seeds of which a drive was found [s]
    gap: float | None  # The same less the bound of these seeds [s]
    not_found: int
    cavs: float
    unsolved: int  # Seeds of which a larger bound may be found
    by_zones: bool

    @classmethod
    def of(
        cls, scenario: str, swept: Mapping[str, str], rows: Sequence[Mapping[str, str]], by_zones: bool
    ) -> "BoundRow":
        """Sum up the rows of ``bound.csv``."""

        def each(key: str, of: Sequence[Mapping[str, str]]) -> float | None:
            return mean([float(row[key]) / int(row["cavs"]) for row in of])

        found = [row for row in rows if row["driven"] not in ("", "none")]
        driven, under = each("driven", found), each("bound", found)
        return cls(
            scenario,
            swept,
            len(rows),
            each("bound", rows) or 0.0,
            each("alone", rows) or 0.0,
            driven,
            None if driven is None or under is None else driven - under,
            sum(row["driven"] == "none" for row in rows),
            mean([float(row["cavs"]) for row in rows]) or 0.0,
            sum(row["optimal"] != "yes" for row in rows),
            by_zones,
        )


def print_bounds(rows: Sequence[BoundRow], margin: float | None = None, one_order: bool = False) -> PrintedTable:
    """Prepare the table of bounds."""
    swept = tuple(dict.fromkeys(key for row in rows for key in row.swept if key != "scenario"))
    columns = [
        Column[BoundRow]("scenario", lambda row: row.scenario, "scenario", words=True),
        *swept_columns(swept),
        Column[BoundRow]("cavs", lambda row: row.cavs, "CAVs", lambda value: f"{float(value or 0):g}"),
        Column[BoundRow]("seeds", lambda row: row.seeds, "seeds"),
        Column[BoundRow]("alone", lambda row: row.alone, "alone [s]", two_digits),
        Column[BoundRow]("bound", lambda row: row.bound, "bound [s]", two_digits),
        Column[BoundRow]("driven", lambda row: row.driven, "driven [s]", two_digits, sparse=True),
        Column[BoundRow]("gap", lambda row: row.gap, "gap [s]", two_digits, sparse=True),
    ]
    notes = [PROVEN if margin is None else KEPT.format(margin=margin, order=" and one order of vehicles" * one_order)]
    if lanes := ", ".join(dict.fromkeys(row.scenario for row in rows if not row.by_zones)):
        notes.append(ALONE.format(names=lanes))
    if any(row.driven is not None or row.not_found for row in rows):
        notes.append(DRIVEN)
    if count := sum(row.not_found for row in rows):
        notes.append(NONE.format(count=count, seeds=sum(row.seeds for row in rows)))
    if count := sum(row.unsolved for row in rows):
        notes.append(OPEN.format(count=count, seeds=sum(row.seeds for row in rows)))
    return printed("bound of the arrival times", table(columns, rows), [row.scenario for row in rows], notes)
