"""Clean success in tables: rate, interval, rank and test."""

from collections.abc import Callable

import pytest

from codriving.datatypes.record import Ending, EpisodeRecord
from codriving.reports.columns import table
from codriving.reports.comparison import Compared, comparison_rows, print_comparison, print_pairs, with_corrected
from codriving.reports.load import load_rows, print_each_load
from codriving.reports.pairs import PAIRED, PairedCells
from codriving.reports.paper import Paper
from codriving.reports.results import CellResults
from tests.reports.making import column_of, print_cells, summary_row

Make = Callable[..., EpisodeRecord]


def _cell(make: Make, method: str, clean: int, of: int, time: float | None = 10.0) -> CellResults:
    return CellResults([make(k, method=method, variant="", clean=k < clean, time=time) for k in range(of)])


def test_rate_and_wilson_interval_are_over_completed_episodes(make: Make) -> None:
    """18 of 20 have 69.9 to 97.2 %; the error counts nowhere, the failure counts as not clean."""
    records = [make(k, clean=k < 18) for k in range(19)]
    records += [make(19, Ending.COLLISION, clean=False), make(20, Ending.ERROR)]
    row = summary_row(records)
    assert row["clean_rate"] == 0.9
    assert (row["clean_low"], row["clean_high"]) == pytest.approx((0.699, 0.972), abs=6e-4)
    shown = print_cells(records)
    assert column_of(shown, "clean") == ["90 %"]
    assert column_of(shown, "clean 95 %") == ["69.9 to 97.2 %"]
    assert any(note.startswith("Clean: success with every PET at least") for note in shown.notes)


def test_none_clean_is_shown_and_not_known_is_not(make: Make) -> None:
    assert column_of(print_cells([make(0, clean=False)]), "clean") == ["0 %"]
    old = print_cells([make(0)])
    assert "clean" not in old.columns
    assert not any(note.startswith("Clean") for note in old.notes)
    row = summary_row([make(0)])
    assert (row["clean_rate"], row["clean_low"], row["clean_high"]) == (None, None, None)


def test_methods_are_ranked_by_clean_success_and_then_by_the_time_of_all(make: Make) -> None:
    cells = [
        _cell(make, "a", 2, 4),
        _cell(make, "b", 3, 4, 12.0),
        _cell(make, "c", 3, 4, 11.0),
        _cell(make, "codriving", 1, 4),
    ]
    rows = comparison_rows(cells, ["missing", "a", "b", "codriving"], Paper())
    assert [row.method for row in rows] == ["c", "b", "a", "codriving", "missing"]


def test_controls_stand_below_the_methods_however_good_they_are(make: Make) -> None:
    def control(name: str, variant: str, clean: int) -> CellResults:
        records = [make(k, method=name, variant=variant, clean=k < clean, time=9.0) for k in range(4)]
        return CellResults(records)

    best, other = control("x", "control", 4), control("y", "control/no_negotiation", 3)
    cells = [other, best, _cell(make, "a", 1, 4), _cell(make, "codriving", 2, 4), control("b", "controlled", 0)]
    rows = comparison_rows(cells, ["a", "codriving", "missing"], Paper())
    assert [row.method for row in rows] == ["codriving", "a", "b", "x", "y", "missing"]
    shown = print_comparison(rows, "standard")
    assert column_of(shown, "method")[3:5] == ["x control", "y control/no_negotiation"]
    assert [row.last for row in shown.rows] == [False, False, True, False, True, False], "a group of their own"


def test_codriving_has_to_be_level_with_methods_and_not_with_controls(make: Make) -> None:
    def cell(name: str, variant: str, clean: int, driven: int = 40) -> CellResults:
        return CellResults([make(k, method=name, variant=variant, clean=k < clean) for k in range(driven)])

    gone = CellResults([make(k, Ending.ERROR, method="gone", variant="") for k in range(40)])
    cells = [cell("codriving", "full", 30), cell("a", "", 31), cell("oracle", "control", 40), gone]
    cells += [cell("idm", "control", 20), cell("fastest", "control", 34)]

    def notes(cells: list[CellResults]) -> tuple[str, ...]:
        shown = print_pairs(with_corrected(comparison_rows(cells, (), Paper())), "standard")
        assert shown is not None
        return shown.notes

    above = (
        "Controls above codriving: oracle control (+25.0 points, p (Holm) = 0.0078), "
        "fastest control (+10.0 points, p (Holm) = 0.25)."
    )
    level = "codriving is level with the best method, a (+2.5 points, p (Holm) = 1)."
    assert f"Clean success: {level} {above}" in notes(cells)
    assert f"Clean success: no method is above codriving. {above}" in notes([*cells[:1], cell("a", "", 29), *cells[2:]])
    assert f"Clean success: {above}" in notes([*cells[:1], cell("a", "", 9, 9), *cells[2:]]), "nine pairs are too few"


def test_controls_whose_clean_success_is_not_known_stand_below_the_methods_too(make: Make) -> None:
    cells = [
        CellResults([make(0, method=n, variant=v)])
        for n, v in (("x", "control"), ("mine", ""), ("a", ""), ("codriving", "full"))
    ]
    rows = comparison_rows(cells, ["a", "codriving"], Paper())
    assert [row.method for row in rows] == ["a", "codriving", "mine", "x"]


def test_old_records_stay_in_the_order_of_the_table(make: Make) -> None:
    cells = [CellResults([make(0, method=name, variant="")]) for name in ("a", "b")]
    assert [row.method for row in comparison_rows(cells, ["b", "missing", "a"], Paper())] == ["b", "missing", "a"]


def test_pairs_are_tested_as_success_is(make: Make) -> None:
    """Of 8 seeds on which one of the two alone is clean it is always codriving: p = 2 / 2^8 = 0.0078."""
    theirs, ours = _cell(make, "a", 1, 10), _cell(make, "codriving", 9, 10)
    row = table(PAIRED, [PairedCells(theirs, ours)]).rows[0]
    assert (row["only_method_clean"], row["only_codriving_clean"], row["clean_difference"]) == (0, 8, -0.8)
    assert row["clean_mcnemar_p"] == pytest.approx(0.0078, abs=5e-5)
    assert (row["worse_in"], row["success_difference"]) == ("clean", 0.0)
    printed = print_pairs([Compared("intersection", "a", cell=theirs, pairs=PairedCells(theirs, ours))], "standard")
    assert printed is not None
    assert column_of(printed, "clean [points]") == ["-80.0"]
    assert column_of(printed, "clean p") == ["0.0078"]
    better = print_pairs(
        with_corrected([Compared("intersection", "a", cell=ours, pairs=PairedCells(ours, theirs))] * 2), "standard"
    )
    assert better is not None
    assert (
        "Better than codriving: codriving in clean success by +80.0 points (p (Holm) = 0.016) - intersection."
        in better.notes
    )


def test_pairs_of_old_records_have_none(make: Make) -> None:
    old = CellResults([make(0, method="a")])
    row = table(PAIRED, [PairedCells(old, _cell(make, "codriving", 1, 1))]).rows[0]
    assert (row["clean_pairs"], row["clean_difference"], row["only_method_clean"]) == (0, None, None)


def test_comparison_and_loads_show_it(make: Make) -> None:
    cell = _cell(make, "codriving", 3, 4)
    shown = print_comparison(comparison_rows([cell], ["codriving"], Paper()), "standard")
    assert column_of(shown, "clean") == ["75 %"]
    loads = print_each_load(load_rows([(4, cell)], ["codriving"]), [4], "standard")
    assert "clean (95 %)" in [each.title for each in loads]
