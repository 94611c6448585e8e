"""Do two predicted motions keep out of each other's way in a conflict zone?"""

from bisect import bisect_left
from collections.abc import Sequence
from math import inf

import numpy as np
from numpy.typing import NDArray

from codriving.geometry.zone import ConflictZone

CALM = 3.0  # Braking with which a plan may come to a stop past the horizon [m/s2]

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
Steps = NDArray[np.int64]

MANY = 32  # Motions of which it pays to leave out the steps before they come to a zone

REACTION = 1.0  # Time after which a driver brakes for a vehicle that is in the way [s]

BRAKING = 4.0  # Braking that can be expected of a driver for a vehicle that is in the way [m/s2]


def stays_behind(
    zone: ConflictZone, ego: Array, other: Array, lag: int, pad: float, farthest: Array | None = None
) -> Flags:
    """Whether the ego vehicle enters a zone only after the other one has left the way.

    Args:
        ego: Arc length of the ego vehicle over time (plans, n) [m].
        other: Arc length of the other vehicle over time (n,), the least that it may reach [m].
        pad: Additional room along the route [m].
        farthest: How far any of many motions has come (n,) [m]; worked out if it is not given.

    Returns:
        One flag a plan (plans,).
    """
    # Where the other one was before now is not known; it must have left by now if the ego vehicle enters that soon.
    earlier = np.empty(ego.shape[1])
    earlier[:lag], earlier[lag:] = other[0], other[: ego.shape[1] - lag]
    if len(ego) > MANY:
        # Before any motion comes to the zone there is nothing to look up, and nothing after that if the other one is
        # past it by then; of few motions the look is not worth it.
        farthest = ego.max(axis=0) if farthest is None else farthest
        first = _reached(zone, farthest)
        ego, earlier = ego[:, first:], earlier[first:]
        if (zone.over_i.most(farthest[first:]) + pad < earlier).all():
            return np.ones(len(ego), dtype=np.bool_)
    ends = zone.over_i.highest(ego)
    if pad:
        ends += pad
    return np.asarray((ends < earlier).all(axis=1))


def _reached(zone: ConflictZone, farthest: Array) -> int:
    """Return the first step at which any of several motions may be in a zone."""
    near = farthest >= zone.over_i.begin
    return int(near.argmax()) if near.any() else len(farthest)


def stays_ahead(zone: ConflictZone, ego: Array, other: Array, lag: int, pad: float) -> Flags:
    """Whether the ego vehicle has left a zone before the other one can enter it."""
    earlier = np.empty(ego.shape)
    earlier[:, :lag], earlier[:, lag:] = ego[:, :1], ego[:, : ego.shape[1] - lag]
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
    """Let a driver brake, after a reaction time, once the ego vehicle is in a zone ahead of it.

    Args:
        ego: Several motions of the ego vehicle (plans, n) [m].

    Returns:
        Motions of the driver, one a plan (plans, n), or one alone where they are all the same (n,) [m].
    """
    reaction = round(REACTION / sample)
    sees = [int(motion.searchsorted(zone.entry_i)) + reaction for motion in ego]
    each = {since: _brakes(other, since, sample) for since in dict.fromkeys(sees)}
    return np.array([each[since] for since in sees]) if len(each) > 1 else each[sees[0]]


def _brakes(other: Array, sees: int, sample: float) -> Array:
    """Let a driver brake from a step on."""
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


def covered_after(
    distances: Sequence[float], travel: Sequence[float], times: Sequence[float], sample: float
) -> tuple[float, ...]:
    """Return when a motion has covered distances [m], in plain numbers.

    Args:
        travel: Distance travelled [m] at each time.
        times: The times [s], `sample` apart.

    Returns:
        Times from now, going on at the last speed past the horizon; inf if the vehicle stands then [s].
    """
    found = []
    for distance in distances:
        index = bisect_left(travel, distance)
        if distance <= 0:
            found.append(0.0)
        elif index < len(travel):
            pace = (travel[index] - travel[index - 1]) / sample
            found.append(times[index] - (travel[index] - distance) / pace if pace else -inf)
        else:
            pace = (travel[-1] - travel[-2]) / sample
            found.append(times[-1] + (distance - travel[-1]) / pace if pace > 0.05 else inf)
    return tuple(found)
