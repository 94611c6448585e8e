"""The reference: the same as plain enumeration, and a clear refusal where there are too many orders."""

from itertools import permutations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from instances import NoPlanner, both, crossroads, instance

from codriving.errors import EpisodeError
from codriving.methods.bruteforce import BruteForce
from codriving.reasoning.ordering.schedule import Objective, schedule


@settings(max_examples=60, deadline=None)
@given(
    seed=st.integers(10_000, 10**6),
    n=st.integers(1, 6),
    windows=st.booleans(),
    share=st.sampled_from([0.0, 0.5, 3.0]),
    weight=st.sampled_from([0.5, 1.0, 4.0]),
)
def test_equals_plain_enumeration(seed: int, n: int, windows: bool, share: float, weight: float) -> None:
    problem, fairness = crossroads(seed, n, windows), {"CAV0": weight}
    objective = Objective(share, fairness)
    orders = [times for order in permutations(problem.vehicles) if (times := schedule(problem, order)) is not None]
    answer = BruteForce(evacuation_weight=share, fairness=fairness).order(problem, NoPlanner())
    found = objective.value(problem, answer.times)
    assert found == pytest.approx(min(objective.value(problem, times) for times in orders), abs=1e-6)


def test_more_than_ten_vehicles_are_refused() -> None:
    assert len(BruteForce().order(crossroads(10_000, 10), NoPlanner()).sequence) == 10
    with pytest.raises(EpisodeError, match=r"bruteforce orders at most 10 vehicles, got 11; take method=mcts"):
        BruteForce().order(crossroads(10_000, 11), NoPlanner())


def test_most_orders_are_cut_off() -> None:
    tried = [
        BruteForce().order(crossroads(seed, 8), NoPlanner()).counts["orders_tried"] for seed in range(10_000, 10_020)
    ]
    assert max(tried) < 100, "there are thousands"


def test_keeps_its_order_as_a_search_does() -> None:
    separation, rule = both("a", "b", 2.0), BruteForce()
    assert rule.order(instance({"a": 3.0, "b": 3.1}, separation), NoPlanner()).sequence == ("a", "b")
    assert rule.order(instance({"a": 3.0, "b": 2.9}, separation), NoPlanner()).sequence == ("a", "b")
    rule.reset(0)
    assert rule.order(instance({"a": 3.0, "b": 2.9}, separation), NoPlanner()).sequence == ("b", "a")
