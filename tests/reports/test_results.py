"""What a language model was asked is in every table of its runs, and in no table of any other."""

from collections.abc import Callable
from dataclasses import replace

import pytest

from codriving.datatypes.record import Ending, EpisodeRecord, NamedNumber
from codriving.reports.comparison import comparison_rows, comparison_table, print_comparison
from codriving.reports.load import load_rows, load_table, print_loads
from codriving.reports.paper import Paper
from codriving.reports.printed import markdown_text
from codriving.reports.results import CellResults
from codriving.reports.summary import run_tables
from tests.reports.making import column_of, episodes_of, print_cells, summary_of, summary_row

Make = Callable[..., EpisodeRecord]
ASKED = (
    "model_calls", "prompt_tokens", "completion_tokens", "cost_usd", "step_seconds", "re_asks", "mended", "fallbacks",
    "shortened", "repaired_orders", "plain_decisions", "kept_orders",
)  # fmt: skip
COUNTS = {
    "model_calls": 1200,
    "prompt_tokens": 400_000,
    "completion_tokens": 20_000,
    "cost_usd": 0.1,
    "re_asks": 190,
    "fallbacks": 10,
    "shortened": 10,
}


@pytest.fixture
def asked(make: Make) -> Callable[..., EpisodeRecord]:
    def record(seed: int, ending: Ending = Ending.SUCCESS, **counts: float) -> EpisodeRecord:
        return make(seed, ending, reasoner="gpt-4o-mini", counts={**COUNTS, **counts})

    return record


def test_the_columns_stand_in_their_order_after_all_others(make: Make, asked: Make) -> None:
    records = [asked(0), make(1, counts={"nodes": 3})]
    assert episodes_of(records).keys[-14:] == ("message", *ASKED, "nodes")
    assert summary_of(records).keys[-14:] == (*ASKED, "fallback_rate", "nodes")


def test_tables_without_a_model_are_as_they_were(make: Make) -> None:
    records = [make(0, counts={"nodes": 3}), make(1)]
    for columns in (episodes_of(records).keys, summary_of(records).keys):
        assert not {*ASKED, "fallback_rate"} & set(columns)
        assert columns[-1] == "nodes"
    tables = run_tables([CellResults(records)], Paper())
    assert tables.printed == tables.page
    assert "tokens" not in markdown_text(tables.page)


def test_a_model_that_was_never_asked_has_zeros_and_rules_have_nothing(make: Make) -> None:
    model, rules = episodes_of([make(0, counts={"cost_usd": 0.0}), make(1)]).rows
    assert [model[name] for name in ASKED] == [0] * len(ASKED)
    assert all(rules[name] is None for name in ASKED)
    assert summary_row([make(0, counts={"cost_usd": 0.0})])["fallback_rate"] is None


def test_failed_episodes_have_been_paid_for_too(make: Make, asked: Make) -> None:
    row = summary_row([asked(0), asked(1, Ending.ERROR), make(2, Ending.ERROR)])
    assert (row["completed"], row["model_calls"], row["cost_usd"], row["kept_orders"]) == (1, 2400, 0.2, 0)


def test_a_step_has_the_mean_time_that_was_waited_for_the_model(make: Make, asked: Make) -> None:
    records = [asked(0, model_seconds=6.0), asked(1, model_seconds=2.0)]
    steps = sum(record.decisions for record in records)
    assert summary_row(records)["step_seconds"] == pytest.approx(8.0 / steps)
    assert episodes_of(records).rows[0]["step_seconds"] == pytest.approx(6.0 / records[0].decisions)
    assert "model_seconds" not in {*episodes_of(records).keys, *summary_of(records).keys}


def test_a_question_that_was_asked_again_counts_once_in_the_share_of_fallbacks(asked: Make) -> None:
    assert summary_row([asked(0)])["fallback_rate"] == 0.01
    never = asked(0, model_calls=10, re_asks=5, fallbacks=5, shortened=0)
    assert summary_row([never])["fallback_rate"] == 1.0


def test_a_price_that_is_not_known_is_not_zero(asked: Make) -> None:
    records = [asked(0), asked(1, unpriced_calls=3)]
    assert [row["cost_usd"] for row in episodes_of(records).rows] == [0.1, None]
    assert summary_row(records)["cost_usd"] is None
    assert "unpriced_calls" not in (*episodes_of(records).keys, *summary_of(records).keys)
    table = print_cells(records)
    assert column_of(table, "cost [USD]") == ["-"]
    assert any("tokens, cost not known;" in note for note in table.notes)
    mixed = print_cells([asked(0)], records)
    assert any("0.1000 USD and what is not known;" in note for note in mixed.notes)


