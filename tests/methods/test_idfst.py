"""iDFST with times: the earliest slot, never later than FCFS, and stable from step to step."""

from collections.abc import Sequence
from itertools import combinations

import pytest
from instances import NoPlanner, both, crossroads, instance, is_valid

from codriving.datatypes.order import Instance
from codriving.datatypes.world import Action
from codriving.errors import ConfigError
from codriving.methods.fcfs import FirstComeFirstServed
from codriving.methods.idfst import SpanningTree, clock_windows, moved_windows
from codriving.reasoning.ordering.protocol import Request
from codriving.reasoning.ordering.schedule import (
    carried_over,
    earliest_slot,
    evacuation_time,
    inserted,
    sequence,
    total_delay,
)


@pytest.mark.parametrize("windows", [False, True])
def test_no_vehicle_passes_later_than_with_fcfs(windows: bool) -> None:
    earlier = 0
    for seed in range(10_000, 10_340):
        problem = crossroads(seed, 2 + seed % 23, windows)
        slots = SpanningTree().order(problem, NoPlanner()).times
        tickets = FirstComeFirstServed().order(problem, NoPlanner()).times
        assert all(slots[name] <= tickets[name] + 1e-9 for name in tickets), seed
        assert evacuation_time(problem, slots) <= evacuation_time(problem, tickets) + 1e-9
        earlier += total_delay(problem, slots) < total_delay(problem, tickets) - 1e-6
    assert earlier > 100, "gaps are filled"


def test_a_gap_is_filled() -> None:
    # Between a and b there is room for c, which comes last.
    separation = both("a", "b", 1.0) | both("a", "c", 1.0) | both("b", "c", 1.0)
    problem = instance({"a": 0.0, "b": 4.0, "c": 4.1}, separation, a={"windows": [(-1.0, 2.0)]})
    early = instance({"a": 0.0, "b": 1.0, "c": 1.5}, separation, b={"windows": [(0.5, 6.0)]})
    assert SpanningTree().order(problem, NoPlanner()).sequence == ("a", "b", "c")
    answer = SpanningTree().order(early, NoPlanner())
    assert answer.sequence == ("a", "c", "b")
    assert answer.times == {"a": 0.0, "c": 1.5, "b": 6.0}
    assert answer.reasons["c", "b"] == "c fits in before b (1.5 s before 6.0 s)"


def test_one_pass_is_not_enough_where_intervals_overlap() -> None:
    # a shuts out 4 to 6, b 1 to 5: asked once in this order, d would be moved out of that of b into that of a.
    separation = both("a", "d", 1.0) | both("b", "d", 2.0)
    problem = instance({"a": 5.0, "b": 3.0, "d": 3.1}, separation)
    assert earliest_slot(problem, "d", {"a": 5.0, "b": 3.0}) == 6.0
    assert earliest_slot(problem, "d", {"b": 3.0, "a": 5.0}) == 6.0


def test_windows_of_human_drivers_are_asked_again_too() -> None:
    problem = instance({"a": 3.0, "d": 3.1}, both("a", "d", 2.0), d={"windows": [(4.5, 7.0), (6.5, 8.0)]})
    assert SpanningTree().order(problem, NoPlanner()).times == {"a": 3.0, "d": 8.0}


def test_far_vehicle_does_not_block_a_layer() -> None:
    # In layers n would share none with far and wait for it; in time it is through long before.
    problem = instance({"far": 9.0, "n": 3.0}, both("far", "n", 2.0))
    assert earliest_slot(problem, "n", {"far": 9.0}) == 3.0
    assert sequence(problem, {"far": 9.0, "n": 3.0}) == ["n", "far"]


def test_the_separation_tells_who_is_first_where_zones_lie_apart() -> None:
    # The shared zone is the second one of a: b may pass its line later and still be in the zone first.
    problem = instance({"a": 0.0, "b": 0.5}, {("a", "b"): 4.0, ("b", "a"): -2.0})
    answer = SpanningTree().order(problem, NoPlanner())
    assert answer.sequence == ("b", "a")
    assert answer.times == {"a": 0.0, "b": 0.5}


