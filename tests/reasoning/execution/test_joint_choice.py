"""On which joint action everybody settles."""

from itertools import product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from codriving.methods.coop_game_fuzzy.joint_choice import Costs, Joint, blended, settle


def drawn(seed: int, n: int) -> Costs:
    rng = np.random.default_rng(seed)
    pair = rng.uniform(0, 1, (n, 3, n, 3))
    pair[np.arange(n), :, np.arange(n), :] = 0.0
    return Costs(rng.uniform(0, 1, (n, 3)), pair)


def by_hand(costs: Costs, joint: Joint) -> list[float]:
    n = range(len(joint))
    return [costs.own[i, joint[i]] + sum(costs.pair[i, joint[i], j, joint[j]] for j in n) for i in n]


def options(n: int) -> list[list[int]]:
    return [[0, 1, 2] for _ in range(n)]


def is_stable(costs: Costs, joint: Joint, participation: float) -> bool:
    for i, option in product(range(len(joint)), range(3)):
        changed = (*joint[:i], option, *joint[i + 1 :])
        now, then = blended(np.array([by_hand(costs, joint), by_hand(costs, changed)]), participation)[:, i]
        if then < now - 1e-9:
            return False
    return True


@given(st.integers(0, 99), st.integers(1, 5), st.data())
def test_costs_add_up(seed: int, n: int, data: st.DataObject) -> None:
    costs = drawn(seed, n)
    joints = data.draw(st.lists(st.tuples(*[st.integers(0, 2)] * n), min_size=1, max_size=4))
    assert costs.of(joints) == pytest.approx(np.array([by_hand(costs, joint) for joint in joints]))


def test_taking_part_blends_own_cost_with_the_mean() -> None:
    costs = np.array([[1.0, 3.0]])
    assert blended(costs, 0.0).tolist() == [[1.0, 3.0]]
    assert blended(costs, 1.0).tolist() == [[2.0, 2.0]]
    assert blended(costs, 0.5).tolist() == [[1.5, 2.5]]


@settings(max_examples=40)
@given(st.integers(0, 999), st.integers(1, 3))
def test_the_group_finds_its_best_if_all_take_part(seed: int, n: int) -> None:
    costs = drawn(seed, n)
    best = min(product(range(3), repeat=n), key=lambda joint: sum(by_hand(costs, joint)))
    assert settle(costs, options(n), 1.0) == best


@settings(max_examples=40)
@given(st.integers(0, 999), st.integers(1, 3), st.sampled_from([0.0, 0.7]))
def test_nobody_would_rather_change_if_there_is_such_a_joint_action(seed: int, n: int, participation: float) -> None:
    costs = drawn(seed, n)
    stable = [joint for joint in product(range(3), repeat=n) if is_stable(costs, joint, participation)]
    found = settle(costs, options(n), participation)
    totals = [sum(by_hand(costs, joint)) for joint in stable or product(range(3), repeat=n)]
    assert not stable or found in stable
    assert sum(by_hand(costs, found)) == pytest.approx(min(totals))


@settings(max_examples=20)
@given(st.integers(0, 999), st.integers(4, 6))
def test_many_arrive_where_nobody_would_rather_change_if_all_take_part(seed: int, n: int) -> None:
    costs = drawn(seed, n)
    assert is_stable(costs, settle(costs, options(n), 1.0), 1.0)


def test_in_a_game_of_chicken_somebody_yields() -> None:
    """Both want option 0, and pay dearly if both take it; the first in the list of equal ones goes."""
    pair = np.zeros((2, 2, 2, 2))
    pair[0, 0, 1, 0] = pair[1, 0, 0, 0] = 5.0
    costs = Costs(np.array([[0.0, 1.0], [0.0, 1.0]]), pair)
    assert settle(costs, [[0, 1], [0, 1]], 0.0) == (0, 1)
    assert settle(costs, [[1], [0, 1]], 0.0) == (1, 0)


def test_looking_after_oneself_can_cost_all_more() -> None:
    """A prisoner's dilemma: option 1 is better for each alone, and worse for both."""
    pair = np.zeros((2, 2, 2, 2))
    pair[0, :, 1, 1] = pair[1, :, 0, 1] = 3.0
    costs = Costs(np.array([[1.0, 0.0], [1.0, 0.0]]), pair)
    assert settle(costs, [[0, 1], [0, 1]], 0.0) == (1, 1)
    assert settle(costs, [[0, 1], [0, 1]], 1.0) == (0, 0)


def test_nobody_settles_on_nothing() -> None:
    assert settle(Costs(np.zeros((0, 3)), np.zeros((0, 3, 0, 3))), [], 0.5) == ()
