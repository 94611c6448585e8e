"""Equilibria: no vehicle gains by changing alone, symmetric games of passing have two, and there may be none."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from codriving.methods.noncoop_game.payoff import Array, best_answer, expected_action, pure_equilibria

CHICKEN = np.array([[-10.0, 3.0], [1.0, 0.0]])
"""To go or to wait: to go alone is best, both going is a crash."""

payoffs = arrays(np.float64, (4, 4), elements=st.floats(-20.0, 20.0))


def test_a_symmetric_game_of_passing_has_two_asymmetric_equilibria() -> None:
    assert pure_equilibria(CHICKEN, CHICKEN.T) == ((0, 1), (1, 0))


def test_matching_pennies_has_none_and_the_other_player_takes_the_best_of_the_worst() -> None:
    own = np.array([[1.0, -1.0], [-1.0, 1.0]])
    assert pure_equilibria(own, -own) == ()
    other = np.array([[0.0, 2.0], [-5.0, 1.0]])
    assert expected_action(own, other, 0.0, lambda *_: True) == (1, 1) or not pure_equilibria(own, other)
    assert expected_action(own, -own + np.array([[0.0, 0.5], [0.0, 0.5]]), 0.0, lambda *_: True) == (1, None)


@given(payoffs, payoffs)
def test_in_an_equilibrium_no_vehicle_gains_by_another_action_and_no_such_pair_is_missed(
    own: Array, other: Array
) -> None:
    found = pure_equilibria(own, other)
    for i in range(4):
        for j in range(4):
            stable = all(own[i, j] >= own[k, j] for k in range(4)) and all(other[i, j] >= other[i, k] for k in range(4))
            assert ((i, j) in found) == stable


def test_of_several_equilibria_the_largest_sum_counts_and_of_equal_ones_what_both_would_agree_upon() -> None:
    better = CHICKEN.copy()
    better[1, 0] = 1.5
    assert expected_action(better, CHICKEN.T, 0.0, lambda row, _: row == 0) == (0, 1)
    for row, column in ((0, 1), (1, 0)):
        wanted = expected_action(CHICKEN, CHICKEN.T, 0.0, lambda i, _, row=row: i == row)
        assert wanted == (column, row)
    assert expected_action(better, CHICKEN.T, 1.0, lambda row, _: row == 0) == (1, 0), "nearly equal ones count, too"


@given(payoffs, st.tuples(*[st.integers(0, 3)] * 3), arrays(np.float64, 3, elements=st.floats(0.01, 1.0)))
def test_the_best_answer_is_worth_as_much_as_any_other(own: Array, actions: tuple[int, ...], shares: Array) -> None:
    row, expected = best_answer(own, actions, shares)
    worth = [sum(p * own[k, a] for p, a in zip(shares, actions, strict=True)) for k in range(4)]
    assert np.allclose(expected, worth)
    assert worth[row] >= max(worth) - 1e-9
