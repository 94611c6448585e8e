"""On which joint action the vehicles settle."""

from itertools import combinations, product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from codriving.methods.coop_game_fuzzy.joint_choice import Costs, Joint, blended, settle, shapley


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
def test_no_vehicle_would_rather_change_if_there_is_such_a_joint_action(
    seed: int, n: int, participation: float
) -> None:
    costs = drawn(seed, n)
    stable = [joint for joint in product(range(3), repeat=n) if is_stable(costs, joint, participation)]
    found = settle(costs, options(n), participation)
    totals = [sum(by_hand(costs, joint)) for joint in stable or product(range(3), repeat=n)]
    assert not stable or found in stable
    assert sum(by_hand(costs, found)) == pytest.approx(min(totals))


@settings(max_examples=20)
@given(st.integers(0, 999), st.integers(4, 6))
def test_many_arrive_where_no_vehicle_would_rather_change_if_all_take_part(seed: int, n: int) -> None:
    costs = drawn(seed, n)
    assert is_stable(costs, settle(costs, options(n), 1.0), 1.0)


def test_in_a_game_of_chicken_a_vehicle_yields() -> None:
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


def test_without_vehicles_nothing_is_settled() -> None:
    assert settle(Costs(np.zeros((0, 3)), np.zeros((0, 3, 0, 3))), [], 0.5) == ()


Worths = dict[frozenset[str], float]


@st.composite
def games(draw: st.DrawFn) -> tuple[list[str], Worths]:
    players = list("abcdef"[: draw(st.integers(1, 5))])
    coalitions = [frozenset(m) for size in range(1, len(players) + 1) for m in combinations(players, size)]
    return players, {frozenset(): 0.0} | {c: draw(st.floats(-10, 10)) for c in coalitions}


@given(games())
def test_shares_add_up_to_the_worth_of_all(game: tuple[list[str], Worths]) -> None:
    players, worths = game
    assert sum(shapley(players, worths.__getitem__).values()) == pytest.approx(worths[frozenset(players)], abs=1e-9)


@given(games())
def test_who_adds_the_same_gets_the_same(game: tuple[list[str], Worths]) -> None:
    players, worths = game
    if len(players) < 2:
        return
    swap = {players[0]: players[1], players[1]: players[0]}

    def worth(members: frozenset[str]) -> float:
        return worths[members] + worths[frozenset(swap.get(p, p) for p in members)]

    shares = shapley(players, worth)
    assert shares[players[0]] == pytest.approx(shares[players[1]], abs=1e-9)


@given(games(), st.floats(-5, 5))
def test_who_adds_nothing_to_any_vehicle_gets_its_own_worth(game: tuple[list[str], Worths], own: float) -> None:
    players, worths = game

    def worth(members: frozenset[str]) -> float:
        return worths[members - {"dummy"}] + (own if "dummy" in members else 0.0)

    shares = shapley([*players, "dummy"], worth)
    assert shares["dummy"] == pytest.approx(own, abs=1e-9)
    assert shares[players[0]] == pytest.approx(shapley(players, worths.__getitem__)[players[0]], abs=1e-9)


def test_one_left_and_two_right_gloves() -> None:
    """A pair is worth 1: the player with the left glove, which is scarce, gets two thirds of it."""
    shares = shapley(["left", "right", "other"], lambda c: float("left" in c and len(c) > 1))
    assert shares == pytest.approx({"left": 2 / 3, "right": 1 / 6, "other": 1 / 6})


def test_every_coalition_is_asked_once() -> None:
    asked: list[frozenset[str]] = []
    shapley(list("abcdef"), lambda c: asked.append(c) or 0.0)  # type: ignore[func-returns-value]
    assert len(asked) == len(set(asked)) == 64