def ranks(order: Sequence[str], names: Sequence[str]) -> list[str]:
    return [name for name in order if name in names]


def test_scheduled_vehicles_keep_their_rank_and_a_new_one_is_inserted() -> None:
    separation = {}
    for one, other in combinations("abn", 2):
        separation |= both(one, other, 1.0)
    rule = SpanningTree()
    assert rule.order(instance({"a": 4.0, "b": 4.2}, separation), NoPlanner()).sequence == ("a", "b")
    # b would now be earlier by half a second; the order stays, and n takes the slot before both.
    answer = rule.order(instance({"a": 4.1, "b": 3.6, "n": 1.0}, separation, time=0.2), NoPlanner())
    assert answer.sequence == ("n", "a", "b")
    assert answer.counts == {"scheduled_anew": 0}


def test_a_drift_of_more_than_a_second_schedules_anew() -> None:
    separation, rule = both("a", "b", 2.0), SpanningTree()
    rule.order(instance({"a": 4.0, "b": 4.2}, separation), NoPlanner())
    answer = rule.order(instance({"a": 4.7, "b": 4.0}, separation, time=0.2), NoPlanner())
    assert answer.counts == {"scheduled_anew": 0}, "0.9 s is not enough"
    answer = rule.order(instance({"a": 5.0, "b": 3.8}, separation, time=0.4), NoPlanner())
    assert answer.counts == {"scheduled_anew": 1}
    assert answer.sequence == ("a", "b"), "slots are given in the order of tickets: b may not delay a"


def test_a_drift_frees_the_slot_before_a_vehicle_that_is_late() -> None:
    separation, rule = both("a", "b", 2.0), SpanningTree()
    assert rule.order(instance({"a": 4.0, "b": 4.2}, separation), NoPlanner()).sequence == ("a", "b")
    late = instance({"a": 9.0, "b": 4.0}, separation, time=0.2)
    assert earliest_slot(late, "b", {"a": 9.0}) == 4.0
    assert rule.order(late, NoPlanner()).sequence == ("b", "a")


def test_changed_fixed_pairs_make_a_new_order() -> None:
    separation, rule = both("a", "b", 1.0), SpanningTree()
    rule.order(instance({"a": 4.0, "b": 4.2}, separation), NoPlanner())
    answer = rule.order(instance({"a": 3.8, "b": 4.0}, separation, [("b", "a")], time=0.2), NoPlanner())
    assert answer.sequence == ("b", "a")
    assert answer.counts == {"scheduled_anew": 1}


def test_a_human_window_that_moves_schedules_anew() -> None:
    rule, separation = SpanningTree(), both("a", "b", 1.0)
    rule.order(instance({"a": 4.0, "b": 4.5}, separation, a={"windows": [(8.0, 9.0)]}), NoPlanner())
    still = instance({"a": 3.5, "b": 4.0}, separation, time=0.5, a={"windows": [(7.3, 8.9)]})
    assert rule.order(still, NoPlanner()).counts == {"scheduled_anew": 0}
    moved = instance({"a": 3.0, "b": 3.5}, separation, time=1.0, a={"windows": [(2.0, 7.0)]})
    answer = rule.order(moved, NoPlanner())
    assert answer.counts == {"scheduled_anew": 1}
    assert answer.sequence == ("b", "a"), "b fits in while a lets the human driver through"


def test_a_new_schedule_has_to_save_something() -> None:
    separation = both("a", "b", 2.0)
    steps = [{"a": 4.0, "b": 4.2}, {"a": 6.1, "b": 4.0}]
    orders = {}
    for hysteresis in (0.0, 5.0):
        rule = SpanningTree(hysteresis=hysteresis)
        for k, etas in enumerate(steps):
            orders[hysteresis] = rule.order(instance(etas, separation, time=0.2 * k), NoPlanner()).sequence
    assert orders == {0.0: ("b", "a"), 5.0: ("a", "b")}


