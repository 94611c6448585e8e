"""How far rows are above the bound: only successes count, on the seeds that they have, and the bound has a row."""

from collections.abc import Callable
from dataclasses import replace

import pytest

from codriving.datatypes.record import Ending, EpisodeRecord
from codriving.reports.above import SceneBounds, with_bounds
from codriving.reports.comparison import Condition, comparison_rows, comparison_table, print_comparison
from codriving.reports.paper import Paper
from codriving.reports.results import CellResults

Make = Callable[..., EpisodeRecord]


def arriving(record: EpisodeRecord, *times: float) -> EpisodeRecord:
    arrivals = {f"CAV{k}": time for k, time in enumerate(times)}
    return replace(record, outcome=replace(record.outcome, arrivals=arrivals))


@pytest.fixture
def cells(make: Make) -> list[CellResults]:
    ours = [arriving(make(0), 11.0, 13.0), arriving(make(1), 12.0, 16.0)]
    lost = [
        arriving(make(0, method="fcfs", variant="", reasoner="none"), 12.0, 14.0),
        arriving(make(1, Ending.COLLISION, method="fcfs", variant="", reasoner="none"), 1.0),
    ]
    return [CellResults(ours), CellResults(lost)]


def test_bound_is_the_first_row_and_successes_alone_are_set_against_it(cells: list[CellResults]) -> None:
    rows = comparison_rows(cells, ("fcfs", "codriving", "madqn"), Paper())
    found = with_bounds(rows, SceneBounds({0: 20.0, 1: 25.0}, 2, True))
    assert [(row.method, row.status) for row in found] == [
        ("bound", "proven"),
        ("fcfs", "driven"),
        ("codriving", "driven"),
        ("madqn", "not there yet"),
    ]
    table = comparison_table(found)
    numbers = [tuple(row[key] for key in ("arrival_mean", "above_bound", "above_bound_percent")) for row in table.rows]
    assert numbers == [
        (11.25, 0.0, 0.0),
        (13.0, 3.0, pytest.approx(30.0)),
        # (24 - 20) / 2 and (28 - 25) / 2; 20 % and 12 %.
        (13.0, 1.75, pytest.approx(16.0)),
        (None, None, None),
    ]
    shown = print_comparison(found, "standard")
    assert shown.title.endswith("bound without human drivers")
    assert "in which human drivers are left out" in shown.notes[0]
    assert not any("Time alone" in note for note in shown.notes)


def test_time_alone_is_marked_as_no_bound(cells: list[CellResults]) -> None:
    rows = with_bounds(
        comparison_rows(cells, ("fcfs", "codriving"), Paper()), SceneBounds({0: 20.0, 1: 25.0}, 2, False)
    )
    assert rows[0].status == "time alone"
    assert "Time alone (intersection): where CAVs choose their lanes" in print_comparison(rows, "standard").notes[1]


def test_without_bounds_there_are_no_such_columns(cells: list[CellResults]) -> None:
    rows = comparison_rows(cells, ("fcfs", "codriving"), Paper())
    assert "above_bound" not in comparison_table(rows).keys
    assert "bound" not in print_comparison(rows, "standard", further=("why",)).title
    assert print_comparison(rows, "standard", further=("why",)).notes[0] == "why"


def test_notes_below_the_last_suite_speak_of_all(cells: list[CellResults]) -> None:
    told = [replace(cell, remark=f"{cell.first.method}: {where}.") for cell, where in zip(cells, "ab", strict=True)]
    plain = comparison_rows(cells, ("fcfs", "codriving"), Paper())
    found = with_bounds(comparison_rows(told, ("fcfs", "codriving"), Paper()), SceneBounds({0: 20.0, 1: 25.0}, 2, True))
    first = print_comparison(found, "standard", condition=Condition("merge", "", False, noted=(*found, *plain)))
    last = print_comparison(plain, "standard", condition=Condition("blocked", "", True, noted=(*found, *plain)))
    assert not first.notes
    assert "in which human drivers are left out" in last.notes[0]
    assert {"codriving: a.", "fcfs: b."} <= set(last.notes)
    assert first.title.endswith("bound without human drivers")
    assert not last.title.endswith("bound without human drivers")
