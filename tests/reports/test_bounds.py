"""The table of ``codriving bound``: means a CAV, and what is not so in all seeds is said."""

from codriving.reports.bounds import BoundRow, print_bounds


def row(cavs: int, bound: float, alone: float, driven: str = "", optimal: str = "yes") -> dict[str, str]:
    return {"cavs": f"{cavs}", "bound": f"{bound}", "alone": f"{alone}", "driven": driven, "optimal": optimal}


def test_means_are_a_cav_and_the_gap_is_that_of_seeds_with_a_drive() -> None:
    rows = [row(4, 40.0, 38.0, "44.0"), row(4, 60.0, 50.0, "none", "no")]
    found = BoundRow.of("intersection", {}, rows, True)
    assert (found.bound, found.alone, found.driven, found.gap) == (12.5, 11.0, 11.0, 1.0)
    shown = print_bounds([found])
    assert dict(zip(shown.columns, shown.rows[0].cells, strict=True)) == {
        "scenario": "intersection",
        "CAVs": "4",
        "seeds": "2",
        "alone [s]": "11.00",
        "bound [s]": "12.50",
        "driven [s]": "11.00",
        "gap [s]": "1.00",
    }
    assert "In 1 of 2 seeds no such drive was found." in shown.notes
    assert any(note.startswith("In 1 of 2 seeds the search ended at its limit") for note in shown.notes)


def test_what_was_not_looked_for_has_no_column() -> None:
    shown = print_bounds([BoundRow.of("merge", {"x": "1"}, [row(6, 90.0, 90.0)], False)], 0.6, one_order=True)
    assert shown.columns == ("scenario", "x", "CAVs", "seeds", "alone [s]", "bound [s]")
    assert "keeps 0.6 s at zones and one order of vehicles" in shown.notes[0]
    assert "(merge) no more is proven" in shown.notes[1]
