"""Slots between vehicles that are scheduled, as small tables with both sides of each bound."""

from dataclasses import replace

import pytest
from instances import instance

from codriving.reasoning.ordering.schedule import carried_over, earliest_slot, sequence, start_time
from codriving.reasoning.ordering.tickets import Ticket, in_turn

Pairs = dict[tuple[str, str], float]
AFTER, BEFORE = ("B", "A"), ("A", "B")
"""B goes first, A goes first."""


@pytest.mark.parametrize(
    ("eta", "separation", "fixed", "slot"),
    [
        # B passes at 5 s; A has to pass 2 s before it, or 1.5 s after it.
        (2.9, {AFTER: 1.5, BEFORE: 2.0}, [], 2.9),
        (3.0, {AFTER: 1.5, BEFORE: 2.0}, [], 3.0),
        (3.1, {AFTER: 1.5, BEFORE: 2.0}, [], 6.5),
        (6.4, {AFTER: 1.5, BEFORE: 2.0}, [], 6.5),
        (6.5, {AFTER: 1.5, BEFORE: 2.0}, [], 6.5),
        (6.6, {AFTER: 1.5, BEFORE: 2.0}, [], 6.6),
        # Nothing has to lie between them if A is first.
        (4.9, {AFTER: 1.5}, [], 4.9),
        (5.0, {AFTER: 1.5}, [], 5.0),
        (5.1, {AFTER: 1.5}, [], 6.5),
        # B cannot stop for A, or A cannot stop for B.
        (1.0, {AFTER: 1.5, BEFORE: 2.0}, [AFTER], 6.5),
        (7.0, {AFTER: 1.5, BEFORE: 2.0}, [AFTER], 7.0),
        (5.1, {AFTER: 1.5, BEFORE: 2.0}, [BEFORE], 5.1),
        # B is not in A's way when it goes first, or their ways do not meet at all.
        (5.1, {BEFORE: 2.0}, [], 5.1),
        (5.1, {}, [], 5.1),
    ],
)
def test_the_earliest_slot_beside_one_who_is_scheduled(
    eta: float, separation: Pairs, fixed: list[tuple[str, str]], slot: float
) -> None:
    problem = instance({"A": eta, "B": 5.0}, separation, fixed)
    assert earliest_slot(problem, "A", {"B": 5.0}) == pytest.approx(slot)


def test_a_slot_is_moved_out_of_one_interval_into_the_next_and_out_of_that_too() -> None:
    problem = instance({"A": 3.5, "B": 5.0}, {AFTER: 1.5, BEFORE: 2.0}, A={"windows": [(6.4, 8.0)]})
    assert earliest_slot(problem, "A", {"B": 5.0}) == 8.0


@pytest.mark.parametrize(
    ("times", "separation", "fixed", "order"),
    [
        # A passes its reference point 1 s after B: it is first in their zone if -1 s is enough between A and B.
        ({"B": 4.0, "A": 5.0}, {BEFORE: -1.5, AFTER: 2.0}, [], "AB"),
        ({"B": 4.0, "A": 5.0}, {BEFORE: -1.0, AFTER: 2.0}, [], "AB"),
        ({"B": 4.0, "A": 5.0}, {BEFORE: -0.9, AFTER: 1.0}, [], "BA"),
        # Both ways round fit, or none does: the times tell.
        ({"B": 4.0, "A": 5.0}, {BEFORE: -1.5, AFTER: 0.5}, [], "BA"),
        ({"B": 4.0, "A": 5.0}, {BEFORE: -1.5, AFTER: 1.0}, [], "BA"),
        ({"B": 4.0, "A": 5.0}, {BEFORE: 1.0, AFTER: 2.0}, [], "BA"),
        ({"A": 4.0, "B": 5.0}, {BEFORE: 2.0, AFTER: 2.0}, [], "AB"),
        # Only one way round is known.
        ({"B": 4.0, "A": 5.0}, {BEFORE: -1.5}, [], "AB"),
        ({"B": 4.0, "A": 5.0}, {AFTER: 0.5}, [], "BA"),
        # Their ways do not meet, or it is fixed.
        ({"B": 4.0, "A": 5.0}, {}, [], "BA"),
        ({"B": 4.0, "A": 5.0}, {BEFORE: 1.0, AFTER: 0.5}, [BEFORE], "AB"),
        ({"A": 4.0, "B": 5.0}, {BEFORE: 0.5, AFTER: 0.5}, [AFTER], "BA"),
    ],
)
def test_the_separations_tell_who_is_in_the_zone_first(
    times: dict[str, float], separation: Pairs, fixed: list[tuple[str, str]], order: str
) -> None:
    assert "".join(sequence(instance(times, separation, fixed), times)) == order


