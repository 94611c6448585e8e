"""How sure a result is: interval of a rate, test of two rates and interval of a mean difference on the same seeds."""

import math
from collections.abc import Sequence
from statistics import NormalDist

import numpy as np

RESAMPLES = 5000  # Resamples of one interval

FEWEST = 10  # Fewest pairs of which an interval is given; of fewer, resampling makes it much too narrow

_AT_ONCE = 1_000_000  # Numbers drawn at a time, which bounds the memory that many episodes take


def wilson_interval(successes: int, trials: int, confidence: float = 0.95) -> tuple[float, float]:
    """Return the Wilson score interval of a success rate (E. B. Wilson, 1927).

    Written out, since every table needs it and importing SciPy's takes longer than making the tables.

    Returns:
        Lower and upper limit, within 0 and 1; NaN without a trial, where there is no rate either.

    Raises:
        ValueError: If there are fewer than 0 successes or more than trials.
    """
    if not 0 <= successes <= trials:
        raise ValueError(f"successes must be between 0 and trials, got {successes} of {trials}")
    if trials == 0:
        return math.nan, math.nan
    z = NormalDist().inv_cdf((1 + confidence) / 2)
    rate = successes / trials
    centre = rate + z * z / (2 * trials)
    half = z * math.sqrt(rate * (1 - rate) / trials + z * z / (4 * trials * trials))
    scale = 1 + z * z / trials
    # Exactly 0 and 1 at the ends, where rounding would leave 1e-17 or 1 - 1e-16.
    low = 0.0 if successes == 0 else (centre - half) / scale
    high = 1.0 if successes == trials else (centre + half) / scale
    return low, high


def mcnemar(only_first: int, only_second: int) -> float:
    """Test whether two methods succeed equally often (Q. McNemar, 1947; exact, two-sided).

    Under the hypothesis that they do, a seed on which one of them alone succeeds is as likely to be the one's as the
    other's, so the number of the one's is binomial with probability 1/2. Seeds on which both succeed or both fail say
    nothing.

    Returns:
        The p-value; 1 where there is no such seed.
    """
    trials = only_first + only_second
    if trials == 0:
        return 1.0
    from scipy.stats import binomtest

    return float(binomtest(only_first, trials).pvalue)


def paired_interval(both: int, only_first: int, only_second: int, pairs: int) -> tuple[float, float] | None:
    """Return the 95 % interval of a difference of two rates on the same seeds (R. G. Newcombe, 1998; method 10).

    It is made of the Wilson intervals of both rates and their correlation. Resampling would give no width at all where
    both succeed on every seed, and too little where they differ on few.

    Returns:
        Lower and upper limit of the first rate minus the second; None of fewer than ``FEWEST`` pairs.
    """
    if pairs < FEWEST:
        return None
    neither = pairs - both - only_first - only_second
    one, other = both + only_first, both + only_second
    (low, high), (other_low, other_high) = wilson_interval(one, pairs), wilson_interval(other, pairs)
    p, q = one / pairs, other / pairs
    spread = math.sqrt(one * (pairs - one) * other * (pairs - other))
    product = both * neither - only_first * only_second
    # With Newcombe's correction for continuity of a positive correlation.
    phi = (max(product - pairs / 2, 0.0) if product > 0 else product) / spread if spread else 0.0

    def width(a: float, b: float) -> float:
        return math.sqrt(max(a * a - 2 * phi * a * b + b * b, 0.0))

    return p - q - width(p - low, other_high - q), p - q + width(high - p, q - other_low)


def holm(p_values: Sequence[float]) -> list[float]:
    """Correct the p-values of several tests for their number (S. Holm, 1979).

    Returns:
        In the same order; below 0.05 are those that may be called different together, with 5 % risk of a single error.
    """
    corrected, least = [0.0] * len(p_values), 0.0
    for rank, index in enumerate(sorted(range(len(p_values)), key=lambda k: p_values[k])):
        least = max(least, min(1.0, (len(p_values) - rank) * p_values[index]))
        corrected[index] = least
    return corrected


def mean_interval(
    differences: Sequence[float], confidence: float = 0.95, resamples: int = RESAMPLES
) -> tuple[float, float] | None:
    """Bootstrap the mean of paired differences (B. Efron, 1979; percentiles).

    Returns:
        Lower and upper limit; None of fewer than ``FEWEST`` pairs. The same differences give the same interval.
    """
    n = len(differences)
    if n < FEWEST:
        return None
    from scipy.stats import bootstrap

    found = bootstrap(
        (np.asarray(differences, dtype=np.float64),),
        np.mean,
        n_resamples=resamples,
        batch=max(1, _AT_ONCE // n),
        confidence_level=confidence,
        method="percentile",
        rng=np.random.default_rng(0),
    ).confidence_interval
    return float(found.low), float(found.high)


def rate_interval(events: Sequence[float], units: Sequence[float]) -> tuple[float, float] | None:
    """Bootstrap the rate of events a unit, over pairs of both (B. Efron, 1979; percentiles).

    Of no event resampling would tell nothing: then the upper limit is 3 / units (rule of three; J. A. Hanley and
    A. Lippman-Hand, 1983).

    Returns:
        Lower and upper limit; None of fewer than ``FEWEST`` pairs, or of no units.
    """
    n = len(events)
    if n < FEWEST or not sum(units) > 0:
        return None
    if not any(events):
        return 0.0, 3 / sum(units)
    rows = np.random.default_rng(0).integers(n, size=(RESAMPLES, n))
    drawn, of = (np.asarray(values, dtype=np.float64)[rows].sum(axis=1) for values in (events, units))
    low, high = np.quantile(drawn[of > 0] / of[of > 0], (0.025, 0.975))
    return float(low), float(high)
