"""Do two predicted motions keep out of each other's way in a conflict zone?"""

import numpy as np
from numpy.typing import NDArray

from codriving.geometry.zone import ConflictZone

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

GENTLE = 3.0
"""Braking that a driver can be expected to do behind somebody who has merged ahead [m/s2]."""


def stays_behind(zone: ConflictZone, ego: Array, other: Array, lag: int, pad: float) -> Flags:
    """Whether the ego vehicle enters a zone only after the other one has left the way.

    Args:
        zone: The zone, seen from the ego vehicle.
        ego: Arc length of the ego vehicle over time (plans, n) [m].
        other: Arc length of the other vehicle over time (n,), the least that it may reach [m].
        lag: Steps that must lie between the other's leaving and the ego vehicle's entering.
        pad: Additional room along the route [m].

    Returns:
        One flag a plan (plans,).
    """
    blocked_until = zone.over_i.highest(ego[:, lag:]) + pad
    return np.asarray((other[: ego.shape[1] - lag] > blocked_until).all(axis=1))


def stays_ahead(zone: ConflictZone, ego: Array, other: Array, lag: int, pad: float) -> Flags:
    """Whether the ego vehicle has left a zone before the other one can enter it.

    Args:
        zone: The zone, seen from the ego vehicle.
        ego: Arc length of the ego vehicle over time (plans, n) [m].
        other: Arc length of the other vehicle over time (n,), the most that it may reach [m].
        lag: Steps that must lie between the ego vehicle's leaving and the other's entering.
        pad: Additional room along the route [m].

    Returns:
        One flag a plan (plans,).
    """
    needed = zone.front(other[lag:]) + pad
    return np.asarray((ego[:, : ego.shape[1] - lag] > needed).all(axis=1))


def follows_after_merge(zone: ConflictZone, ego: Array, other: Array, speed: float, sample: float) -> Array:
    """Let the other vehicle brake gently once the ego vehicle has merged ahead of it.

    Args:
        zone: The zone, seen from the ego vehicle.
        ego: Arc length of the ego vehicle over time (n,) [m].
        other: Arc length of the other vehicle over time, the most that it may reach (n,) [m].
        speed: Speed of the other vehicle now [m/s].
        sample: Time between two samples [s].

    Returns:
        Arc length of the other vehicle over time (n,) [m].
    """
    if zone.merge_i is None:
        return other
    merged = int(np.searchsorted(ego, zone.merge_i))
    if merged >= len(ego) - 1:
        return other
    pace = (other[merged + 1] - other[merged]) / sample if merged + 1 < len(other) else speed
    later = np.minimum(np.arange(len(other) - merged) * sample, pace / GENTLE)
    return np.concatenate([other[:merged], other[merged] + pace * later - GENTLE * later**2 / 2])


def first_overlap(zone: ConflictZone, ego: Array, other: Array) -> NDArray[np.int64]:
    """Step at which two motions first overlap in a zone.

    Args:
        zone: The zone, seen from the ego vehicle.
        ego: Arc length of the ego vehicle over time (plans, n) [m].
        other: Arc length of the other vehicle over time (n,) [m].

    Returns:
        One step a plan (plans,); n where they never overlap.
    """
    hit = (ego >= zone.back(other)) & (ego <= zone.front(other))
    return np.where(hit.any(axis=1), hit.argmax(axis=1), ego.shape[1])
