"""How far a human driver is assumed to come at the least and at the most."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

HARD_BRAKING = 6.0
"""Hardest braking expected of a human driver [m/s2]."""

HARD_ACCELERATION = 1.5
"""Hardest acceleration expected of a human driver [m/s2]."""


DRIFT = (1.0, 0.75, 6.0)
"""How far a driver may be from where constant speed leads: at once [m], more each second [m/s], and at most [m]."""


def likely(speed: float, times: Array) -> tuple[Array, Array]:
    """Distances between which a driver is expected, who goes on at about the present speed.

    Args:
        speed: Speed now [m/s].
        times: Times from now (n,) [s].

    Returns:
        The least and the most, each (n,) [m].
    """
    at_once, each_second, at_most = DRIFT
    drift = np.minimum(at_once + each_second * times, at_most)
    return np.maximum(speed * times - drift, 0.0), speed * times + drift


def slowest(speed: float, times: Array) -> Array:
    """Distance of a driver who brakes hard at once.

    Args:
        speed: Speed now [m/s].
        times: Times from now (n,) [s].

    Returns:
        Distance travelled (n,) [m].
    """
    braking = np.minimum(times, speed / HARD_BRAKING)
    return np.asarray(speed * braking - HARD_BRAKING * braking**2 / 2)


def fastest(speed: float, times: Array, limit: float) -> Array:
    """Distance of a driver who accelerates hard up to the speed limit.

    Args:
        speed: Speed now [m/s].
        times: Times from now (n,) [s].
        limit: Speed limit [m/s]; a driver who is faster keeps the speed.

    Returns:
        Distance travelled (n,) [m].
    """
    gain = max(limit - speed, 0.0)
    rising = np.minimum(times, gain / HARD_ACCELERATION)
    return np.asarray(speed * times + HARD_ACCELERATION * rising**2 / 2 + HARD_ACCELERATION * rising * (times - rising))
