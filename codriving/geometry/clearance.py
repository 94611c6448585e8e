"""Do two predicted motions keep out of each other's way in a conflict zone?"""

import numpy as np
from numpy.typing import NDArray

from codriving.geometry.zone import ConflictZone

CALM = 3.0  # Braking with which a plan may come to a stop past the horizon [m/s2]

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
Steps = NDArray[np.int64]

REACTION = 1.0  # Time after which a driver brakes for a vehicle that is in the way [s]

BRAKING = 4.0  # Braking that can be expected of a driver for a vehicle that is in the way [m/s2]


def stays_behind(zone: ConflictZone, ego: Array, other: Array, lag: int, pad: float) -> Flags:
    """Whether the ego vehicle enters a zone only after the other one has left the way.

    Args:
        ego: Arc length of the ego vehicle over time (plans, n) [m].
        other: Arc length of the other vehicle over time (n,), the least that it may reach [m].
        pad: Additional room along the route [m].

    Returns:
        One flag a plan (plans,).
    """
    # Where the other one was before now is not known; it must have left by now if the ego vehicle enters that soon.
    earlier = np.concatenate([np.full(lag, other[0]), other[: ego.shape[1] - lag]])
    return np.asarray((earlier > zone.over_i.highest(ego) + pad).all(axis=1))


def stays_ahead(zone: ConflictZone, ego: Array, other: Array, lag: int, pad: float) -> Flags:
    """Whether the ego vehicle has left a zone before the other one can enter it."""
    earlier = np.concatenate([np.repeat(ego[:, :1], lag, axis=1), ego[:, : ego.shape[1] - lag]], axis=1)
    return np.asarray((earlier > zone.front(other) + pad).all(axis=1))


def halts_behind(zone: ConflictZone, ego: Array, other: Array, sample: float) -> Flags:
    """Whether the ego vehicle, which ends up behind the other one, could still stop there if that one stops, too.

    Otherwise a vehicle that stands far behind one that stands might plan for ever to start just before the horizon.
    """
    return np.asarray(_halt(other, sample) > zone.over_i.highest(_halt(ego, sample)))


def _halt(places: Array, sample: float) -> Array:
    """Return where vehicles come to a stop after a motion [m]."""
    pace = (places[..., -1] - places[..., -2]) / sample
    return np.asarray(places[..., -1] + pace**2 / (2 * CALM))


def reacts(zone: ConflictZone, ego: Array, other: Array, sample: float) -> Array:
    """Let a driver brake, after a reaction time, once the ego vehicle is in a zone ahead of it."""
    sees = int(np.searchsorted(ego, zone.entry_i)) + round(REACTION / sample)
    if sees >= len(other) - 1:
        return other
    pace = (other[sees + 1] - other[sees]) / sample
    later = np.minimum(np.arange(len(other) - sees) * sample, pace / BRAKING)
    return np.concatenate([other[:sees], other[sees] + pace * later - BRAKING * later**2 / 2])


def first_true(flags: Flags) -> Steps:
    """Return the first step at which a flag of each row is set; the number of steps where none is."""
    return np.asarray(np.where(flags.any(axis=1), flags.argmax(axis=1), flags.shape[1]))


def first_overlap(zone: ConflictZone, ego: Array, other: Array) -> Steps:
    """Step at which two motions first overlap in a zone."""
    begin, end = zone.blocked(other)
    return first_true((ego >= begin) & (ego <= end))
