"""First come, first served: tickets, whom a vehicle waits for, and what an ordering must not do."""

from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from instances import NoPlanner, both, crossroads, instance

from codriving.datatypes.order import Instance
from codriving.datatypes.world import Action
from codriving.errors import ConfigError
from codriving.methods.fcfs import FirstComeFirstServed
from codriving.methods.idfst import SpanningTree
from codriving.reasoning.ordering.protocol import Request
from codriving.reasoning.ordering.schedule import total_delay
from codriving.reasoning.ordering.tickets import Ticket, in_turn


def test_two_that_do_not_meet_lose_no_time() -> None:
    problem = instance({"a": 3.0, "b": 3.0})
    assert FirstComeFirstServed().order(problem, NoPlanner()).times == {"a": 3.0, "b": 3.0}


@pytest.mark.parametrize("x", [0.0, 0.5, 1.9, 2.0, 2.5])
def test_second_of_two_that_cross_loses_what_is_left_of_the_separation(x: float) -> None:
    problem = instance({"a": 3.0, "b": 3.0 + x}, both("a", "b", 2.0))
    answer = FirstComeFirstServed().order(problem, NoPlanner())
    assert answer.sequence == ("a", "b")
    assert answer.times["a"] == 3.0
    assert answer.times["b"] - (3.0 + x) == pytest.approx(max(0.0, 2.0 - x))


def test_tickets_do_not_change_when_arrivals_do() -> None:
    rule = FirstComeFirstServed()
    separation = both("a", "b", 2.0)
    assert rule.order(instance({"a": 3.2, "b": 4.1}, separation), NoPlanner()).sequence == ("a", "b")
    answer = rule.order(instance({"a": 6.0, "b": 2.0}, separation, time=1.0), NoPlanner())
    assert answer.sequence == ("a", "b")
    assert answer.reasons["a", "b"] == "a holds the earlier ticket (3.2 s against 4.1 s)"
    gone = rule.order(instance({"b": 1.0}, time=2.0), NoPlanner())
    assert gone.sequence == ("b",)
    back = rule.order(instance({"a": 9.0, "b": 1.0}, separation, time=3.0), NoPlanner())
    assert back.sequence == ("a", "b"), "a ticket outlives a step without conflicts"
    rule.reset(0)
    assert rule.order(instance({"a": 6.0, "b": 2.0}, separation), NoPlanner()).sequence == ("b", "a")


def test_a_vehicle_that_comes_later_gets_a_ticket_within_the_radius() -> None:
    rule, separation = FirstComeFirstServed(control_radius=50.0), both("a", "b", 2.0)
    rule.order(instance({"a": 9.0}, a={"distance": 80.0}), NoPlanner())
    assert "a" in rule.tickets.held, "at the first step each vehicle gets one"
    far = instance({"a": 9.0, "b": 1.0}, separation, time=1.0, b={"distance": 50.1})
    answer = rule.order(far, NoPlanner())
    assert answer.sequence == ("a", "b")
    assert "b" not in rule.tickets.held
    assert answer.reasons["a", "b"] == "a holds a ticket, b is still too far away"
    rule.order(instance({"a": 9.0, "b": 1.0}, separation, time=1.5, b={"distance": 50.0}), NoPlanner())
    assert rule.tickets.held["b"].time == 2.5


def test_equal_tickets_go_by_priority_then_id() -> None:
    close = {"c": 3.0, "b": 3.0 + 4e-7, "a": 3.0 + 8e-7}
    separation = both("a", "b", 1.0) | both("a", "c", 1.0) | both("b", "c", 1.0)
    assert FirstComeFirstServed().order(instance(close, separation), NoPlanner()).sequence == ("a", "b", "c")
    problem = instance(close, separation, c={"priority": 1})
    assert FirstComeFirstServed().order(problem, NoPlanner()).sequence == ("c", "a", "b")
    assert [t.id for t in in_turn([Ticket(1.0 + 2e-6, 0, "a"), Ticket(1.0, 0, "b")])] == ["b", "a"]


def test_order_is_repaired_where_a_ticket_contradicts_what_is_fixed() -> None:
    problem = instance({"a": 5.0, "b": 3.0}, both("a", "b", 1.0), [("a", "b")], b={"leader": "a"})
    answer = FirstComeFirstServed().order(problem, NoPlanner())
    assert answer.sequence == ("a", "b")
    assert answer.reasons["a", "b"] == "a drives ahead of b"


