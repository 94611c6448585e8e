"""When a planned motion first comes too close to somebody: the one test by which plans are judged."""

import numpy as np
from numpy.typing import NDArray

from codriving.geometry.box import PLANNING, TRUE, Footprint
from codriving.geometry.zone import ConflictZone
from codriving.reasoning.safety.conflict_lane import BODY

Array = NDArray[np.float64]
Steps = NDArray[np.int64]

SIZES: tuple[Footprint, ...] = (PLANNING, BODY, TRUE)
"""Sizes of vehicles for planning; a smaller one is taken where vehicles are already closer together than the larger."""


def first_true(flags: NDArray[np.bool_]) -> Steps:
    """Return the first step at which a flag is set in each row (plans,); the number of steps where none is."""
    return np.asarray(np.where(flags.any(axis=1), flags.argmax(axis=1), flags.shape[1]))


def passes_too_early(zone: ConflictZone, ego: Array, first: Array, lag: int, pad: float) -> Steps:
    """Return when a vehicle that goes second first enters a zone that the one before it has not left for long enough.

    Args:
        ego: Its arc length over time (plans, n) [m].
        first: Arc length of the one that goes first, over time (at least n,) [m].
        pad: Additional room along the route [m].

    Returns:
        Step of the first violation (plans,); n where there is none.
    """
    n = ego.shape[1]
    gone = np.concatenate([np.full(lag, first[0]), first])[:n]
    return first_true(gone <= zone.over_i.highest(ego) + pad)


def meets(zone: ConflictZone, ego: Array, low: Array, high: Array, lag: int, pad: float) -> Steps:
    """Return when a vehicle first touches the stretch on which another one may be.

    Args:
        ego: Its arc length over time (plans, n) [m].
        low: Least arc length of the other over time (at least n,) [m].
        high: Greatest arc length of the other over time (at least n,) [m].
        pad: Additional room along the route [m].

    Returns:
        Step of the first violation (plans,); n where there is none.
    """
    n = ego.shape[1]
    least = np.concatenate([np.full(lag, low[0]), low])[:n]
    most = np.concatenate([high[lag:n], np.full(min(lag, n), high[n - 1])])
    begin, end = zone.over_i.blocked(ego)
    return first_true((begin - pad <= most) & (end + pad >= least))
