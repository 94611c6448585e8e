"""``load.*``: one row a method and scenario, with success and velocity at each number of CAVs."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import chain
from typing import Any

from codriving.reports.columns import Column, Table, Value, swept_columns, table
from codriving.reports.comparison import (
    CPU,
    DRIVEN,
    METHOD_CHOICE,
    MISSING,
    REASONER,
    notes_of,
    setting_of,
    status_columns,
    takes_place_of,
)
from codriving.reports.printed import PrintedTable, printed
from codriving.reports.results import CellResults
from codriving.reports.summary import BY_KEY, FALLBACKS
from codriving.reports.wording import milliseconds, percent, title, two_digits

NOTE = "Rates are over completed episodes, with Wilson 95 % intervals; velocity is the mean over successful episodes."

AT_EACH = ("completed", "success_rate", "success_low", "success_high", "pet_mean", "pet_below_1_5", "velocity_mean")
"""What the CSV gives at each number of CAVs."""


@dataclass(frozen=True, slots=True)
class LoadRow:
    """One method at all numbers of CAVs.

    Attributes:
        at: Its cell at each number of CAVs; empty for a method that was not driven.
    """

    scenario: str
    method: str
    swept: Mapping[str, str]
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
        found = [row for row in rows if takes_place_of(row.method) == method]
        ordered += found or [LoadRow(rows[0].scenario, method, setting_of(rows[0].swept))]
    return [*ordered, *(row for row in rows if takes_place_of(row.method) not in methods)]


def load_table(rows: Sequence[LoadRow], loads: Sequence[int], swept: Sequence[str] = ()) -> Table:
    """Make the table of loads."""
    model = any(cell.asked for row in rows for cell in row.at.values())
    keys = [BY_KEY[key] for key in AT_EACH]
    shown: list[Column[CellResults]] = [
        Column("success", _success, "success (95 %)", csv=False),
        Column("velocity", lambda c: two_digits(BY_KEY["velocity_mean"].value(c)) or "-", "velocity [m/s]", csv=False),
        *([FALLBACKS] if model else []),
        Column("cpu", lambda c: milliseconds(c.cpu), CPU, csv=False, page=False),
    ]
    columns: list[Column[Any]] = [
        *status_columns(scenario=True),
        *swept_columns(swept),
        REASONER,
        Column("episodes", lambda row: len(row.cell.records) if row.cell else None, "episodes"),
    ]
    at_each = [*(replace(column, head="") for column in keys), *shown]
    return table([*columns, *(_at(cavs, column) for column in at_each for cavs in loads)], rows)


def _at(cavs: int, column: Column[CellResults]) -> Column[LoadRow]:
    head = f"{column.head}, {cavs} CAVs" if column.head else ""
    return column.of(lambda row: row.at.get(cavs), f"{column.key}_{cavs}", head)


def print_loads(
    rows: Sequence[LoadRow], loads: Sequence[int], metrics: str, swept: Sequence[str] = (), screen: bool = False
) -> PrintedTable:
    """Prepare the table of loads for people.

    Args:
        screen: Whether it is for the screen, which shows computing times, too.
    """
    made = load_table(rows, loads, swept)
    groups = (
        ((row.scenario, *setting_of(row.swept).items()), [values], ())
        for row, values in zip(rows, made.rows, strict=True)
    )
    labels = [(row.method, row.status, cell) for row in rows for cell in row.at.values() or [None]]
    notes = (NOTE, *notes_of(labels, screen))
    return printed(load_title(rows, metrics), made.columns, groups, notes, screen)


def load_title(rows: Sequence[LoadRow], metrics: str) -> str:
    """Say what is shown and who reasoned."""
    reasoners = [row.cell.first.reasoner for row in rows if row.cell]
    return title("load", [row.scenario for row in rows], reasoners, metrics)


def _success(cell: CellResults) -> str:
    rate, low, high = (percent(BY_KEY[key].value(cell)) for key in ("success_rate", "success_low", "success_high"))
    return f"{rate} ({low.removesuffix(' %')} to {high.removesuffix(' %')})" if low else "-"