@pytest.mark.parametrize("seed", range(10_000, 10_040))
def test_ticket_order_is_stable_while_nothing_drifts(seed: int) -> None:
    problem, rule = crossroads(seed, 9), SpanningTree()
    first = rule.order(problem, NoPlanner())
    for step in range(1, 4):
        moved = crossroads(seed, 9)
        for k, vehicle in enumerate(moved.vehicles.values()):
            vehicle.eta += 0.3 * (-1) ** (k + step) - 0.5 * step
        later = Instance(0.5 * step, moved.vehicles, problem.separation, problem.before)
        assert rule.order(later, NoPlanner()).counts == {"scheduled_anew": 0}
        answer = rule.order(later, NoPlanner())
        pairs = [p for p in combinations(first.sequence, 2) if problem.conflict(*p)]
        assert all(answer.sequence.index(i) < answer.sequence.index(j) for i, j in pairs)


@pytest.mark.parametrize("seed", range(10_000, 10_060))
def test_vehicles_come_and_go_and_the_schedule_stays_valid(seed: int) -> None:
    rule, problem = SpanningTree(), crossroads(seed, 12, True)
    names = sorted(problem.vehicles, key=lambda n: problem.vehicles[n].eta)
    for step in range(6):
        there = set(names[step : step + 6])
        vehicles = {n: e for n, e in problem.vehicles.items() if n in there}
        now = Instance(float(step), vehicles, problem.separation, problem.before)
        answer = rule.order(now, NoPlanner())
        inside = {p: w for p, w in problem.separation.items() if set(p) <= there}
        left = Instance(now.time, vehicles, inside, frozenset(p for p in problem.before if set(p) <= there))
        assert is_valid(left, answer.sequence, dict(answer.times))


def test_an_order_is_carried_over_only_while_it_is_possible() -> None:
    separation = both("a", "b", 1.0) | both("b", "c", 1.0)
    problem = instance({"b": 1.0, "a": 2.0, "c": 1.2}, separation)
    assert carried_over(problem, ["gone", "a", "b"], ["b", "c", "a"]) == ["c", "a", "b"]
    assert carried_over(problem, ["gone"], ["b", "c", "a"]) is None
    assert carried_over(problem, [], ["b", "c", "a"]) is None
    fixed = instance({"a": 2.0, "b": 1.0}, separation, [("b", "a")])
    assert carried_over(fixed, ["a", "b"], ["b", "a"]) is None


def test_slots_are_the_schedule_of_their_order() -> None:
    for seed in range(10_000, 10_050):
        problem = crossroads(seed, 10, True)
        names = list(problem.vehicles)
        slots = inserted(problem, names, {})
        assert sequence(problem, slots) == sorted(slots, key=lambda n: slots[n])


def test_windows_are_compared_on_the_clock() -> None:
    assert clock_windows([(1.0, 3.0), (2.0, 4.0), (-5.0, -1.0), (-1.0, 0.5)], 10.0) == [(10.0, 10.5), (11.0, 14.0)]
    assert clock_windows([(1.0, 1000.0)], 10.0) == clock_windows([(0.0, 1000.0)], 11.0), "for ever stays for ever"
    assert not moved_windows([(11.0, 14.0)], [(11.9, 13.1)], 1.0)
    assert moved_windows([(11.0, 14.0)], [(11.0, 15.1)], 1.0)
    assert moved_windows([(11.0, 14.0)], [], 1.0)
    assert not moved_windows([(11.0, float("inf"))], [(11.0, float("inf"))], 1.0)


def test_the_largest_layer_of_requests_is_granted() -> None:
    first = Request("a", Action.LANE_LEFT, 0.1, 0.0, frozenset({"b", "c"}))
    second = Request("b", Action.LANE_LEFT, 0.1, 1.0, frozenset({"a"}))
    third = Request("c", Action.LANE_LEFT, 0.1, 2.0, frozenset({"a"}))
    assert SpanningTree().grant([first, second, third]) == {"b", "c"}
    assert SpanningTree().grant([first, second]) == {"a"}, "of equal layers the earlier one"
    assert SpanningTree().grant([]) == frozenset()


@pytest.mark.parametrize("key", ["drift", "hysteresis"])
def test_what_is_out_of_range_is_refused(key: str) -> None:
    with pytest.raises(ConfigError, match=f"{key} must be 0 to 10 s, got -1"):
        SpanningTree(**{key: -1.0})
