"""Tree search over orders: how good, how sure, and how steady its answers are."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import permutations
from random import Random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from instances import NoPlanner, both, crossroads, instance

from codriving.datatypes.order import Instance
from codriving.datatypes.world import Action
from codriving.errors import ConfigError
from codriving.methods.bruteforce import BruteForce
from codriving.methods.fcfs import FirstComeFirstServed
from codriving.methods.idfst import SpanningTree
from codriving.methods.mcts import MonteCarloTreeSearch, TreeSearch
from codriving.reasoning.ordering.order_search import Coded
from codriving.reasoning.ordering.protocol import JointPlan, Request
from codriving.reasoning.ordering.schedule import Objective, schedule, timed, total_delay


def delay(problem: Instance, rule: MonteCarloTreeSearch | BruteForce | FirstComeFirstServed | SpanningTree) -> float:
    return total_delay(problem, rule.order(problem, NoPlanner()).times)


def searched(problem: Instance, iterations: int, seed: int = 1) -> tuple[float, int, bool]:
    """Search without any seeds; return the cost, the orders tried and whether that were all."""
    found = TreeSearch(Coded(problem, Objective()), 0.5, 0.7, Random(seed)).search([], iterations)
    times = schedule(problem, found.order)
    assert times is not None
    assert total_delay(problem, times) == pytest.approx(found.cost, abs=1e-9)
    return found.cost, found.tried, found.complete


def by_zone(problem: Instance) -> Instance:
    """The same problem, where either of a pair may be first at each of two zones unless that is fixed."""
    apart, fixed = problem.separation, {frozenset(pair) for pair in problem.before}
    pairs = [pair for pair in apart if frozenset(pair) not in fixed and pair[::-1] in apart]
    # Between the two zones there is a while in which the one that is second at the first may be first at the other.
    return replace(
        problem,
        zones={(a, b): ((apart[b, a], apart[a, b] / 4), (-apart[a, b] / 2, apart[a, b])) for a, b in pairs},
    )


@settings(max_examples=40, deadline=None)
@given(st.integers(10_000, 10_200), st.randoms(use_true_random=False), st.booleans())
def test_a_search_and_the_schedule_place_vehicles_alike(seed: int, draw: Random, windows: bool) -> None:
    problem = by_zone(crossroads(seed, 7, windows))
    order = list(problem.vehicles)
    draw.shuffle(order)
    whole, times = Coded(problem, Objective()).run(order), timed(problem, order)
    placed = dict(zip(sorted(problem.vehicles), whole.earliest, strict=True))
    assert placed == pytest.approx(times, abs=1e-9)
    assert whole.delay == pytest.approx(sum(min(t - problem.vehicles[n].eta, 60.0) for n, t in times.items()), abs=1e-6)


def test_zone_by_zone_the_best_order_is_no_worse() -> None:
    for seed in range(10_000, 10_020):
        problem = crossroads(seed, 6)
        assert searched(by_zone(problem), 300)[0] <= searched(problem, 300)[0] + 1e-9


@pytest.mark.parametrize("n", [4, 6])
def test_three_hundred_iterations_find_the_best_order(n: int) -> None:
    best = 0
    for seed in range(10_000, 10_050):
        problem = crossroads(seed, n, seed % 2 == 0)
        rule = MonteCarloTreeSearch()
        rule.reset(seed)
        best += delay(problem, rule) <= delay(problem, BruteForce()) + 1e-6
    assert best >= 48, "95 % of 50"


def test_three_hundred_iterations_without_seeds_find_it_too() -> None:
    hits = sum(
        searched(problem, 300)[0] <= delay(problem, BruteForce()) + 1e-6
        for problem in (crossroads(seed, 6) for seed in range(10_000, 10_050))
    )
    assert hits >= 48


def test_more_iterations_never_cost_more() -> None:
    better = 0
    for seed in range(10_000, 10_010):
        problem = crossroads(seed, 9)
        costs = [searched(problem, iterations, seed)[0] for iterations in (1, 2, 3, 5, 10, 20, 40, 80, 160)]
        assert costs == sorted(costs, reverse=True)
        better += costs[-1] < costs[0]
    assert better >= 5, "searching longer pays"


def mean_cost(exploration: float, heuristic: float, iterations: int) -> float:
    problems = [crossroads(seed, 12) for seed in range(10_000, 10_010)]
    searches = [TreeSearch(Coded(p, Objective()), exploration, heuristic, Random(1)) for p in problems]
    return sum(search.search([], iterations).cost for search in searches) / len(searches)


def test_it_pays_to_look_where_good_orders_are_and_not_only_there() -> None:
    balanced = mean_cost(0.5, 0.0, 300)
    assert balanced < 0.98 * mean_cost(0.0, 0.0, 300), "greedy"
    assert balanced < 0.98 * mean_cost(10.0, 0.0, 300), "everywhere alike"


def test_the_rule_of_thumb_helps_with_a_small_budget() -> None:
    assert mean_cost(0.5, 0.7, 10) < 0.9 * mean_cost(0.5, 0.0, 10)


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(10_000, 10**6), n=st.integers(1, 5), windows=st.booleans())
def test_as_many_iterations_as_orders_are_enough_to_try_all(seed: int, n: int, windows: bool) -> None:
    problem = crossroads(seed, n, windows)
    orders = [times for order in permutations(problem.vehicles) if (times := schedule(problem, order)) is not None]
    cost, tried, complete = searched(problem, len(orders), seed)
    assert complete
    assert tried <= len(orders), "no order is tried twice"
    assert cost == pytest.approx(min(total_delay(problem, times) for times in orders), abs=1e-9)


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(10_000, 10**6), n=st.integers(1, 14), iterations=st.integers(1, 5))
def test_never_worse_than_its_seeds(seed: int, n: int, iterations: int) -> None:
    problem = crossroads(seed, n, True)
    least = min(delay(problem, FirstComeFirstServed()), delay(problem, SpanningTree()))
    assert delay(problem, MonteCarloTreeSearch(iterations=iterations)) <= least + 1e-9


def test_search_stops_when_every_order_has_been_tried() -> None:
    problem = instance({"a": 1.0, "b": 1.5, "c": 1.6}, both("a", "b", 2.0))
    answer = MonteCarloTreeSearch(iterations=100_000).order(problem, NoPlanner())
    assert answer.counts["orders_tried"] == 6
    assert answer.counts["all_orders_tried"] == 1
    assert "of all orders" in answer.reasons["a", "b"]


def test_same_seed_same_search_and_another_step_draws_anew() -> None:
    def found(seed: int, steps: int) -> list[tuple[str, ...]]:
        rule = MonteCarloTreeSearch(iterations=1, hysteresis=0.0)
        rule.reset(seed)
        return [rule.order(crossroads(10_100 + k, 14), NoPlanner()).sequence for k in range(steps)]

    assert found(3, 8) == found(3, 8)
    assert len({tuple(found(seed, 8)) for seed in range(5)}) > 1


def test_another_order_must_save_more_than_the_hysteresis() -> None:
    separation = both("a", "b", 2.0)
    first, then = {"a": 3.0, "b": 3.1}, {"a": 3.0, "b": 2.9}
    rule = MonteCarloTreeSearch()
    assert rule.order(instance(first, separation), NoPlanner()).sequence == ("a", "b")
    kept = rule.order(instance(then, separation, time=0.2), NoPlanner())
    assert kept.sequence == ("a", "b")
    assert kept.counts["order_kept"] == 1
    assert "kept from before" in kept.reasons["a", "b"]
    assert rule.order(instance({"a": 3.2, "b": 2.8}, separation, time=0.4), NoPlanner()).sequence == ("b", "a")
    rule.reset(0)
    assert rule.order(instance(then, separation), NoPlanner()).sequence == ("b", "a")


class Foresees(NoPlanner):
    """Knows how many CAVs are left without a plan in an order, and how far all get in it [m]."""

    def __init__(self, **known: tuple[int, float]) -> None:
        self.known = {tuple(order): plan for order, plan in known.items()}

    def plan(self, order: Sequence[str]) -> JointPlan:
        """Look it up."""
        stuck, worth = self.known[tuple(order)]
        return JointPlan(not stuck, {}, 0.5, stuck, worth)


@pytest.mark.parametrize(
    ("ab", "ba", "sequence", "kept"),
    [
        ((0, 9.0), (0, 8.0), "ab", 1),
        # The order of the last step stays for 0.3 s of hysteresis, which count as 1.5 m.
        ((0, 9.0), (0, 10.4), "ab", 1),
        ((0, 9.0), (0, 10.6), "ba", 0),
        ((1, 99.0), (0, 8.0), "ba", 0),
        ((1, 9.0), (2, 99.0), "ab", 1),
    ],
)
def test_zone_by_zone_the_plans_choose_among_what_is_found_and_the_order_of_the_last_step(
    ab: tuple[int, float], ba: tuple[int, float], sequence: str, kept: int
) -> None:
    rule, separation = MonteCarloTreeSearch(), both("a", "b", 2.0)
    first = rule.order(by_zone(instance({"a": 3.0, "b": 3.1}, separation)), Foresees(ab=(0, 0.0)))
    assert (first.sequence, first.counts["order_kept"]) == (("a", "b"), 0)
    # By the schedule b should go first now.
    then = by_zone(instance({"a": 3.0, "b": 2.9}, separation, time=0.2))
    answer = rule.order(then, Foresees(ab=ab, ba=ba))
    assert ("".join(answer.sequence), answer.counts["order_kept"]) == (sequence, kept)


def test_an_order_that_has_become_impossible_is_given_up() -> None:
    separation, rule = both("a", "b", 2.0) | both("b", "c", 1.0), MonteCarloTreeSearch(hysteresis=10.0)
    assert rule.order(instance({"a": 3.0, "b": 3.1}, separation), NoPlanner()).sequence == ("a", "b")
    fixed = instance({"a": 2.8, "b": 2.9, "c": 9.0}, separation, [("b", "a")], time=0.2)
    answer = rule.order(fixed, NoPlanner())
    assert answer.sequence.index("b") < answer.sequence.index("a")
    assert rule.order(instance({"c": 8.0}, time=3.0), NoPlanner()).sequence == ("c",)


def test_vehicles_come_and_go_and_the_order_stays_possible() -> None:
    for seed in range(10_000, 10_020):
        problem, rule = crossroads(seed, 12, True), MonteCarloTreeSearch(iterations=20)
        names = sorted(problem.vehicles, key=lambda n: problem.vehicles[n].eta)
        for step in range(6):
            there = {n: problem.vehicles[n] for n in names[step : step + 6]}
            inside = {p: w for p, w in problem.separation.items() if set(p) <= set(there)}
            fixed = frozenset(p for p in problem.before if set(p) <= set(there))
            answer = rule.order(Instance(float(step), there, inside, fixed), NoPlanner())
            assert schedule(Instance(float(step), there, inside, fixed), answer.sequence) == answer.times


def test_fixed_pairs_of_vehicles_that_are_gone_do_not_matter() -> None:
    problem = instance({"b": 1.0}, {("gone", "b"): 9.0}, [("gone", "b")])
    assert MonteCarloTreeSearch().order(problem, NoPlanner()).times == {"b": 1.0}


def test_the_exploration_finds_what_the_rule_of_thumb_misses() -> None:
    # What can pass first goes first, which is a: but all others wait for it for long, while it could wait shortly.
    separation = {}
    for other in ("b", "c", "d"):
        separation |= {("a", other): 5.0, (other, "a"): 0.3}
    problem = instance({"a": 1.0, "b": 1.1, "c": 1.1, "d": 1.1}, separation)
    rule = MonteCarloTreeSearch(iterations=60, heuristic=0.9)
    assert rule.order(problem, NoPlanner()).sequence[-1] == "a"
    assert timed(problem, ["b", "c", "d", "a"])["a"] == pytest.approx(1.4)


def test_requests_that_gain_most_together_are_granted() -> None:
    first = Request("a", Action.LANE_LEFT, 1.0, 0.0, frozenset({"b"}))
    second = Request("b", Action.LANE_LEFT, 2.0, 1.0, frozenset({"a"}))
    assert MonteCarloTreeSearch().grant([first, second]) == {"b"}


@pytest.mark.parametrize(
    ("key", "value", "rule"),
    [
        ("iterations", 0, "1 to 100000"),
        ("exploration", -0.1, "0 to 10"),
        ("heuristic", 1.5, "0 to 1"),
        ("hysteresis", 11.0, "0 to 10 s"),
        ("evacuation_weight", -1.0, "0 to 10"),
    ],
)
def test_what_is_out_of_range_is_refused(key: str, value: float, rule: str) -> None:
    with pytest.raises(ConfigError, match=f"{key} must be {rule}, got {value:g}"):
        MonteCarloTreeSearch(**{key: value})  # type: ignore[arg-type]


def test_variant_names_another_objective() -> None:
    assert MonteCarloTreeSearch().variant == ""
    named = MonteCarloTreeSearch(evacuation_weight=0.5, fairness={"b": 2.0, "a": 1.0})
    assert named.variant == "evacuation_weight=0.5,fairness.b=2"
