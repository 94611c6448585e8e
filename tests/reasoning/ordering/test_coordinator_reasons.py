"""Why one vehicle goes before another one, as small tables: the first rule that fits speaks."""

from typing import Any

import pytest
from instances import instance

from codriving.reasoning.ordering.coordinator import reason_between
from codriving.reasoning.ordering.premise import premise
from codriving.reasoning.ordering.protocol import Action, Request, best_subset, in_order
from codriving.reasoning.ordering.tickets import Ticket, by_slot, by_ticket, fixed


@pytest.mark.parametrize(
    ("etas", "first", "second", "reason"),
    [
        ((3.0, 4.0), {}, {}, "earlier (3.0 s against 4.0 s)"),
        ((4.0, 4.0), {}, {}, "earlier (4.0 s against 4.0 s)"),
        ((4.1, 4.0), {}, {}, "wait less"),
        ((4.1, 4.0), {"committed": True}, {}, "can no longer stop"),
        ((4.1, 4.0), {"committed": True}, {"committed": True}, "wait less"),
        ((4.1, 4.0), {}, {"committed": True}, "wait less"),
        ((4.1, 4.0), {}, {"leader": "A"}, "drives ahead of B"),
        ((4.1, 4.0), {}, {"leader": "C"}, "wait less"),
        ((4.1, 4.0), {"committed": True}, {"leader": "A"}, "can no longer stop"),
        # A turn that is given up for one who goes straight, less than 2 s later or earlier than that.
        ((4.1, 4.0), {}, {"turning": True}, "B turns and yields to A"),
        ((2.1, 4.0), {}, {"turning": True}, "B turns and yields to A"),
        ((2.0, 4.0), {}, {"turning": True}, "earlier (2.0 s against 4.0 s)"),
        ((4.1, 4.0), {"turning": True}, {"turning": True}, "wait less"),
        ((4.1, 4.0), {"turning": True}, {}, "wait less"),
    ],
)
def test_reason_between_two_cavs(
    etas: tuple[float, float], first: dict[str, Any], second: dict[str, Any], reason: str
) -> None:
    problem = instance({"A": etas[0], "B": etas[1]}, A=first, B=second)
    assert reason in reason_between(problem, "A", "B")


@pytest.mark.parametrize(
    ("first", "second", "reason"),
    [
        ({}, {"leader": "A"}, "A drives ahead of B"),
        ({"committed": True}, {"leader": "A"}, "A drives ahead of B"),
        ({"committed": True}, {}, "A can no longer stop, B can"),
        ({"committed": True}, {"committed": True}, "A has to go before B as they drive"),
        ({}, {"leader": "C"}, "A has to go before B as they drive"),
    ],
)
def test_reason_of_what_is_fixed(first: dict[str, Any], second: dict[str, Any], reason: str) -> None:
    assert fixed(instance({"A": 1.0, "B": 2.0}, A=first, B=second), "A", "B") == reason


@pytest.mark.parametrize(
    ("mine", "theirs", "ticket", "slot"),
    [
        (3.0, 4.0, "A holds the earlier ticket (3.0 s against 4.0 s)", ""),
        (4.0, 4.0, "A holds the earlier ticket (4.0 s against 4.0 s)", ""),
        (
            4.1,
            4.0,
            "A goes in spite of its later ticket (4.1 s against 4.0 s)",
            "fits in before B (5.0 s before 6.0 s)",
        ),
        (3.0, None, "A holds a ticket, B is still too far away", ""),
        (None, 4.0, "A goes without a ticket", "fits in before B (5.0 s before 6.0 s)"),
        (None, None, "both are still too far away for a ticket", ""),
    ],
)
def test_reason_of_tickets_and_slots(mine: float | None, theirs: float | None, ticket: str, slot: str) -> None:
    held = {name: Ticket(time, 0, name) for name, time in (("A", mine), ("B", theirs)) if time is not None}
    assert ticket in by_ticket("A", "B", held)
    assert (slot or ticket) in by_slot("A", "B", held, {"A": 5.0, "B": 6.0})


@pytest.mark.parametrize(("eta", "held"), [(2.0, False), (2.1, True), (3.9, True), (4.0, False), (4.1, False)])
def test_a_premise_knows_who_is_held_up_by_a_human_driver(eta: float, held: bool) -> None:
    problem = instance({"A": eta, "B": 3.0}, A={"windows": [(2.0, 4.0)]})
    assert premise(problem, [("A", "B")]).held == (frozenset({"A"}) if held else frozenset())


def request(ego: str, incentive: float, *excludes: str, since: float = 0.0) -> Request:
    return Request(ego, Action.LANE_LEFT, incentive, since, frozenset(excludes))


@pytest.mark.parametrize(
    ("requests", "first", "best"),
    [
        ([request("A", 1.0), request("B", 1.0)], "AB", "AB"),
        ([request("A", 1.0, "B"), request("B", 3.0, "A")], "A", "B"),
        # B alone gains 3, A and C together 4; in order A goes, then C.
        ([request("A", 2.0, "B"), request("B", 3.0, "A", "C"), request("C", 2.0, "B")], "AC", "AC"),
        # B alone gains 5: more than A and C.
        ([request("A", 2.0, "B"), request("B", 5.0, "A", "C"), request("C", 2.0, "B")], "AC", "B"),
        # Of equal gains the one that asked first.
        ([request("A", 1.0, "B", since=2.0), request("B", 1.0, "A", since=1.0)], "A", "B"),
        ([request("A", float("inf"), "B"), request("B", 9.0, "A")], "A", "A"),
        ([], "", ""),
    ],
)
def test_requests_that_are_granted(requests: list[Request], first: str, best: str) -> None:
    assert "".join(sorted(in_order(requests))) == first
    assert "".join(sorted(best_subset(requests))) == best
