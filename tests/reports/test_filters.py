"""The table of methods with and without the safety check behind them."""

from collections.abc import Callable

import pytest

from codriving.datatypes.record import Ending, EpisodeRecord
from codriving.reports.columns import Table
from codriving.reports.filters import FilterRow, filter_rows, filter_table, print_filters
from codriving.reports.results import CellResults
from tests.reports.making import printed_text

Make = Callable[..., EpisodeRecord]


@pytest.fixture
def rows(make: Make) -> list[FilterRow]:
    """In each of two suites a method that the filter is put behind, and one that has the check itself."""

    def cell(won: int, suite: str, method: str, variant: str) -> CellResults:
        endings = [Ending.SUCCESS if k < won else Ending.COLLISION for k in range(10)]
        return CellResults(
            [make(k, ending, method=method, variant=variant) for k, ending in enumerate(endings)], {"suite": suite}
        )

    found = []
    for suite, plain, filtered in (("honest", 9, 10), ("crowd", 1, 9)):
        found.append(FilterRow(cell(plain, suite, "fcfs", ""), cell(filtered, suite, "fcfs", "filtered")))
        found.append(FilterRow(cell(8, suite, "codriving", "full"), cell(8, suite, "codriving", "full")))
    return filter_rows(found)


def column_of(table: Table, key: str) -> list[object]:
    return [row[key] for row in table.rows]


def test_each_setting_has_a_row_a_method(rows: list[FilterRow]) -> None:
    table = filter_table(rows, ["suite"])
    assert column_of(table, "suite") == ["honest", "honest", "crowd", "crowd"]
    assert column_of(table, "safety_check") == ["none", "own", "none", "own"]
    assert column_of(table, "success_rate_plain") == [0.9, 0.8, 0.1, 0.8]
    assert column_of(table, "success_rate_filtered") == [1.0, None, 0.9, None]
    assert column_of(table, "only_filtered_succeeds") == [1, None, 8, None]
    assert column_of(table, "only_plain_succeeds") == [0, None, 0, None]


def test_p_values_are_corrected_for_the_rows_that_are_compared(rows: list[FilterRow]) -> None:
    table = filter_table(rows, ["suite"])
    assert column_of(table, "mcnemar_p") == [1.0, None, 0.0078125, None]
    assert column_of(table, "mcnemar_p_holm") == [1.0, None, 0.015625, None]


def test_what_is_printed_names_the_suite_of_each_row(rows: list[FilterRow]) -> None:
    printed = printed_text(print_filters(rows, "standard", ["suite"]))
    assert [line.split()[:2] for line in printed.splitlines() if line.startswith(("fcfs", "codriving"))] == [
        ["fcfs", "honest"], ["codriving", "full"], ["fcfs", "crowd"], ["codriving", "full"],
    ]  # fmt: skip
