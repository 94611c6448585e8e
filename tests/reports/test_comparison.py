"""The comparison of methods: every method has its row, and nothing that depends on the machine is kept."""

from collections.abc import Callable

import pytest

from codriving.config.locate import experiments_dir
from codriving.datatypes.record import Ending, EpisodeRecord
from codriving.reports.comparison import PAIRED_NOTES, comparison_rows, comparison_table, print_comparison, print_pairs
from codriving.reports.paper import Paper, read_paper
from codriving.reports.printed import markdown_text
from codriving.reports.results import CellResults
from tests.reports.making import column_of, printed_text

Make = Callable[..., EpisodeRecord]

METHODS = ("fcfs", "madqn", "codriving")
EPISODES = 12


@pytest.fixture
def paper() -> Paper:
    return read_paper(experiments_dir())


@pytest.fixture
def block(make: Make) -> list[CellResults]:
    """Fcfs is slower, with larger PETs; mine is like codriving but for one success less."""
    ours = [make(seed, pets=(2.0,), velocities=(7.0 + seed / 10,)) for seed in range(EPISODES)]
    fcfs = [
        make(seed, pets=(4.0,), velocities=(6.0 + seed / 10,), method="fcfs", variant="", reasoner="none")
        for seed in range(EPISODES)
    ]
    mine = [
        make(seed, LOST if seed == 3 else Ending.SUCCESS, (2.0,), (7.0 + seed / 10,), method="mine", variant="x")
        for seed in range(EPISODES)
    ]
    return [CellResults(fcfs, cpu=0.0042), CellResults(ours, cpu=0.0205), CellResults(mine)]


LOST = Ending.COLLISION


def test_every_method_of_the_table_has_a_row_and_further_ones_follow(block: list[CellResults], paper: Paper) -> None:
    rows = comparison_table(comparison_rows(block, METHODS, paper)).rows
    assert [row["method"] for row in rows] == ["fcfs", "madqn", "codriving", "mine"]
    assert [row["status"] for row in rows] == ["driven", "not there yet", "driven", "driven"]
    fcfs, madqn, ours, mine = rows
    assert (fcfs["velocity_difference"], fcfs["pet_difference"]) == (pytest.approx(-1.0), 2.0)
    assert (fcfs["better_in"], fcfs["worse_in"]) == ("PET", "velocity")
    assert (mine["only_method_succeeds"], mine["only_codriving_succeeds"], mine["mcnemar_p"]) == (0, 1, 1.0)
    assert ours["pairs"] is None
    assert (madqn["paper_success_rate"], madqn["paper_velocity_min"]) == (0.20, 5.4)
    assert madqn["success_rate"] is None


def test_the_csv_has_the_same_columns_whatever_is_missing(block: list[CellResults], paper: Paper) -> None:
    table = comparison_table(comparison_rows(block, METHODS, paper))
    lines = table.csv().splitlines()
    assert lines[0].startswith("scenario,method,variant,reasoner,status,episodes,completed,success_rate,success_low")
    assert lines[0].endswith("paper_velocity_mean,paper_velocity_max,paper_velocity_min")
    assert lines[2].startswith("intersection,madqn,,,not there yet,,")
    assert lines[2].endswith(",0.2,3.7,9,1.8,6.1,6.5,5.4")
    assert not any("cpu" in column or "seconds" in column for column in table.keys)


def test_the_papers_row_stands_below_each_of_ours_also_where_a_method_is_missing(
    block: list[CellResults], paper: Paper
) -> None:
    table = print_comparison(comparison_rows(block, METHODS, paper), "standard", screen=True)
    assert column_of(table, "method") == [
        "fcfs",
        "paper: FCFS",
        "madqn",
        "paper: MADQN",
        "codriving full",
        "paper: CoDrivingLLM",
        "mine x",
    ]
    assert column_of(table, "reasoner")[::2] == ["none", "not there yet", "rules (llm=offline)", "rules (llm=offline)"]
    assert column_of(table, "success")[:4] == ["100 %", "90 %", "", "20 %"]
    assert column_of(table, "CPU [ms]") == ["4.2", "", "", "", "20.5", "", "-"]
    text = printed_text(table)
    assert text.isascii()
    assert "comparison of methods - intersection - reasoner: none, rules (llm=offline)" in text
    assert "Not there yet: madqn" in text
    assert "Reasoner none: an algorithm" in text
    assert "timing.csv alone" in text


def test_what_is_kept_has_no_computing_time(block: list[CellResults], paper: Paper) -> None:
    page = markdown_text(print_comparison(comparison_rows(block, METHODS, paper), "standard"))
    assert "CPU" not in page
    assert "20.5" not in page


