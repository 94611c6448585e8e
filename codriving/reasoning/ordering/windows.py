"""Windows of human drivers on the clock of the simulation, to tell whether one has moved between two steps."""

from collections.abc import Sequence
from math import inf

from codriving.reasoning.ordering.objective import LONGEST_WAIT


def moved_windows(one: Sequence[tuple[float, float]], other: Sequence[tuple[float, float]], most: float) -> bool:
    """Whether windows of human drivers differ by more than a given time.

    Args:
        one: Windows [s].
        other: Windows, on the same clock [s].
        most: How much they may differ [s].
    """
    if len(one) != len(other):
        return True
    bounds = zip(sorted(one), sorted(other), strict=True)
    return any(a != b and not abs(a - b) <= most for pair in bounds for a, b in zip(*pair, strict=True))


def clock_windows(windows: Sequence[tuple[float, float]], now: float) -> list[tuple[float, float]]:
    """Put windows on the clock of the simulation, overlapping ones as one.

    Args:
        windows: Windows, counted from now [s].
        now: Simulated time [s].

    Returns:
        Those that are not over, by begin; none begins before now, and an end that is out of sight is inf [s].
    """
    joined: list[tuple[float, float]] = []
    seen = [(max(b, 0.0), e if e < LONGEST_WAIT else inf) for b, e in windows]
    for begin, end in sorted((b + now, e + now) for b, e in seen if e > b):
        if joined and begin <= joined[-1][1]:
            joined[-1] = joined[-1][0], max(joined[-1][1], end)
        else:
            joined.append((begin, end))
    return joined


def joined(windows: Sequence[tuple[float, float]], earliest: float) -> list[tuple[float, float]]:
    """Write windows down as few as possible, with the same answer to when a vehicle can pass.

    Args:
        windows: Open intervals [s].
        earliest: Nobody asks for a time before this one [s].

    Returns:
        Intervals that do not overlap, by begin [s].
    """
    found: list[tuple[float, float]] = []
    for begin, end in sorted(window for window in windows if window[0] < window[1] and window[1] > earliest):
        if found and begin < found[-1][1]:
            found[-1] = found[-1][0], max(found[-1][1], end)
        else:
            found.append((begin, end))
    return found