def test_one_that_waits_for_a_fixed_pair_comes_after_both() -> None:
    # A cannot stop for B, and B is in the zone that it shares with C first: C, though earlier than A, is the last.
    times = {"B": 4.0, "C": 6.0, "A": 7.0}
    problem = instance(times, {BEFORE: 1.0, AFTER: 1.0, ("B", "C"): 1.0, ("C", "B"): 1.0}, [BEFORE])
    assert sequence(problem, times) == ["A", "B", "C"]


@pytest.mark.parametrize(
    ("previous", "etas", "fixed", "order"),
    [
        ("ABC", {"A": 1.0, "B": 2.0, "C": 3.0}, [], "ABC"),
        ("BAC", {"A": 1.0, "B": 2.0, "C": 3.0}, [], "BAC"),
        # One has gone; one is new, and fits in before C, or comes last.
        ("ABC", {"B": 2.0, "C": 3.0}, [], "BC"),
        ("AC", {"A": 1.0, "B": 2.5, "C": 9.0}, [], "ABC"),
        ("AC", {"A": 1.0, "B": 12.0, "C": 9.0}, [], "ACB"),
        # No vehicle of the order is left, or one pair of two has become impossible.
        ("AB", {"C": 1.0}, [], None),
        ("ABC", {"A": 1.0, "B": 2.0, "C": 3.0}, [("B", "A")], None),
        ("ABC", {"A": 1.0, "B": 2.0, "C": 3.0}, [("B", "C")], "ABC"),
    ],
)
def test_an_order_is_brought_up_to_date(
    previous: str, etas: dict[str, float], fixed: list[tuple[str, str]], order: str | None
) -> None:
    pairs = [(one, other) for one in "ABC" for other in "ABC" if one != other]
    problem = instance(etas, {pair: 1.0 for pair in pairs if etas.keys() >= set(pair)}, fixed)
    found = carried_over(problem, list(previous), sorted(etas))
    assert (found and "".join(found)) == order


@pytest.mark.parametrize(
    ("tickets", "turn"),
    [
        ([(5.0, 0, "A"), (4.0, 0, "B")], "BA"),
        # Within a millionth of a second the rank counts, and then the name.
        ([(5.0, 0, "A"), (5.0000005, -1, "B")], "BA"),
        ([(5.0, 0, "A"), (5.000002, -1, "B")], "AB"),
        ([(5.0, 0, "B"), (5.0, 0, "A")], "AB"),
        ([(5.0, 0, "C"), (5.0, -1, "A"), (4.0, 5, "B")], "BAC"),
    ],
)
def test_equal_tickets_are_told_apart_by_rank_and_name(tickets: list[tuple[float, int, str]], turn: str) -> None:
    assert "".join(t.id for t in in_turn([Ticket(*t) for t in tickets])) == turn


@pytest.mark.parametrize(
    ("eta", "time"),
    [
        # Zones that A and B share: at the first A must not pass from 3 to 4 s, at the second from 7 to 9 s.
        (2.0, 2.0),  # A is first at both
        (3.5, 4.0),
        (5.0, 5.0),  # A is second at the first one, and first at the second one
        (7.0, 7.0),
        (7.5, 9.0),
        (9.5, 9.5),  # A is second at both
    ],
)
def test_zone_by_zone_either_may_be_first(eta: float, time: float) -> None:
    separation = {AFTER: 4.0, BEFORE: 2.0}
    problem = replace(instance({"A": eta, "B": 5.0}, separation), zones={AFTER: ((2.0, -1.0), (-2.0, 4.0))})
    assert start_time(problem, "A", {"B": 5.0}) == time
    assert earliest_slot(problem, "A", {"B": 5.0}) == time
    assert start_time(instance({"A": eta, "B": 5.0}, separation), "A", {"B": 5.0}) == max(eta, 9.0)
