"""Schedules: what every method's answer has to keep, and who can be better than whom (schedule level, no simulator)."""

from collections.abc import Callable
from itertools import pairwise
from math import inf

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from instances import LEGS, TURNS, NoPlanner, both, crossroads, instance, is_valid, meets

from codriving.errors import ConfigError
from codriving.methods.bruteforce import BruteForce
from codriving.methods.fcfs import FirstComeFirstServed
from codriving.methods.idfst import SpanningTree
from codriving.methods.mcts import MonteCarloTreeSearch
from codriving.reasoning.ordering.order_search import Coded, joined
from codriving.reasoning.ordering.protocol import OrderRule
from codriving.reasoning.ordering.schedule import (
    Objective,
    after_windows,
    evacuation_time,
    repaired,
    schedule,
    timed,
    total_delay,
)

LONGEST_WAIT = 60.0

RULES: dict[str, Callable[[], OrderRule]] = {
    "fcfs": FirstComeFirstServed,
    "fcfs-global": lambda: FirstComeFirstServed(mode="global"),
    "fcfs-reservation": lambda: FirstComeFirstServed(mode="reservation"),
    "idfst": SpanningTree,
    "mcts": lambda: MonteCarloTreeSearch(iterations=20),
    "bruteforce": BruteForce,
}


def test_instances_have_the_conflicts_of_an_intersection() -> None:
    movements = [(leg, turn) for leg in range(len(LEGS)) for turn in TURNS]
    pairs = [(one, other) for one in movements for other in movements if meets(*one, *other)]
    assert len(pairs) == 2 * (16 + 12), "16 crossing and 12 converging pairs"
    assert all((other, one) in pairs for one, other in pairs)


@pytest.mark.parametrize("name", RULES)
@settings(max_examples=40, deadline=None)
@given(seed=st.integers(10_000, 10**6), n=st.integers(1, 9), windows=st.booleans())
def test_every_schedule_keeps_what_is_fixed_and_all_separations(name: str, seed: int, n: int, windows: bool) -> None:
    problem = crossroads(seed, n, windows)
    answer = RULES[name]().order(problem, NoPlanner())
    assert is_valid(problem, answer.sequence, dict(answer.times))


@pytest.mark.parametrize("name", RULES)
def test_every_pair_in_conflict_has_a_reason_that_names_both(name: str) -> None:
    problem = crossroads(10_001, 8)
    answer = RULES[name]().order(problem, NoPlanner())
    place = {n: k for k, n in enumerate(answer.sequence)}
    pairs = {(i, j) for i in place for j in place if place[i] < place[j] and problem.conflict(i, j)}
    assert set(answer.reasons) == pairs
    assert all(i in reason and (j in reason or "ticket" in reason) for (i, j), reason in answer.reasons.items())


@pytest.mark.parametrize("name", RULES)
def test_no_vehicle_to_order_is_an_empty_order(name: str) -> None:
    assert RULES[name]().order(instance({}), NoPlanner()).sequence == ()


@pytest.mark.parametrize("name", RULES)
def test_rules_answer_alike_after_a_reset(name: str) -> None:
    rule = RULES[name]()
    steps = [crossroads(seed, 7, True) for seed in range(10_000, 10_004)]

    def episode() -> list[tuple[str, ...]]:
        rule.reset(5)
        return [rule.order(step, NoPlanner()).sequence for step in steps]

    assert episode() == episode()


@pytest.mark.parametrize("name", RULES)
def test_fixed_pairs_in_a_circle_still_get_an_order(name: str) -> None:
    problem = instance({"a": 1.0, "b": 2.0, "c": 3.0}, both("a", "b", 1.0), [("a", "b"), ("b", "a")])
    assert sorted(RULES[name]().order(problem, NoPlanner()).sequence) == ["a", "b", "c"]


@pytest.mark.parametrize("name", RULES)
def test_a_vehicle_that_waits_for_ever_is_no_obstacle_to_others(name: str) -> None:
    problem = instance({"a": 1.0, "b": 2.0, "c": 3.0}, both("b", "c", 1.0), a={"windows": [(0.0, inf)]})
    answer = RULES[name]().order(problem, NoPlanner())
    assert answer.times["a"] == inf
    if name != "fcfs-global":
        assert answer.times["b"] == 2.0
        assert answer.times["c"] == 3.0


@settings(max_examples=60, deadline=None)
@given(seed=st.integers(10_000, 10**6), n=st.integers(2, 7), windows=st.booleans())
def test_brute_force_then_mcts_then_the_better_of_the_rules(seed: int, n: int, windows: bool) -> None:
    problem = crossroads(seed, n, windows)
    delay = {}
    for rule in (BruteForce(), MonteCarloTreeSearch(iterations=10), FirstComeFirstServed(), SpanningTree()):
        delay[rule.name] = total_delay(problem, rule.order(problem, NoPlanner()).times)
    assert delay["bruteforce"] <= delay["mcts"] + 1e-9
    assert delay["mcts"] <= min(delay["fcfs"], delay["idfst"]) + 1e-9


