"""Columns of messages: rates over the time of the world, and ages over uses, not over episodes."""

from collections.abc import Callable

import pytest

from codriving.datatypes.record import EpisodeRecord
from codriving.reports.messages import message_columns
from codriving.reports.results import CellResults

Make = Callable[..., EpisodeRecord]


def values(cell: CellResults) -> dict[str, object]:
    """The values of all columns."""
    return {column.key: column.value(cell) for column in message_columns([cell])}


def test_rates_and_ages_are_over_all_episodes(make: Make) -> None:
    first = {"messages": 600, "message_bytes": 120_000, "message_age": 30.0, "message_uses": 100}
    second = {"messages": 1200, "message_bytes": 360_000, "message_age": 30.0, "message_uses": 20}
    cell = CellResults([make(0, counts=first), make(1, counts=second)])
    # Each episode lasts 12 s.
    assert values(cell) == {"messages_per_second": 75.0, "kilobytes_per_second": 20.0, "message_age_mean": 0.5}


def test_nothing_used_has_no_age(make: Make) -> None:
    sent = {"messages": 12, "message_bytes": 2400, "message_age": 0.0, "message_uses": 0}
    found = values(CellResults([make(0, counts=sent)]))
    assert found == {"messages_per_second": 1.0, "kilobytes_per_second": pytest.approx(0.2), "message_age_mean": None}


def test_without_messages_there_are_no_columns_and_beside_others_no_values(make: Make) -> None:
    without, sends = CellResults([make(0)]), CellResults([make(0, counts={"messages": 12})])
    assert message_columns([without]) == ()
    assert [column.value(without) for column in message_columns([without, sends])] == [None, None, None]
