"""The learning table and figure: gains on the same seeds, what is shown and what is not, and the paper beside."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from matplotlib.figure import Figure

from codriving.config.locate import experiments_dir
from codriving.datatypes.record import Ending, EpisodeRecord
from codriving.reports.figures import learning_figure
from codriving.reports.learning import LearningRow, learning_rows, learning_table, print_learning
from codriving.reports.paper import read_learning
from codriving.reports.results import CellResults
from tests.reports.making import column_of, summary_of

Make = Callable[..., EpisodeRecord]
SEEDS = 20


@pytest.fixture
def rows(make: Make) -> list[LearningRow]:
    """Ten more of twenty succeed after ten interactions on the merge, and none on the highway."""

    def cell(scenario: str, successes: int, interactions: int, setting: int) -> LearningRow:
        endings = [Ending.SUCCESS if k < successes else Ending.COLLISION for k in range(SEEDS)]
        counts: dict[str, int | float] = {"recalled": 3 * interactions, "reconsidered": interactions}
        records = [
            replace(make(k, ending, velocities=(8.0,), scenario=scenario, counts=counts), memory="frozen abc")
            for k, ending in enumerate(endings)
        ]
        return LearningRow(CellResults(records), interactions, setting, 5)

    cells = [cell("merge", 5, 0, 0), cell("merge", 15, 10, 0), cell("highway", 15, 0, 1), cell("highway", 15, 10, 1)]
    return learning_rows(cells, read_learning(experiments_dir()))


def test_gains_are_against_the_fewest_interactions_of_the_same_setting(rows: list[LearningRow]) -> None:
    values = learning_table(rows).rows
    assert [row["success_gain"] for row in values] == [None, 0.5, None, 0.0]
    assert [row["seeds_gained"] for row in values] == [None, 10, None, 0]
    assert values[1]["mcnemar_p"] == pytest.approx(2 * 0.5**10)
    assert values[3]["mcnemar_p"] == 1.0
    assert [row["interactions"] for row in values] == [0, 10, 0, 10]


def test_the_papers_statement_stands_where_it_belongs(rows: list[LearningRow]) -> None:
    assert [row.claim for row in rows] == [None, "about 75 %", None, None]


def test_a_statement_is_not_put_beside_a_variant(make: Make) -> None:
    degraded = [make(0, scenario="merge", variant="no_safety_check")]
    cells = [LearningRow(CellResults(degraded), n, 0, 5) for n in (0, 10)]
    assert [row.claim for row in learning_rows(cells, read_learning(experiments_dir()))] == [None, None]


def test_a_statement_is_not_put_beside_a_control(make: Make) -> None:
    cells = [LearningRow(CellResults([make(0, scenario="merge")]), 10, 0, 5, control=c) for c in ("none", "rule")]
    assert [row.claim for row in learning_rows(cells, read_learning(experiments_dir()))] == ["about 75 %", None]


def test_the_table_says_what_is_shown(rows: list[LearningRow]) -> None:
    table = print_learning(rows, "standard")
    notes = " ".join(table.notes)
    assert "Shown (p < 0.05): 10 interactions raise success in merge (full). Elsewhere no difference" in notes
    gains = column_of(table, "gain [points] (p)")
    assert gains == ["", "+50.0 (0.002)", "", "0.0 (1.000)"]
    assert [row.last for row in table.rows] == [False, True, False, False]
    assert "In no setting is a difference" in " ".join(print_learning(rows[2:], "standard").notes)


def test_the_figure_repeats_and_marks_the_papers_numbers(rows: list[LearningRow]) -> None:
    paper = read_learning(experiments_dir())
    once, again = (learning_figure(rows, paper, "standard") for _ in range(2))
    assert once == again
    assert set(once) == {"learn.png", "learn.svg"}
    without = learning_figure(rows, (), "standard")["learn.svg"]
    assert once["learn.svg"] != without
    elsewhere = [replace(row, cell=replace(row.cell, papers_setting=False), claim=None, fewest=None) for row in rows]
    assert [row.claim for row in learning_rows(elsewhere, paper)] == [None] * 4
    assert learning_figure(learning_rows(elsewhere, paper), paper, "standard")["learn.svg"] == without


def test_clean_success_and_time_stand_beside_where_they_are_known(
    make: Make, rows: list[LearningRow], monkeypatch: pytest.MonkeyPatch
) -> None:
    axes: list[list[str]] = []

    def kept(figure: Figure, *_: object) -> Mapping[str, bytes]:
        axes.append([axis.get_ylabel() for axis in figure.axes])
        return {}

    monkeypatch.setattr("codriving.reports.figures.saved", kept)
    cells = [
        LearningRow(CellResults([make(k, clean=k < few, time=12.0 + few) for k in range(SEEDS)]), size, 0, 5)
        for size, few in ((0, 5), (10, 15))
    ]
    known = learning_rows(cells, ())
    table = print_learning(known, "standard")
    assert column_of(table, "clean") == ["25 %", "75 %"]
    assert column_of(table, "clean gain (p)") == ["", "+50.0 (0.002)"]
    assert column_of(table, "time of all [s]") == ["17.0", "27.0"]
    assert [row["clean_difference"] for row in learning_table(known).rows] == [None, 0.5]
    assert "clean gain (p)" not in print_learning(rows, "standard").columns
    learning_figure(known, (), "standard")
    learning_figure(rows, (), "standard")
    assert axes == [
        ["success [%], 95 % interval", "clean success [%], 95 % interval"],
        ["success [%], 95 % interval", ""],
    ]


def test_without_the_papers_file_there_is_nothing_beside(tmp_path: Path) -> None:
    assert read_learning(tmp_path) == ()
    assert {s.scenario for s in read_learning(experiments_dir())} == {"highway", "merge", "intersection", "roundabout"}


def test_tables_have_a_column_of_the_memory_only_if_there_was_one(make: Make) -> None:
    with_one = replace(make(0), memory="frozen abc, 2 interactions")
    assert "memory" not in summary_of([make(0)]).keys
    assert "memory" in summary_of([make(0), with_one]).keys
    assert summary_of([with_one]).rows[0]["memory"] == "frozen abc, 2 interactions"


def test_two_models_are_told_apart_in_table_notes_and_figure(make: Make) -> None:
    def cell(model: str, size: int, setting: int) -> LearningRow:
        ending = Ending.SUCCESS if size and model == "openai/one" else Ending.COLLISION
        records = [make(k, ending, velocities=(8.0,), scenario="merge", reasoner=model) for k in range(SEEDS)]
        return LearningRow(CellResults(records), size, setting, 5)

    cells = [cell(model, size, k) for k, model in enumerate(("openai/one", "openai/two")) for size in (0, 10)]
    rows = learning_rows(cells, ())
    table = print_learning(rows, "standard")
    assert column_of(table, "reasoner") == ["one", "one", "two", "two"]
    assert "10 interactions raise success in merge (full, openai/one). Elsewhere" in " ".join(table.notes)
    svg = learning_figure(rows, (), "standard")["learn.svg"]
    assert b"codriving full, one" in svg
    assert b"codriving full, two" in svg


def test_suites_have_panels_and_controls_one_mark_each_in_the_figure(
    make: Make, monkeypatch: pytest.MonkeyPatch
) -> None:
    made: list[tuple[list[str], list[str]]] = []

    def kept(figure: Figure, handles: Mapping[str, Any], *_: str) -> Mapping[str, bytes]:
        made.append(([axis.get_title() for axis in figure.axes], list(handles)))
        return {}

    monkeypatch.setattr("codriving.reports.figures.saved", kept)
    rows = [
        LearningRow(CellResults([make(0, variant=variant)], {"suite": suite}), size, 0, 5, control=control)
        for suite in ("honest", "crowd")
        for variant in ("full", "status_sharing")
        for size, control in ((0, "none"), (5, "none"), (5, "verdicts"), (5, "rule"))
    ]
    learning_figure(rows, (), "standard")
    panels, legend = made[0]
    assert panels == ["intersection\nhonest", "intersection\ncrowd"]
    assert sorted(legend) == [
        "codriving full", "codriving status_sharing", "control, one rule", "control, shuffled verdicts",
    ]  # fmt: skip
