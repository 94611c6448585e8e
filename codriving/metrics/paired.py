"""Two methods on the same seeds: exact test of a difference in success, bootstrap interval of a mean difference."""

from collections.abc import Sequence

import numpy as np

RESAMPLES = 5000
"""Resamples of one interval."""

SEED = 0
"""Seed of every bootstrap, so that the same episodes give the same interval."""

FEWEST = 10
"""Fewest pairs of which an interval is given; of fewer, resampling makes it much too narrow."""

_AT_ONCE = 1_000_000
"""Numbers drawn at a time, which bounds the memory that many episodes take."""


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
    values = np.asarray(differences, dtype=np.float64)
    rng = np.random.default_rng(SEED)
    means: list[np.ndarray] = []
    rows = max(1, _AT_ONCE // n)
    for begin in range(0, resamples, rows):
        drawn = rng.integers(n, size=(min(rows, resamples - begin), n))
        means.append(values[drawn].mean(axis=1))
    tail = (1 - confidence) / 2
    low, high = np.quantile(np.concatenate(means), [tail, 1 - tail])
    return float(low), float(high)
