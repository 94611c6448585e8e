"""Whose decision it was: shares, what decided the rest, and the warning where little is the model's."""

from typing import Any

import pytest

from codriving.datatypes.record import EpisodeRecord
from codriving.reports.paper import Paper
from codriving.reports.results import CellResults
from codriving.reports.summary import run_tables
from tests.reports.golden_tables import ASKED, record

COUNTED = {
    "model_decisions": 9, "mended_decisions": 2, "single_decisions": 6, "plain_decisions": 8, "fallback_decisions": 1,
    "model_pairs": 11, "mended_pairs": 4, "repaired_pairs": 80, "fallback_pairs": 9,
    "decisions_as_rules": 6, "pairs_as_rules": 10,
}  # fmt: skip


def of(seed: int, **counts: Any) -> EpisodeRecord:
    return record(seed, reasoner="toy", counts={**ASKED, **counts})


def warnings(*records: EpisodeRecord) -> list[str]:
    notes = run_tables([CellResults(records)], Paper()).page.notes
    return [note for note in notes if note.startswith("Not all of this")]


def test_shares_are_of_all_decisions_and_of_the_pairs_asked_about() -> None:
    found = CellResults([of(0, **COUNTED)]).decided
    assert found is not None
    assert (found.decisions.total, found.decisions.by_model) == (24, 0.375)
    assert (found.pairs.total, found.pairs.by_model) == (100, 0.11)
    assert found.decisions.like_rules == pytest.approx(2 / 3)
    assert found.pairs.part("mended") == 0.04
    assert found.pairs.part("repaired") == 0.8


def test_the_warning_names_the_row_and_what_decided_the_rest() -> None:
    [warning] = warnings(of(0, **COUNTED))
    assert warning == (
        "Not all of this is the model's: toy (intersection, codriving full) decided 37.5 % of the decisions (plain "
        "33.3 %, one option 25 %, fallback 4.17 %) and 11 % of the pairs that it was asked about (repaired 80 %, "
        "fallback 9 %)."
    )


@pytest.mark.parametrize(("by_model", "plain", "warns"), [(90, 10, False), (89, 11, True), (0, 5, True), (0, 0, False)])
def test_below_nine_tenths_there_is_a_warning(by_model: int, plain: int, warns: bool) -> None:
    counts = {"model_decisions": by_model, "plain_decisions": plain, "model_pairs": 1}
    assert bool(warnings(of(0, **counts))) is warns


def test_a_record_of_a_version_that_did_not_count_has_no_share_and_takes_no_part() -> None:
    old = of(1, plain_decisions=1000)
    assert CellResults([old]).decided is None
    assert not warnings(old)
    table = run_tables([CellResults([old])], Paper()).summary
    assert "decisions_by_model" not in table.keys
    both = CellResults([old, of(0, **COUNTED)]).decided
    assert both is not None
    assert both.decisions.total == 24


def test_where_nothing_is_compared_with_rules_there_is_no_agreement() -> None:
    found = CellResults([of(0, model_decisions=3)]).decided
    assert found is not None
    assert found.decisions.like_rules is None
    assert found.pairs.by_model is None


def test_tables_have_the_shares_and_the_counters() -> None:
    made = run_tables([CellResults([of(0, **COUNTED), of(1, **COUNTED)])], Paper())
    [row] = made.summary.rows
    assert (row["decisions_by_model"], row["pairs_by_model"]) == (0.375, 0.11)
    assert (row["repaired_pairs"], row["single_decisions"], row["decisions_as_rules"]) == (160, 12, 12)
    assert {"decisions by model", "pairs by model"} <= set(made.page.columns)
    assert "model_pairs" in made.episodes.keys


def test_rules_alone_are_no_model_of_which_something_could_be_said() -> None:
    made = run_tables([CellResults([record(0)])], Paper())
    assert not any("model" in note for note in made.page.notes)
    assert "decisions_by_model" not in made.summary.keys
