"""``load.*``: one row a method and scenario, with columns for each number of CAVs."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import chain
from typing import Any

from codriving.reports.columns import Column, Table, Value, swept_columns, table
from codriving.reports.comparison import (
    DRIVEN,
    METHOD_CHOICE,
    MISSING,
    notes_of,
    reasoner_column,
    setting_of,
    status_columns,
    takes_place_of,
)
from codriving.reports.printed import PrintedTable, printed
from codriving.reports.results import CellResults
from codriving.reports.summary import BY_KEY, CPU, FALLBACKS, clean_notes
from codriving.reports.wording import milliseconds, percent, title, two_digits

LOAD_NOTE = (
    "Rates are over completed episodes, with Wilson 95 % intervals; velocity is the mean over successful episodes."
)

# What the CSV gives at each number of CAVs.
AT_EACH = (
    *("completed", "success_rate", "success_low", "success_high", "pet_mean", "pet_below_1_5", "velocity_mean"),
    *("clean_rate", "clean_low", "clean_high"),
)


@dataclass(frozen=True, slots=True)
class LoadRow:
    """One method at all numbers of CAVs."""

    scenario: str
    method: str
    swept: Mapping[str, str]
    # Its cell at each number of CAVs; empty for a method that was not driven.
    at: dict[int, CellResults] = field(default_factory=dict)

    @property
    def cell(self) -> CellResults | None:
        """A cell that says of what method it is."""
        return next(iter(self.at.values()), None)

    @property
    def status(self) -> str:
        """Whether it could be driven."""
        return DRIVEN if self.at else MISSING

    @property
    def name(self) -> str:
        """The method, with its variant."""
        return self.cell.name if self.cell else self.method


def load_rows(cells: Sequence[tuple[int, CellResults]], methods: Sequence[str]) -> list[LoadRow]:
    """Put the cells of one method and setting into a row.

    Returns:
        The rows: those of a scenario and setting together, ``methods`` in their order, then all others as they come.
    """
    settings: dict[tuple[Value, ...], dict[tuple[Value, ...], LoadRow]] = {}
    for cavs, cell in cells:
        first = cell.first
        setting = settings.setdefault((first.scenario, *setting_of(cell.swept).values()), {})
        which = (first.method, first.variant, first.reasoner, cell.swept.get(METHOD_CHOICE))
        setting.setdefault(which, LoadRow(first.scenario, first.method, cell.swept)).at[cavs] = cell
    return list(chain.from_iterable(_in_order(list(setting.values()), methods) for setting in settings.values()))


def _in_order(rows: Sequence[LoadRow], methods: Sequence[str]) -> list[LoadRow]:
    ordered: list[LoadRow] = []
    for method in methods:
        found = [row for row in rows if takes_place_of(row.cell, row.method) == method]
        ordered += found or [LoadRow(rows[0].scenario, method, setting_of(rows[0].swept))]
    return [*ordered, *(row for row in rows if takes_place_of(row.cell, row.method) not in methods)]


def _measured(rows: Sequence[LoadRow]) -> list[Column[CellResults]]:
    """What people read at each number of CAVs."""
    return [
        Column("success", lambda c: _rate(c, "success"), "success (95 %)", csv=False),
        *([Column("clean", lambda c: _rate(c, "clean"), "clean (95 %)", csv=False)] if _known_clean(rows) else []),
        Column("velocity", lambda c: two_digits(BY_KEY["velocity_mean"].value(c)) or "-", "velocity [m/s]", csv=False),
        *([FALLBACKS] if any(cell.asked for row in rows for cell in row.at.values()) else []),
        Column("cpu", lambda c: milliseconds(c.cpu), CPU, csv=False, page=False),
    ]


def _of_method(rows: Sequence[LoadRow], swept: Sequence[str]) -> list[Column[Any]]:
    return [*status_columns(scenario=True), *swept_columns(swept), reasoner_column(rows)]


def load_table(rows: Sequence[LoadRow], loads: Sequence[int], swept: Sequence[str] = ()) -> Table:
    """Make the table of loads."""
    at_each = [*(replace(BY_KEY[key], head="") for key in AT_EACH), *_measured(rows)]
    episodes = Column[LoadRow]("episodes", lambda row: len(row.cell.records) if row.cell else None, "episodes")
    columns = [_at(cavs, column) for column in at_each for cavs in loads]
    return table([*_of_method(rows, swept), episodes, *columns], rows)


def _at(cavs: int, column: Column[CellResults]) -> Column[LoadRow]:
    head = f"{column.head}, {cavs} CAVs" if column.head else ""
    return column.of(lambda row: row.at.get(cavs), f"{column.key}_{cavs}", head)


def print_loads(rows: Sequence[LoadRow], loads: Sequence[int], metrics: str, swept: Sequence[str] = ()) -> PrintedTable:
    """Prepare the table of loads as a page has it."""
    notes = (LOAD_NOTE, *_load_notes(rows, screen=False))
    return printed(load_title(rows, metrics), load_table(rows, loads, swept), _load_blocks(rows), notes)


def print_each_load(
    rows: Sequence[LoadRow], loads: Sequence[int], metrics: str, swept: Sequence[str] = ()
) -> tuple[PrintedTable, ...]:
    """Prepare the tables of loads as a screen has them: one a quantity, computing times included."""
    notes = (LOAD_NOTE, *_load_notes(rows, screen=True))
    measured, heading = _measured(rows), load_title(rows, metrics)
    made = []
    for number, column in enumerate(measured, 1):
        columns = [replace(_at(cavs, column), head=f"{cavs} CAVs", brief=(f"{cavs} CAVs", " (")) for cavs in loads]
        found = table([*_of_method(rows, swept), *columns], rows)
        what = column.head if number > 1 else f"{heading} - {column.head}"
        made.append(printed(what, found, _load_blocks(rows), notes if number == len(measured) else (), screen=True))
    return tuple(made)


def _load_blocks(rows: Sequence[LoadRow]) -> list[tuple[object, ...]]:
    return [(row.scenario, *setting_of(row.swept).items()) for row in rows]


def _load_notes(rows: Sequence[LoadRow], screen: bool) -> list[str]:
    found = notes_of([(row.method, row.status, cell) for row in rows for cell in row.at.values() or [None]], screen)
    return [*clean_notes(cell for row in rows for cell in row.at.values()), *found]


def _known_clean(rows: Iterable[LoadRow]) -> bool:
    return any(cell.judged for row in rows for cell in row.at.values())


def load_title(rows: Sequence[LoadRow], metrics: str) -> str:
    """Say what is shown and who reasoned."""
    return title("load", [row.scenario for row in rows], [row.cell.first.reasoner for row in rows if row.cell], metrics)


def _rate(cell: CellResults, which: str) -> str:
    rate, low, high = (percent(BY_KEY[f"{which}_{key}"].value(cell)) for key in ("rate", "low", "high"))
    return f"{rate} ({low.removesuffix(' %')} to {high.removesuffix(' %')})" if low else "-"
