"""Intervals and tests against textbook numbers, brute force and each other."""

import math
from statistics import NormalDist

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from codriving.metrics import intervals as paired
from codriving.metrics.intervals import (
    holm,
    mcnemar,
    mean_interval,
    paired_interval,
    rate_interval,
    wilson_interval,
)

FEWEST = 10


@pytest.mark.parametrize(
    ("successes", "trials", "low", "high"),
    [
        (18, 20, 0.699, 0.972),
        (17, 20, 0.640, 0.948),
        (0, 10, 0.0, 0.2775),
        (10, 10, 0.7225, 1.0),
        (1, 2, 0.0945, 0.9055),
    ],
)
def test_known_intervals(successes: int, trials: int, low: float, high: float) -> None:
    assert wilson_interval(successes, trials) == pytest.approx((low, high), abs=6e-4)


@given(st.integers(1, 500), st.floats(0, 1), st.sampled_from([0.8, 0.95, 0.99]))
def test_limits_solve_the_score_equation(trials: int, share: float, confidence: float) -> None:
    successes = round(share * trials)
    low, high = wilson_interval(successes, trials, confidence)
    assert 0 <= low <= successes / trials <= high <= 1
    z = NormalDist().inv_cdf((1 + confidence) / 2)
    for limit in (low, high):
        if 0 < limit < 1:
            assert abs(successes / trials - limit) == pytest.approx(
                z * math.sqrt(limit * (1 - limit) / trials), abs=1e-9
            )


def test_no_trial_is_undefined_not_zero() -> None:
    assert all(math.isnan(limit) for limit in wilson_interval(0, 0))


@pytest.mark.parametrize(("successes", "trials"), [(-1, 3), (4, 3), (0, -1)])
def test_impossible_counts_are_refused(successes: int, trials: int) -> None:
    with pytest.raises(ValueError, match="between 0 and trials"):
        wilson_interval(successes, trials)


@pytest.mark.parametrize(
    ("one", "other", "p"),
    [(0, 0, 1.0), (3, 3, 1.0), (0, 5, 0.0625), (0, 6, 0.03125), (1, 9, 0.021484375), (2, 10, 0.03857421875)],
)
def test_known_p_values(one: int, other: int, p: float) -> None:
    assert mcnemar(one, other) == pytest.approx(p)
    assert mcnemar(other, one) == pytest.approx(p)


@given(st.integers(0, 60), st.integers(0, 60))
def test_it_is_the_sum_of_all_outcomes_that_are_as_unlikely(one: int, other: int) -> None:
    n = one + other
    chances = [math.comb(n, k) for k in range(n + 1)]
    tail = sum(chance for chance in chances if chance <= chances[one])
    assert mcnemar(one, other) == pytest.approx(tail / 2**n)


def test_an_interval_repeats_and_holds_the_mean() -> None:
    differences = [float(x) for x in np.random.default_rng(3).normal(0.5, 1.0, 40)]
    first = mean_interval(differences)
    assert first == mean_interval(differences)
    assert first is not None
    low, high = first
    assert low < np.mean(differences) < high
    # Of so many, it is close to that of the normal distribution.
    half = 1.96 * np.std(differences) / math.sqrt(40)
    assert high - low == pytest.approx(2 * half, rel=0.1)


def test_it_moves_and_turns_round_with_the_differences() -> None:
    differences = [float(x) for x in np.random.default_rng(4).exponential(1.0, 25)]
    low, high = mean_interval(differences) or (math.nan, math.nan)
    assert mean_interval([x + 10 for x in differences]) == pytest.approx((low + 10, high + 10))
    assert mean_interval([-x for x in differences]) == pytest.approx((-high, -low))
    assert mean_interval([0.25] * FEWEST) == pytest.approx((0.25, 0.25))


def test_of_few_pairs_there_is_no_interval() -> None:
    assert mean_interval([1.0] * (FEWEST - 1)) is None
    assert mean_interval([]) is None


def test_it_covers_the_true_mean_about_as_often_as_it_says() -> None:
    rng = np.random.default_rng(11)
    found = [mean_interval(rng.normal(1.0, 2.0, 30).tolist(), resamples=1000) for _ in range(200)]
    covered = sum(low < 1.0 < high for low, high in filter(None, found))
    assert 178 <= covered <= 198


