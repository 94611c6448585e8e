"""Time to the conflict point, and the paper's four bands of its difference (Eq. 3)."""

from codriving.datatypes.conflict import Severity

SLOWEST = 0.5
"""Speed below which the time to the conflict point is counted as if at this speed [m/s]; at rest it has none."""


def ttcp(distance: float, speed: float) -> float:
    """Time to the conflict point at the present speed.

    Args:
        distance: Distance to the conflict point [m].
        speed: Speed [m/s].

    Returns:
        Time [s]; 0 at or past the point.
    """
    return max(distance, 0.0) / max(speed, SLOWEST)


def severity(dttcp: float) -> Severity:
    """Put a difference of times to the conflict point into the paper's bands.

    Args:
        dttcp: Absolute difference [s].
    """
    if dttcp <= 2.0:
        return Severity.SERIOUS
    if dttcp <= 5.0:
        return Severity.GENERAL
    if dttcp <= 8.0:
        return Severity.SLIGHT
    return Severity.NONE