def test_people_read_calls_tokens_cost_and_fallbacks_and_their_sums(make: Make, asked: Make) -> None:
    cells = [CellResults([asked(0), asked(1)]), CellResults([make(0)])]
    table = run_tables(cells, Paper(), notes=["told"]).page
    assert table.title == "intersection - reasoner: gpt-4o-mini, rules (llm=offline)"
    heads = ("calls", "tokens prompt + completion", "cost [USD]", "fallbacks", "step [s]")
    assert table.columns[-5:] == heads
    assert table.rows[0].cells[-5:-1] == ("2,400", "800,000 + 40,000", "0.2000", "1 %")
    assert table.rows[1].cells[-5:] == ("", "", "", "", "")
    sums, meaning, _, told = table.notes[1:]
    assert sums == (
        "In all: 2,400 calls, 800,000 + 40,000 tokens, 0.2000 USD; 380 asked again, 0 mended, "
        "20 fallbacks, 0 repaired orders."
    )
    assert "failed episodes count" in meaning.lower()
    assert told == "told"
    assert markdown_text(table).count("2,400") == 2


def test_the_time_of_a_step_is_one_number_on_the_screen_and_in_the_files(make: Make, asked: Make) -> None:
    tables = run_tables([CellResults([asked(0)]), CellResults([make(1)])], Paper())
    seconds = tables.summary.rows[0]["step_seconds"]
    assert isinstance(seconds, float)
    for table in (tables.printed, tables.page):
        assert table.columns[-1] == "step [s]"
        assert [line.cells[-1] for line in table.rows] == [f"{seconds:.2f}", ""]
        assert "step_seconds in the CSV" in table.notes[-1]


def test_comparisons_show_the_share_of_fallbacks(make: Make, asked: Make) -> None:
    entries = [CellResults([asked(0)]), CellResults([make(0, method="fcfs", reasoner="none")])]
    rows = comparison_rows(entries, ["codriving", "fcfs", "mcts"], Paper())
    assert [row["fallback_rate"] for row in comparison_table(rows).rows] == [0.01, None, None]
    assert "fallback_rate" not in comparison_table(rows[1:]).keys
    assert column_of(print_comparison(rows, "standard"), "fallbacks") == ["1 %", "", ""]
    assert "fallbacks" not in print_comparison(rows[1:], "standard").columns


def test_so_do_loads(make: Make, asked: Make) -> None:
    rows = load_rows([(2, CellResults([asked(0)])), (4, CellResults([asked(0, fallbacks=20)]))], ["codriving"])
    made = load_table(rows, [2, 4])
    assert made.rows[0]["fallback_rate_4"] == 0.02
    assert made.keys[-2:] == ("fallback_rate_2", "fallback_rate_4")
    table = print_loads(rows, [2, 4], "standard")
    assert table.columns[-2:] == ("fallbacks, 2 CAVs", "fallbacks, 4 CAVs")
    assert table.rows[0].cells[-2:] == ("1 %", "2 %")
    rules = load_rows([(2, CellResults([make(0)]))], ["codriving"])
    assert not any(
        "fallback" in name for name in (*print_loads(rules, [2], "standard").columns, *load_table(rules, [2]).keys)
    )


def test_numbers_of_a_metric_are_columns_and_undefined_is_not_zero(make: Make) -> None:
    def waited(seed: int, seconds: float | None, shown: bool = True) -> EpisodeRecord:
        numbers = (
            NamedNumber("waiting_time", seconds, "s", "lower", shown),
            NamedNumber("decisions", 4.0),
        )
        record = make(seed)
        return replace(record, scores={"standard": replace(record.scores["standard"], numbers=numbers)})

    cell = [waited(0, 3.0), waited(1, None), waited(2, 4.0), make(3, Ending.ERROR)]
    assert [row["waiting_time"] for row in episodes_of(cell).rows] == [3.0, None, 4.0, None]
    assert episodes_of(cell).keys[-2:] == summary_of(cell).keys[-2:] == ("waiting_time", "metric_decisions")
    assert (summary_row(cell)["waiting_time"], summary_row(cell)["metric_decisions"]) == (3.5, 4.0)
    table = print_cells(cell)
    assert column_of(table, "waiting time [s]") == ["3.50"]
    assert "waiting time [s]: mean over completed episodes; lower is better." in table.notes
    assert "waiting time [s]" not in print_cells([waited(0, 3.0, shown=False)]).columns
    rows = comparison_rows([CellResults(cell)], ["codriving"], Paper())
    assert comparison_table(rows).rows[0]["waiting_time"] == 3.5
    assert column_of(print_comparison(rows, "standard"), "waiting time [s]") == ["3.50"]