def test_who_beats_codriving_is_said_in_the_row_and_below_the_table(block: list[CellResults], paper: Paper) -> None:
    table = print_pairs(comparison_rows(block, METHODS, paper), "standard")
    assert table is not None
    assert column_of(table, "method") == ["fcfs", "mine x"]
    assert column_of(table, "against codriving") == ["better in PET; worse in velocity", "no difference shown"]
    assert column_of(table, "velocity [m/s] (95 %)") == ["-1.00 (-1.00 to -1.00)", "0.00 (0.00 to 0.00)"]
    assert column_of(table, "success [points]") == ["0.0", "-8.3"]
    assert column_of(table, "alone: it / codriving") == ["0 / 0", "0 / 1"]
    assert table.notes[:3] == (
        "Success: no method is above codriving.",
        "Better than codriving: fcfs in PET by +2.00 (+2.00 to +2.00) s - intersection.",
        PAIRED_NOTES[0],
    )
    assert not any(note.startswith("Better than codriving: mine") for note in table.notes)
    assert "better in PET; worse in velocity" in printed_text(table)


def test_few_pairs_show_nothing(make: Make, paper: Paper) -> None:
    block = [
        CellResults([make(seed, velocities=(v,), method=m) for seed in range(3)])
        for m, v in (("a", 9), ("codriving", 1))
    ]
    table = print_pairs(comparison_rows(block, (), paper), "standard")
    assert table is not None
    assert column_of(table, "against codriving") == ["fewer than 10 pairs"]
    assert table.notes[0].startswith("No method is shown to be better")


def test_alone_codriving_has_nothing_to_be_compared_with(make: Make, paper: Paper) -> None:
    rows = comparison_rows([CellResults([make(0)])], METHODS, paper)
    assert print_pairs(rows, "standard") is None
    assert [row.status for row in rows] == ["not there yet", "not there yet", "driven"]


def test_blocks_of_a_sweep_have_their_own_missing_rows_and_end_with_a_line(make: Make, paper: Paper) -> None:
    rows = [
        compared
        for cavs in ("4", "8")
        for compared in comparison_rows(
            [CellResults([make(0)], {"scenario.cavs": cavs})], ("madqn", "codriving"), paper
        )
    ]
    table = print_comparison(rows, "authors", ["scenario.cavs"])
    ours = [row for row in table.rows if row.ours]
    assert [row.cells[1] for row in ours] == ["4", "4", "8", "8"]
    assert [row.last for row in table.rows] == [False, False, False, True, False, False, False, False]
    assert table.title.endswith("metrics: authors")


def by_rules(make: Make) -> list[CellResults]:
    """DiLu and TeLL as they are without a language model, and codriving."""
    dilu = [make(seed, method="dilu-rule", variant="") for seed in range(2)]
    tell = [make(seed, method="tell", variant="rules") for seed in range(2)]
    return [CellResults(dilu), CellResults(tell), CellResults([make(seed) for seed in range(2)])]


def test_rules_in_the_place_of_a_language_model_take_the_methods_place_without_its_numbers(
    make: Make, paper: Paper
) -> None:
    rows = comparison_table(comparison_rows(by_rules(make), ("tell", "dilu", "codriving"), paper)).rows
    assert [(row["method"], row["variant"] or "", row["status"]) for row in rows] == [
        ("tell", "rules", "driven"),
        ("tell", "", "only in the paper"),
        ("dilu-rule", "", "driven"),
        ("dilu", "", "only in the paper"),
        ("codriving", "full", "driven"),
    ]
    assert [row["paper_success_rate"] for row in rows] == [None, 0.52, None, 0.38, 0.90]


def test_rules_in_the_place_of_a_language_model_are_said_to_be_that(make: Make, paper: Paper) -> None:
    rows = comparison_rows(by_rules(make), ("tell", "dilu", "codriving"), paper)
    table = print_comparison(rows, "standard")
    names = column_of(table, "method")
    assert names[:6] == ["tell rules", "tell", "paper: TeLL", "dilu-rule", "dilu", "paper: DiLu"]
    assert "dilu-rule: built-in rules in the place of dilu's language model; it is not that method." in table.notes
    assert any(note.startswith("Only in the paper: tell, dilu; ") for note in table.notes)
    assert column_of(table, "reasoner")[1] == "only in the paper"
    assert print_pairs(rows, "standard") is not None


def test_with_a_language_model_the_papers_numbers_stand_below(make: Make, paper: Paper) -> None:
    block = [CellResults([make(0, method="dilu", variant="", reasoner="some-model")])]
    (row,) = comparison_table(comparison_rows(block, ("dilu",), paper)).rows
    assert (row["status"], row["paper_success_rate"]) == ("driven", 0.38)


def test_the_papers_number_of_seeds_is_given_where_it_is_known(make: Make, paper: Paper) -> None:
    block = [CellResults([make(0, method=name, variant="", reasoner="none")]) for name in ("pidm", "fcfs")]
    table = print_comparison(comparison_rows(block, ("pidm", "fcfs"), paper), "standard")
    assert column_of(table, "method") == ["pidm", "paper: PIDM", "fcfs", "paper: FCFS"]
    assert column_of(table, "episodes")[1::2] == ["-", "20"]
    assert column_of(table, "success")[1::2] == ["25 %", "90 %"]
