"""Folders of cells: readable, unique on every file system, and the same whatever stands beside them."""

from dataclasses import replace

from hypothesis import given
from hypothesis import strategies as st
from toy_drive import LABELS
from toy_plan import toy_cell

from codriving.experiment.cells import LONGEST, Cell, distinct, folder_name, repeated
from codriving.experiment.episode import Labels


def folders(*cells: Cell) -> list[str]:
    return [cell.folder for cell in distinct(cells)]


def test_the_same_config_is_one_cell_and_cells_called_alike_are_told_apart() -> None:
    cells = distinct([toy_cell(a=1), toy_cell(a=2), toy_cell(a=1)])
    assert [cell.resolved["a"] for cell in cells] == [1, 2]
    assert len({cell.folder for cell in cells}) == 2
    assert all(cell.folder.startswith("toy-steady-full-") for cell in cells)


def test_a_swept_key_is_in_the_name_whatever_the_order_of_its_values() -> None:
    one, two = toy_cell({"scenario.cavs": "4"}, a=4), toy_cell({"scenario.cavs": "8"}, a=8)
    assert folders(one, two) == ["toy-steady-full-scenario.cavs=4", "toy-steady-full-scenario.cavs=8"]
    assert folders(two, one) == folders(one, two)[::-1]


def test_a_key_that_the_labels_show_is_not() -> None:
    merge = Labels("merge", "steady", "full", "rules")
    cells = [toy_cell({"scenario": "toy"}, a=1), replace(toy_cell({"scenario": "merge"}, a=2), labels=merge)]
    assert folders(*cells) == ["toy-steady-full", "merge-steady-full"]


def test_who_reasons_is_in_the_name_only_where_it_makes_the_difference() -> None:
    models = [replace(LABELS, reasoner=name) for name in ("rules", "gpt-4o-mini")]
    cells = [replace(toy_cell({"llm": str(i)}, a=i), labels=labels) for i, labels in enumerate(models)]
    assert folders(*cells) == ["toy-steady-full-rules", "toy-steady-full-gpt_4o_mini"]
    assert folders(cells[1]) == ["toy-steady-full"]


@given(st.lists(st.text(min_size=1, max_size=300), min_size=1, max_size=6, unique=True))
def test_any_values_give_folders_that_every_file_system_tells_apart(values: list[str]) -> None:
    names = folders(*(toy_cell({"a.b": value}, a=value) for value in values))
    assert len({name.casefold() for name in names}) == len(values)
    for name in names:
        assert name.isascii()
        assert not set(name) & set('<>:"/\\|?* \n')
        assert name.rstrip(". ") == name
        assert len(name) <= LONGEST + 9


def test_folders_of_no_value_that_can_be_read() -> None:
    assert folder_name(LABELS, {"a": "/"}) == "toy-steady-full-a=_"
    assert folder_name(LABELS, {"scenario.hdvs": "[2, 4]", "x": "-1.5"}) == "toy-steady-full-scenario.hdvs=2_4-x=-1.5"


def test_a_repeated_config_is_told_once_and_only_where_a_value_was_asked_for() -> None:
    twice = [toy_cell({"cda": "full", "m": m}, a=1 + int(m)) for m in "12"]
    again = [toy_cell({"cda": "seeking", "m": m}, a=1 + int(m)) for m in "12"]
    assert repeated([*twice, *again]) == (
        "steady full: cda=seeking is the same configuration as cda=full and has no row of its own.",
    )
    assert repeated([toy_cell(a=1), toy_cell(a=1)]) == ()
