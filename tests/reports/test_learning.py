"""The learning table and figure: gains on the same seeds, what is shown and what is not, and the paper beside."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from codriving.config.locate import experiments_dir
from codriving.datatypes.outcome import Ending
from codriving.datatypes.record import EpisodeRecord
from codriving.reports.learning import LearningCell, learning_columns, learning_rows
from codriving.reports.learning_display import learning_display
from codriving.reports.learning_figure import learning_figure
from codriving.reports.paper_learning import read_learning
from codriving.reports.rows import Row
from codriving.reports.summary import summary_columns, summary_row

Make = Callable[..., EpisodeRecord]
SEEDS = 20


@pytest.fixture
def rows(make: Make) -> list[Row]:
    """Ten more of twenty succeed after ten interactions on the merge, and none on the highway."""

    def cell(scenario: str, successes: int, interactions: int, setting: int) -> LearningCell:
        endings = [Ending.SUCCESS if k < successes else Ending.COLLISION for k in range(SEEDS)]
        counts: dict[str, int | float] = {"recalled": 3 * interactions, "reconsidered": interactions}
        records = [
            replace(make(k, ending, velocities=(8.0,), scenario=scenario, counts=counts), memory="frozen abc")
            for k, ending in enumerate(endings)
        ]
        return LearningCell(records, interactions, setting, {}, 5)

    cells = [cell("merge", 5, 0, 0), cell("merge", 15, 10, 0), cell("highway", 15, 0, 1), cell("highway", 15, 10, 1)]
    return learning_rows(cells, read_learning(experiments_dir()))


def test_gains_are_against_the_fewest_interactions_of_the_same_setting(rows: list[Row]) -> None:
    assert [row.get("success_gain") for row in rows] == [None, 0.5, None, 0.0]
    assert [row.get("seeds_gained") for row in rows] == [None, 10, None, 0]
    assert rows[1]["mcnemar_p"] == pytest.approx(2 * 0.5**10)
    assert rows[3]["mcnemar_p"] == 1.0
    assert set(learning_columns()) >= set(rows[1])
    assert [row["interactions"] for row in rows] == [0, 10, 0, 10]


def test_the_papers_statement_stands_where_it_belongs(rows: list[Row]) -> None:
    assert [row["paper"] for row in rows] == [None, "about 75 %", None, None]


def test_a_statement_is_not_put_beside_a_variant(make: Make) -> None:
    degraded = [make(0, scenario="merge", variant="no_safety_check")]
    cells = [LearningCell(degraded, n, 0, {}, 5) for n in (0, 10)]
    assert [row["paper"] for row in learning_rows(cells, read_learning(experiments_dir()))] == [None, None]


def test_the_table_says_what_is_shown(rows: list[Row]) -> None:
    display = learning_display(rows, "standard")
    notes = " ".join(display.notes)
    assert "Shown (p < 0.05): 10 interactions raise success in merge (full). Elsewhere no difference" in notes
    gains = [line.cells[display.columns.index("gain [points] (p)")] for line in display.lines]
    assert gains == ["", "+50.0 (0.002)", "", "0.0 (1.000)"]
    assert [line.last for line in display.lines] == [False, True, False, False]
    assert "In no setting is a difference" in " ".join(learning_display(rows[2:], "standard").notes)


def test_the_figure_repeats_and_marks_the_papers_numbers(rows: list[Row]) -> None:
    paper = read_learning(experiments_dir())
    once, again = (learning_figure(rows, paper, "standard") for _ in range(2))
    assert once == again
    assert set(once) == {"learn.png", "learn.svg"}
    assert once["learn.svg"] != learning_figure(rows, (), "standard")["learn.svg"]


def test_without_the_papers_file_there_is_nothing_beside(tmp_path: Path) -> None:
    assert read_learning(tmp_path) == ()
    assert {s.scenario for s in read_learning(experiments_dir())} == {"highway", "merge", "intersection", "roundabout"}


def test_tables_have_a_column_of_the_memory_only_if_there_was_one(make: Make) -> None:
    with_one = replace(make(0), memory="frozen abc, 2 interactions")
    assert "memory" not in summary_columns([make(0)])
    assert "memory" in summary_columns([make(0), with_one])
    assert summary_row([with_one])["memory"] == "frozen abc, 2 interactions"
