"""What a language model was asked is in every table of its runs, and in no table of any other."""

from collections.abc import Callable

import pytest

from codriving.datatypes.outcome import Ending
from codriving.datatypes.record import EpisodeRecord
from codriving.reports.comparison import Entry, comparison_columns, comparison_rows
from codriving.reports.comparison_display import measured_display
from codriving.reports.display import display
from codriving.reports.episodes_table import FURTHER, episode_columns, episode_rows
from codriving.reports.load import load_columns, load_rows
from codriving.reports.load_display import load_display
from codriving.reports.markdown import markdown_text
from codriving.reports.model_columns import ASKED
from codriving.reports.paper import Paper
from codriving.reports.run_tables import run_tables
from codriving.reports.summary import summary_columns, summary_row
from codriving.reports.timing_table import seconds_per_decision
from codriving.runs.timing import timing_of

Make = Callable[..., EpisodeRecord]
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
    assert episode_columns(records)[-13:] == (FURTHER[-1], *ASKED, "nodes")
    assert summary_columns(records)[-13:] == (*ASKED, "fallback_rate", "nodes")


def test_tables_without_a_model_are_as_they_were(make: Make) -> None:
    records = [make(0, counts={"nodes": 3}), make(1)]
    for columns in (episode_columns(records), summary_columns(records)):
        assert not {*ASKED, "fallback_rate"} & set(columns)
        assert columns[-1] == "nodes"
    tables = run_tables([records], Paper(), seconds=[0.5])
    assert tables.printed == tables.display
    assert "tokens" not in markdown_text(tables.display)


def test_a_model_that_was_never_asked_has_zeros_and_rules_have_nothing(make: Make) -> None:
    model, rules = episode_rows([make(0, counts={"cost_usd": 0.0}), make(1)])
    assert [model[name] for name in ASKED] == [0] * len(ASKED)
    assert not set(ASKED) & set(rules)
    assert summary_row([make(0, counts={"cost_usd": 0.0})])["fallback_rate"] is None


def test_failed_episodes_have_been_paid_for_too(make: Make, asked: Make) -> None:
    row = summary_row([asked(0), asked(1, Ending.ERROR), make(2, Ending.ERROR)])
    assert (row["completed"], row["model_calls"], row["cost_usd"], row["kept_orders"]) == (1, 2400, 0.2, 0)


def test_a_step_has_the_mean_time_that_was_waited_for_the_model(make: Make, asked: Make) -> None:
    records = [asked(0, model_seconds=6.0), asked(1, model_seconds=2.0)]
    steps = sum(record.decisions for record in records)
    assert summary_row(records)["step_seconds"] == pytest.approx(8.0 / steps)
    assert episode_rows(records)[0]["step_seconds"] == pytest.approx(6.0 / records[0].decisions)
    assert "model_seconds" not in {*episode_columns(records), *summary_columns(records)}


def test_a_question_that_was_asked_again_counts_once_in_the_share_of_fallbacks(asked: Make) -> None:
    assert summary_row([asked(0)])["fallback_rate"] == 0.01
    never = asked(0, model_calls=10, re_asks=5, fallbacks=5, shortened=0)
    assert summary_row([never])["fallback_rate"] == 1.0


def test_a_price_that_is_not_known_is_not_zero(asked: Make) -> None:
    records = [asked(0), asked(1, unpriced_calls=3)]
    assert [row["cost_usd"] for row in episode_rows(records)] == [0.1, None]
    assert summary_row(records)["cost_usd"] is None
    assert "unpriced_calls" not in (*episode_columns(records), *summary_columns(records))
    table = display([summary_row(records)], Paper())
    assert table.lines[0].cells[table.columns.index("cost [USD]")] == "-"
    assert any("tokens, cost not known;" in note for note in table.notes)
    mixed = display([summary_row([asked(0)]), summary_row(records)], Paper())
    assert any("0.1000 USD and what is not known;" in note for note in mixed.notes)


def test_people_read_calls_tokens_cost_and_fallbacks_and_their_sums(make: Make, asked: Make) -> None:
    rows = [summary_row([asked(0), asked(1)]), summary_row([make(0)])]
    table = display(rows, Paper(), notes=["told"])
    assert table.title == "intersection - reasoner: gpt-4o-mini, rules (llm=offline)"
    heads = ("calls", "tokens prompt + completion", "cost [USD]", "fallbacks")
    assert table.columns[-4:] == heads
    assert table.lines[0].cells[-4:] == ("2,400", "800,000 + 40,000", "0.2000", "1 %")
    assert table.lines[1].cells[-4:] == ("", "", "", "")
    sums, meaning, told = table.notes[1:]
    assert sums == (
        "In all: 2,400 calls, 800,000 + 40,000 tokens, 0.2000 USD; 380 asked again, 20 fallbacks, 0 repaired orders."
    )
    assert "failed episodes count" in meaning.lower()
    assert told == "told"
    assert markdown_text(table).count("2,400") == 2


def test_the_time_of_a_step_is_printed_and_in_no_file(asked: Make) -> None:
    tables = run_tables([[asked(0)], [asked(1)]], Paper(), seconds=[1.234, None])
    assert "step [s]" not in tables.display.columns
    assert [line.cells[-1] for line in tables.printed.lines] == ["1.23", "-"]
    assert tables.printed.columns[-1] == "step [s]"
    assert "timing.csv" in tables.printed.notes[-1]


def test_the_time_of_a_step_is_over_all_steps() -> None:
    assert seconds_per_decision([timing_of(9.0, [1.0, 1.0, 1.0]), None, timing_of(9.0, [3.0])]) == 1.5
    assert seconds_per_decision([None, timing_of(9.0, [])]) is None


def test_comparisons_show_the_share_of_fallbacks(make: Make, asked: Make) -> None:
    entries = [Entry([asked(0)]), Entry([make(0, method="fcfs", reasoner="none")])]
    rows = comparison_rows(entries, ["codriving", "fcfs", "mcts"], Paper())
    assert [row.row.get("fallback_rate") for row in rows] == [0.01, None, None]
    assert "fallback_rate" in comparison_columns(model=True)
    assert "fallback_rate" not in comparison_columns()
    table = measured_display(rows, Paper(), "standard")
    where = table.columns.index("fallbacks")
    assert [line.cells[where] for line in table.lines] == ["1 %", "", ""]
    assert "fallbacks" not in measured_display(rows[1:], Paper(), "standard").columns


def test_so_do_loads(make: Make, asked: Make) -> None:
    rows = load_rows([(2, Entry([asked(0)])), (4, Entry([asked(0, fallbacks=20)]))], ["codriving"])
    assert rows[0].row()["fallback_rate_4"] == 0.02
    assert load_columns([2, 4], model=True)[-2:] == ("fallback_rate_2", "fallback_rate_4")
    assert set(rows[0].row()) <= {*load_columns([2, 4], model=True)}
    table = load_display(rows, [2, 4], "standard")
    assert table.columns[-2:] == ("fallbacks, 2 CAVs", "fallbacks, 4 CAVs")
    assert table.lines[0].cells[-2:] == ("1 %", "2 %")
    rules = load_rows([(2, Entry([make(0)]))], ["codriving"])
    assert not any("fallback" in name for name in (*load_display(rules, [2], "standard").columns, *rules[0].row()))