@settings(max_examples=60, deadline=None)
@given(
    seed=st.integers(10_000, 10**6),
    n=st.integers(1, 8),
    share=st.sampled_from([0.0, 0.5, 2.0]),
    weight=st.sampled_from([0.0, 1.0, 3.0]),
)
def test_search_counts_as_the_objective_does(seed: int, n: int, share: float, weight: float) -> None:
    problem, objective = crossroads(seed, n, True), Objective(share, {"CAV0": weight})
    order = repaired(problem, sorted(problem.vehicles))
    coded = Coded(problem, objective)
    assert coded.cost(coded.run(order)) == pytest.approx(objective.value(problem, timed(problem, order)), abs=1e-9)
    assert coded.bound(coded.root()) <= coded.cost(coded.run(order)) + 1e-9


@pytest.mark.parametrize(("etas", "order"), [((1.0, 2.0), "ab"), ((2.0, 1.0), "ba"), ((1.0, 1.0), "ab")])
def test_of_two_that_can_start_at_once_the_rule_of_thumb_takes_the_one_that_has_waited(
    etas: tuple[float, float], order: str
) -> None:
    # A human driver blocks both until 3 s.
    blocked = {"windows": [(0.5, 3.0)]}
    coded = Coded(instance(dict(zip("ab", etas, strict=True)), both("a", "b", 2.0), a=blocked, b=blocked), Objective())
    found, _ = coded.complete(coded.root(), 1.0, lambda: 0.0)
    assert "".join(coded.named(found.order)) == order


def test_a_search_leaves_out_pairs_with_a_vehicle_that_is_not_to_be_ordered() -> None:
    apart = {("a", "b"): 1.0, ("gone", "a"): 9.0, ("b", "gone"): 9.0}
    coded = Coded(instance({"a": 1.0, "b": 1.5}, apart, [("a", "gone"), ("gone", "b")]), Objective())
    found = coded.run(["a", "b"])
    assert (coded.named(coded.candidates(coded.root())), coded.cost(found)) == (["a", "b"], 0.5)


def test_objective_weighs_delay_and_evacuation() -> None:
    problem = instance({"a": 1.0, "b": 2.0}, both("a", "b", 3.0))
    times = {"a": 1.0, "b": 4.0}
    assert Objective().value(problem, times) == total_delay(problem, times) == 2.0
    assert Objective(0.5).value(problem, times) == 2.0 + 0.5 * evacuation_time(problem, times) == 5.0
    assert Objective(fairness={"b": 3.0}).value(problem, times) == 6.0
    assert Objective().value(problem, {"a": 1.0, "b": inf}) == LONGEST_WAIT
    assert evacuation_time(problem, {}) == Objective(0.5).value(problem, {}) == 0.0


@pytest.mark.parametrize(
    ("weight", "fairness", "variant"),
    [
        (0.0, {}, ""),
        (0.5, {}, "evacuation_weight=0.5"),
        (0.0, {"b": 2.0, "a": 0.25}, "fairness.a=0.25,fairness.b=2"),
        (0.5, {"a": 1.0, "b": 2.0}, "evacuation_weight=0.5,fairness.b=2"),
        (0.0, {"a": 1.0}, ""),
    ],
)
def test_variant_names_the_weights_that_change_something(
    weight: float, fairness: dict[str, float], variant: str
) -> None:
    assert Objective(weight, fairness).variant == variant


@pytest.mark.parametrize(("weight", "fairness"), [(-0.1, {}), (11.0, {}), (0.0, {"a": -1.0}), (0.0, {"a": 101.0})])
def test_weights_out_of_range_are_refused(weight: float, fairness: dict[str, float]) -> None:
    with pytest.raises(ConfigError, match=r"must be 0 to 1"):
        Objective(weight, fairness)


def test_fairness_changes_who_goes_first() -> None:
    problem = instance({"a": 1.0, "b": 1.1}, both("a", "b", 2.0))
    assert BruteForce().order(problem, NoPlanner()).sequence == ("a", "b")
    assert BruteForce(fairness={"b": 5.0}).order(problem, NoPlanner()).sequence == ("b", "a")
    assert MonteCarloTreeSearch(fairness={"b": 5.0}).order(problem, NoPlanner()).sequence == ("b", "a")


def test_schedule_refuses_an_order_against_what_is_fixed() -> None:
    problem = instance({"a": 1.0, "b": 2.0}, both("a", "b", 3.0), [("a", "b")])
    assert schedule(problem, ["b", "a"]) is None
    assert timed(problem, ["b", "a"]) == {"b": 2.0, "a": 5.0}
    assert schedule(problem, ["a", "b"]) == {"a": 1.0, "b": 4.0}
    assert repaired(problem, ["b", "a"]) == ["a", "b"]


@settings(max_examples=200, deadline=None)
@given(
    windows=st.lists(st.tuples(st.integers(-3, 9), st.integers(-3, 12)), max_size=5),
    earliest=st.integers(-2, 6),
    later=st.sampled_from([0.0, 0.5, 1.0, 2.5, 4.0]),
)
def test_joined_windows_block_the_same_times(windows: list[tuple[int, int]], earliest: int, later: float) -> None:
    few = joined([(float(b), float(e)) for b, e in windows], float(earliest))
    assert after_windows(earliest + later, few) == after_windows(earliest + later, windows)
    assert all(one[1] <= other[0] for one, other in pairwise(few))


def test_windows_that_touch_are_all_left() -> None:
    assert after_windows(2.5, [(4.0, 6.0), (2.0, 5.0)]) == 6.0
    assert after_windows(2.0, [(2.0, 5.0)]) == 2.0, "windows are open: at its edge no vehicle is in it"