def test_reason_says_so_when_a_later_ticket_goes_first() -> None:
    # c has to wait for a, which is behind b by its ticket; c meets b too.
    problem = instance({"a": 5.0, "b": 4.0, "c": 3.0}, both("a", "c", 1.0) | both("b", "c", 1.0), [("a", "c")])
    answer = FirstComeFirstServed().order(problem, NoPlanner())
    assert answer.sequence == ("b", "a", "c")
    assert answer.reasons["b", "c"] == (
        "b goes in spite of its later ticket (4.0 s against 3.0 s): c has to wait for a vehicle behind it"
    )


def test_reasons_without_tickets() -> None:
    rule = FirstComeFirstServed()
    rule.order(instance({}), NoPlanner())
    far = {"a": {"distance": 90.0}, "b": {"distance": 99.0}}
    answer = rule.order(instance({"a": 8.0, "b": 9.0}, both("a", "b", 1.0), (), 1.0, **far), NoPlanner())
    assert answer.reasons["a", "b"] == "a can arrive before b; both are still too far away for a ticket"


def test_human_driver_is_let_through() -> None:
    problem = instance({"a": 3.0}, a={"windows": [(2.0, 4.5)]})
    assert FirstComeFirstServed().order(problem, NoPlanner()).times == {"a": 4.5}


@settings(max_examples=100, deadline=None)
@given(seed=st.integers(10_000, 10**6), n=st.integers(2, 16), windows=st.booleans())
def test_waiting_for_conflicts_alone_costs_no_more_than_waiting_for_all(seed: int, n: int, windows: bool) -> None:
    problem = crossroads(seed, n, windows)
    conflict = FirstComeFirstServed().order(problem, NoPlanner())
    everybody = FirstComeFirstServed(mode="global").order(problem, NoPlanner())
    assert all(conflict.times[name] <= everybody.times[name] + 1e-9 for name in conflict.times)
    assert total_delay(problem, conflict.times) <= total_delay(problem, everybody.times) + 1e-9
    assert everybody.not_before == everybody.times
    assert not conflict.not_before


def test_global_mode_lets_one_group_through_at_a_time() -> None:
    # a and b pass together; c meets a, d meets none but belongs to the group of c, and so does e, which meets a.
    problem = instance({"a": 1.0, "b": 1.1, "c": 1.2, "d": 1.3, "e": 1.4}, both("a", "c", 0.5) | both("a", "e", 0.5))
    answer = FirstComeFirstServed(mode="global").order(problem, NoPlanner())
    assert answer.times == pytest.approx({"a": 1.0, "b": 1.1, "c": 3.1, "d": 3.1, "e": 3.1})


@settings(max_examples=100, deadline=None)
@given(seed=st.integers(10_000, 10**6), n=st.integers(1, 16), windows=st.booleans())
def test_reservation_mode_is_weighted_idfst(seed: int, n: int, windows: bool) -> None:
    problem = crossroads(seed, n, windows)
    reserved = FirstComeFirstServed(mode="reservation").order(problem, NoPlanner())
    inserted = SpanningTree().order(problem, NoPlanner())
    assert (reserved.sequence, reserved.times) == (inserted.sequence, inserted.times)


def test_far_vehicle_does_not_hold_up_a_near_one_that_it_does_not_meet() -> None:
    problem = instance({"a": 1.0, "far": 0.5, "c": 1.5}, both("a", "c", 1.0), far={"distance": 500.0})
    assert FirstComeFirstServed().order(problem, NoPlanner()).times["c"] == 2.0


def test_order_does_not_depend_on_the_order_of_the_entrants() -> None:
    problem = crossroads(10_005, 9)
    turned = Instance(0.0, dict(reversed(problem.vehicles.items())), problem.separation, problem.before)
    assert FirstComeFirstServed().order(turned, NoPlanner()) == FirstComeFirstServed().order(problem, NoPlanner())


def test_requests_are_granted_as_they_came() -> None:
    first = Request("a", Action.LANE_LEFT, 0.1, 0.0, frozenset({"b", "c"}))
    second = Request("b", Action.LANE_LEFT, 5.0, 1.0, frozenset({"a"}))
    third = replace(second, ego="c", since=2.0)
    apart = Request("d", Action.LANE_LEFT, 0.1, 3.0)
    assert FirstComeFirstServed().grant([first, second, third, apart]) == {"a", "d"}


def test_variant_names_the_mode() -> None:
    assert [FirstComeFirstServed(mode=m).variant for m in ("conflict", "global", "reservation")] == [
        "",
        "global",
        "reservation",
    ]


def test_what_is_out_of_range_is_refused() -> None:
    with pytest.raises(ConfigError, match=r"control_radius must be 1 to 1000 m, got 0"):
        FirstComeFirstServed(control_radius=0)
    with pytest.raises(ConfigError, match=r"mode must be conflict, global or reservation, got fast"):
        FirstComeFirstServed(mode="fast")  # type: ignore[arg-type]
