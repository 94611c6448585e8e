"""The table and the figure of loads."""

from collections.abc import Callable

import pytest

from codriving.config.choices import styles
from codriving.datatypes.record import Ending, EpisodeRecord
from codriving.reports.figures import load_figure
from codriving.reports.load import LoadRow, load_rows, load_table, print_each_load, print_loads
from codriving.reports.results import CellResults
from tests.reports.making import column_of

Make = Callable[..., EpisodeRecord]

LOADS = (4, 8)


@pytest.fixture
def rows(make: Make) -> list[LoadRow]:
    """Two methods at two scenarios; with more CAVs both are slower, and fcfs fails once."""
    cells = [
        (
            cavs,
            CellResults(
                [
                    make(
                        seed,
                        Ending.TIMEOUT if method == "fcfs" and cavs == 8 and seed == 0 else Ending.SUCCESS,
                        velocities=(9.0 - cavs / 4,),
                        method=method,
                        variant="" if method == "fcfs" else "full",
                        reasoner="none" if method == "fcfs" else "rules",
                        scenario=scenario,
                    )
                    for seed in range(4)
                ],
                cpu=cavs / 1000,
            ),
        )
        for scenario in ("intersection", "roundabout")
        for cavs in LOADS
        for method in ("fcfs", "codriving")
    ]
    return load_rows(cells, ("fcfs", "mcts", "codriving"))


def test_a_row_is_a_method_at_a_scenario_missing_ones_included(rows: list[LoadRow]) -> None:
    names = [(row.scenario, row.method, row.status) for row in rows]
    assert names == [
        (scenario, method, "not there yet" if method == "mcts" else "driven")
        for scenario in ("intersection", "roundabout")
        for method in ("fcfs", "mcts", "codriving")
    ]
    table = load_table(rows, LOADS)
    first = table.rows[0]
    assert (first["episodes"], first["success_rate_4"], first["success_rate_8"]) == (4, 1.0, 0.75)
    assert (first["velocity_mean_4"], first["velocity_mean_8"]) == (8.0, 7.0)
    assert not any("cpu" in key for key in table.keys)
    assert table.csv().splitlines()[2].startswith("intersection,mcts,,,not there yet")


def test_the_table_has_a_column_for_each_load(rows: list[LoadRow]) -> None:
    table = print_loads(rows, LOADS, "standard")
    assert table.title == "load - intersection, roundabout - reasoner: none, rules (llm=offline)"
    shown = dict(zip(table.columns, table.rows[0].cells, strict=True))
    assert shown["success (95 %), 8 CAVs"] == "75 % (30.1 to 95.4)"
    assert shown["velocity [m/s], 4 CAVs"] == "8.00"
    assert [row.last for row in table.rows] == [False, False, True, False, False, False]
    assert "not there yet" in table.rows[1].cells
    assert not any("CPU" in text for text in (*table.columns, *table.notes))


def test_on_the_screen_each_quantity_has_a_table(rows: list[LoadRow]) -> None:
    success, velocity, cpu = print_each_load(rows, LOADS, "standard")
    assert success.title == "load - intersection, roundabout - reasoner: none, rules (llm=offline) - success (95 %)"
    assert [table.title for table in (velocity, cpu)] == ["velocity [m/s]", "CPU [ms]"]
    for table, told in ((success, "75 % (30.1 to 95.4)"), (velocity, "7.00"), (cpu, "8.0")):
        assert dict(zip(table.columns, table.rows[0].cells, strict=True))["8 CAVs"] == told
    assert (success.notes, velocity.notes) == ((), ())
    assert any(note.startswith("CPU") for note in cpu.notes)


def test_a_load_that_was_not_driven_is_empty(make: Make) -> None:
    (row,) = load_rows([(4, CellResults([make(0, velocities=(7.0,))]))], ())
    table = print_loads([row], (4, 12), "standard")
    assert column_of(table, "velocity [m/s], 12 CAVs") == [""]


def test_rules_in_the_place_of_a_language_model_take_the_methods_place(make: Make) -> None:
    cells = [(4, CellResults([make(0, method=name, variant="")])) for name in ("codriving", "dilu-rule")]
    rows = load_rows(cells, ("dilu", "codriving"))
    assert [row.method for row in rows] == ["dilu-rule", "codriving"]
    notes = print_loads(rows, [4], "standard").notes
    assert "dilu-rule: built-in rules in the place of dilu's language model; it is not that method." in notes


def test_the_figure_repeats_to_the_byte_whatever_its_user_has_set(rows: list[LoadRow]) -> None:
    import matplotlib

    first = load_figure(rows, LOADS, "standard", styles())
    with matplotlib.rc_context({"font.size": 20.0, "lines.linewidth": 9.0}):
        assert load_figure(rows, LOADS, "standard", styles()) == first
        assert matplotlib.rcParams["font.size"] == 20.0
    assert first["load.png"].startswith(b"\x89PNG")
    assert b"tEXt" not in first["load.png"]
    assert b"<svg" in first["load.svg"]
    assert b"dc:date" not in first["load.svg"]
    # One line a method and panel, and each method once in the legend.
    assert first["load.svg"].count(b"#0072b2") > len(LOADS)


def test_a_figure_of_failures_and_of_one_load_can_be_drawn(make: Make) -> None:
    failed = load_rows([(4, CellResults([make(0, Ending.ERROR)]))], ())
    assert set(load_figure(failed, (4,), "standard", {})) == {"load.png", "load.svg"}


def test_every_method_looks_different_without_colour() -> None:
    looks = {(marker, stroke) for _, marker, stroke in styles().values()}
    assert len(looks) == len({colour for colour, _, _ in styles().values()}) == len(styles())


def test_lines_of_two_models_and_of_two_choices_of_a_method_have_names_of_their_own(make: Make) -> None:
    def svg(*cells: CellResults) -> bytes:
        return load_figure(load_rows([(4, cell) for cell in cells], ()), (4,), "standard", {})["load.svg"]

    models = svg(*(CellResults([make(0, reasoner=f"a/{name}")]) for name in ("x", "y")))
    assert b"codriving full, x" in models
    assert b"codriving full, y" in models
    chosen = svg(*(CellResults([make(0)], {"method_choice": name}) for name in ("codriving", "mine")))
    assert b"codriving full, mine" in chosen
