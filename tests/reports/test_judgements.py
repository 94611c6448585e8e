"""The columns of judgements: shares of what they are shares of, and nothing where none was made."""

from types import SimpleNamespace
from typing import Any

from codriving.reports.judgements import JUDGEMENTS, judgement_columns, judgement_notes

COUNTERS = {
    "judged": 10.0,
    "judged_decided": 8.0,
    "judged_right": 6.0,
    "judged_squares": 2.5,
    "yields_but_went": 1.5,
    "goes_but_yielded": 0.5,
    "seconds_lost": 3.0,
}


def cell(**counters: float) -> Any:
    """Two episodes with some counters."""
    return SimpleNamespace(counters=counters, records=[None, None])


def test_each_is_a_share_of_what_it_is_of() -> None:
    judged = cell(**COUNTERS)
    assert [column.value(judged) for column in JUDGEMENTS] == [0.75, 0.25, 0.1875, 0.0625, 1.5]


def test_nothing_where_none_was_made() -> None:
    judged, ruled = cell(**COUNTERS), cell()
    assert [column.value(ruled) for column in JUDGEMENTS] == [None] * 5
    assert judgement_columns([ruled]) == ()
    assert judgement_notes([ruled]) == []
    assert judgement_columns([ruled, judged]) == JUDGEMENTS


def test_where_only_unclear_answers_were_given_none_was_right_or_wrong() -> None:
    unclear = cell(**{**COUNTERS, "judged_decided": 0.0})
    assert [column.value(unclear) for column in JUDGEMENTS] == [None, 0.25, None, None, 1.5]
