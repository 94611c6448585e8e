"""Means and extremes of what was measured; of nothing there is none."""

import math
import statistics
from collections.abc import Sequence


def mean(values: Sequence[float]) -> float | None:
    """Give the mean; exact summation makes it the same in any order.

    Returns:
        The mean, or None of no values.
    """
    return math.fsum(values) / len(values) if values else None


def median(values: Sequence[float]) -> float | None:
    """Give the median.

    Returns:
        The median, or None of no values.
    """
    return statistics.median(values) if values else None


def share(part: int, whole: int) -> float | None:
    """Give a rate.

    Returns:
        Their ratio, or None of none.
    """
    return part / whole if whole else None
