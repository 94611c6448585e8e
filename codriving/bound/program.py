"""The mixed-integer program of a scene: when each CAV passes what, and who goes first where."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array

from codriving.bound.meetings import MeetingPlace
from codriving.bound.timetable import Timetable
from codriving.geometry import FloatArray


@dataclass(slots=True)
class _Rows:
    """Rows of a sparse matrix with their lower bounds."""

    row: list[int] = field(default_factory=list)
    column: list[int] = field(default_factory=list)
    value: list[float] = field(default_factory=list)
    least: list[float] = field(default_factory=list)

    def add(self, terms: Mapping[int, float], least: float) -> None:
        """Add the row: sum of value times column >= least."""
        self.row += [len(self.least)] * len(terms)
        self.column += terms.keys()
        self.value += terms.values()
        self.least.append(least)


@dataclass(slots=True)
class _Columns:
    """Columns with their bounds."""

    low: list[float] = field(default_factory=list)
    high: list[float] = field(default_factory=list)

    def add(self, low: float, high: float) -> int:
        """Add a column and return its number."""
        self.low.append(low)
        self.high.append(high)
        return len(self.low) - 1


@dataclass(frozen=True, slots=True, eq=False)
class Program:
    """A program for ``scipy.optimize.milp``: the least sum of arrivals [s].

    Arrivals are no whole numbers of simulation steps: HiGHS 1.8 then ends with bounds above its own solution.
    """

    matrix: coo_array
    least: FloatArray  # Lower bound of each row (m,)
    low: FloatArray  # Lower bound of each column (n,)
    high: FloatArray  # Upper bound of each column (n,)
    whole: NDArray[np.int64]  # 1 for columns that are whole numbers (n,)
    cost: FloatArray  # (n,)
    orders: Mapping[int, int]  # Column that is 1 if i goes first, by the number of the meeting
    arrivals: tuple[int, ...]  # Column of each CAV's arrival
    binaries: int


def pose(table: Timetable, one_order: bool = False) -> Program:
    """Write the program down.

    Args:
        one_order: Whether CAVs pass all meetings in one order of vehicles.
    """
    columns, rows = _Columns(), _Rows()
    good = table.one_after_another()
    alone = [cav.least_arrival for cav in table.cavs]
    # In a best timetable no CAV is later by more than all together are in one that can be driven.
    late = 1e3 if good is None else sum(max(t[-1] + table.step - a, 0.0) for t, a in zip(good, alone, strict=True))
    for early, least, arrival in zip(table.earliest, table.least, alone, strict=True):
        # Who is late at a place is so at the goal.
        for time, duration in zip(early.tolist(), (least[-1] - least).tolist(), strict=True):
            columns.add(time, arrival + late - duration)
    arrivals = tuple(columns.add(arrival, arrival + late) for arrival in alone)
    for k, least in enumerate(table.least):
        first = table.offsets[k]
        for n, duration in enumerate(np.diff(least).tolist()):
            rows.add({first + n + 1: 1.0, first + n: -1.0}, duration)
        rows.add({arrivals[k]: 1.0, first + len(least) - 1: -1.0}, 0.0)
    count = len(columns.low)
    orders = _orders(table.meetings, columns, rows, len(table.cavs), one_order)
    for number, meeting in enumerate(table.meetings):
        for first, second in ((meeting.i, meeting.j), (meeting.j, meeting.i)):
            if meeting.first in (None, first):
                _add_meeting(rows, columns, table, meeting, first, second, orders.get(number))
    n = len(columns.low)
    whole, cost = np.zeros(n, dtype=np.int64), np.zeros(n)
    whole[count:], cost[list(arrivals)] = 1, 1
    matrix = coo_array((rows.value, (rows.row, rows.column)), shape=(len(rows.least), n))
    free = len(set(orders.values()))
    return Program(
        matrix, np.array(rows.least), np.array(columns.low), np.array(columns.high), whole, cost, orders, arrivals, free
    )


def _add_meeting(
    rows: _Rows, columns: _Columns, table: Timetable, meeting: MeetingPlace, first: int, second: int, order: int | None
) -> None:
    """Add what holds if one of the two goes first; if the other one does, as much is taken off as times can differ."""
    for b, a in meeting.rows(first):
        there, here = table.column(second, b), table.column(first, a)
        big = columns.high[here] + table.gap - columns.low[there]
        if order is None:
            rows.add({there: 1.0, here: -1.0}, table.gap)
        elif big > 0:
            on = first == meeting.i
            rows.add({there: 1.0, here: -1.0, order: -big if on else big}, table.gap - (big if on else 0.0))


def _orders(
    meetings: Sequence[MeetingPlace], columns: _Columns, rows: _Rows, cavs: int, one_order: bool
) -> dict[int, int]:
    """Add a column for each meeting whose order is open, or one for each pair that meets."""
    if not one_order:
        return {number: columns.add(0.0, 1.0) for number, meeting in enumerate(meetings) if meeting.first is None}
    known: dict[tuple[int, int], set[int]] = {}
    for meeting in meetings:
        known.setdefault((meeting.i, meeting.j), set()).update(() if meeting.first is None else (meeting.first,))
    # Who has to go first at one meeting does so at all; where both have to, each meeting goes by itself.
    shared = {
        pair: columns.add(float(firsts == {pair[0]}), float(firsts != {pair[1]}))
        for pair, firsts in known.items()
        if len(firsts) < 2
    }
    positions = [columns.add(0.0, float(cavs - 1)) for _ in range(cavs)]
    for (i, j), column in shared.items():
        rows.add({positions[j]: 1.0, positions[i]: -1.0, column: -float(cavs)}, 1.0 - cavs)
        rows.add({positions[i]: 1.0, positions[j]: -1.0, column: float(cavs)}, 1.0)
    return {
        number: shared[meeting.i, meeting.j] if (meeting.i, meeting.j) in shared else columns.add(0.0, 1.0)
        for number, meeting in enumerate(meetings)
        if meeting.first is None
    }