def test_memory_is_bounded_however_many_pairs_there_are(monkeypatch: pytest.MonkeyPatch) -> None:
    differences = np.random.default_rng(5).normal(0.0, 1.0, 50).tolist()
    at_once = mean_interval(differences)
    monkeypatch.setattr(paired, "_AT_ONCE", 1000)
    assert mean_interval(differences) == pytest.approx(at_once)


def test_of_no_event_the_limit_is_that_of_the_rule_of_three() -> None:
    assert rate_interval([0.0] * 12, [25.0] * 12) == (0.0, 0.01), "3 / 300"
    assert rate_interval([0.0] * 9, [25.0] * 9) is None
    assert rate_interval([0.0] * 12, [0.0] * 12) is None


def test_a_rate_is_that_of_the_sums_and_its_interval_holds_it() -> None:
    assert rate_interval([1.0] * 10, [20.0] * 10) == pytest.approx((0.05, 0.05))
    events, units = [0.0, 3.0] * 10, [10.0, 50.0] * 10
    low, high = rate_interval(events, units) or (0.0, 0.0)
    assert 0.035 < low < 0.05 < high < 0.06, "3 of 60, and never above 3 of 50"
    assert (low, high) == rate_interval(events, units)


def test_holm_by_hand() -> None:
    """In order of size: 4 x 0.005, 3 x 0.01, 2 x 0.03, and for 0.04 no less than the one before."""
    assert holm([0.01, 0.04, 0.03, 0.005]) == pytest.approx([0.03, 0.06, 0.06, 0.02])
    assert holm([0.6, 0.7]) == [1.0, 1.0]
    assert holm([]) == []


@given(st.lists(st.floats(0, 1), min_size=1, max_size=20))
def test_holm_lies_between_the_p_value_and_bonferronis(p_values: list[float]) -> None:
    corrected = holm(p_values)
    assert all(p <= c <= min(1.0, len(p_values) * p) + 1e-12 for p, c in zip(p_values, corrected, strict=True))
    assert sorted(range(len(p_values)), key=lambda k: (corrected[k], p_values[k], k)) == sorted(
        range(len(p_values)), key=lambda k: (p_values[k], k)
    )


@pytest.mark.parametrize(
    ("counts", "low", "high"),
    [
        ((36, 12, 2, 0), 0.0569, 0.3404),
        ((36, 14, 0, 0), 0.1528, 0.4167),
        ((54, 0, 0, 0), -0.0664, 0.0664),
        ((2, 12, 2, 34), 0.0537, 0.3421),
    ],
)
def test_known_intervals_of_paired_rates(counts: tuple[int, int, int, int], low: float, high: float) -> None:
    """The first and the third are of Newcombe (1998), table III: pairs with both, the first, the second and neither."""
    both, first, second, _ = counts
    assert paired_interval(both, first, second, sum(counts)) == pytest.approx((low, high), abs=6e-5)


def test_no_interval_of_paired_rates_of_few_pairs() -> None:
    assert paired_interval(3, 0, 6, 9) is None
    assert paired_interval(4, 0, 6, 10) is not None


@given(st.integers(0, 30), st.integers(0, 30), st.integers(0, 30), st.integers(10, 30))
def test_an_interval_of_paired_rates_is_mirrored(both: int, first: int, second: int, neither: int) -> None:
    pairs = both + first + second + neither
    low, high = paired_interval(both, first, second, pairs) or (2.0, 2.0)
    assert -1 <= low <= (first - second) / pairs <= high <= 1
    assert paired_interval(both, second, first, pairs) == pytest.approx((-high, -low))


@pytest.mark.parametrize("differ", [0.05, 0.2, 0.4])
def test_rates_that_are_equal_are_seldom_called_lower(differ: float) -> None:
    """All ways in which 60 pairs with equal rates can fall out, weighed: in 2.5 % the upper limit is below 0."""
    wrong = 0.0
    for unlike in range(61):
        likely = math.comb(60, unlike) * differ**unlike * (1 - differ) ** (60 - unlike)
        for lost in range(unlike + 1):
            interval = paired_interval(round(0.9 * (60 - unlike)), unlike - lost, lost, 60)
            if interval is not None and interval[1] < 0:
                wrong += likely * math.comb(unlike, lost) / 2**unlike
    assert 0 < wrong < 0.03
