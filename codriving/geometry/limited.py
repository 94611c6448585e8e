"""The near future of vehicles that have limits: step by step, since the speed then depends on the place."""

from collections.abc import Sequence
from functools import lru_cache
from math import inf

import numpy as np

from codriving.datatypes import DrivingModel, VehicleLimits
from codriving.geometry.clearance import Array
from codriving.geometry.speed_profile import SpeedProfile
from codriving.geometry.target_steps import TargetSteps

Along = tuple[SpeedProfile, float]  # The speed profile of a route, and the arc length of a vehicle there [m]

SLOW = 0.05  # Vehicles that stand are taken to start within a row of a speed profile by this speed [m/s]


class _Tables:
    """Speed profiles of several states, put one after another so that all are looked up at once."""

    def __init__(self, along: Sequence[Along], shape: tuple[int, ...], scale: float) -> None:
        profiles = tuple(dict.fromkeys(profile for profile, _ in along))
        starts, self._base, self._slopes = _lines(profiles, scale)
        first = dict(zip(profiles, starts, strict=True))
        self._several = len(profiles) > 1
        # A hundred steps write to the same places, with arrays of one shape, which is twice as fast as with columns.
        shape = (len(along), *shape[1:])
        self._rows, self._now, self._first = np.empty(shape), np.empty(shape), np.empty(shape, dtype=np.intp)
        self._rows.T[...] = [1 / profile.spacing for profile, _ in along]
        self._now.T[...] = [max(s, 0.0) / profile.spacing for profile, s in along]
        self._first.T[...] = [first[profile] for profile, _ in along]
        self._x, self._k = np.empty(shape), np.empty(shape, dtype=np.intp)
        self._start, self._slope = np.empty(shape), np.empty(shape)

    def reference(self, travelled: Array) -> Array:
        """Return the reference speed after some distance [m], in m/s times the scale; good until the next call."""
        x, k, slope = self._x, self._k, self._slope
        np.multiply(travelled, self._rows, x)
        np.add(x, self._now, x)
        k[...] = x
        if self._several:
            np.add(k, self._first, k)
        self._base.take(k, None, self._start, "clip")
        self._slopes.take(k, None, slope, "clip")
        np.multiply(slope, x, slope)
        return np.add(slope, self._start, slope)


@lru_cache(maxsize=32)
def _lines(profiles: tuple[SpeedProfile, ...], scale: float) -> tuple[list[int], Array, Array]:
    """Return where each profile begins, and base and slopes of all, one after another, times a scale."""
    starts = np.cumsum([0, *(len(profile.base) for profile in profiles[:-1])]).tolist()
    base = np.concatenate([profile.base for profile in profiles]) * scale
    return starts, base, np.concatenate([profile.slopes for profile in profiles]) * scale


def limited(
    model: DrivingModel,
    limits: VehicleLimits,
    speeds: Sequence[float],
    targets: Sequence[float],
    changes: TargetSteps,
    stride: int,
    along: Sequence[Along],
    places: Array,
    reached: Array | None = None,
) -> None:
    """Simulate states under changes of the target speed, as the environment moves them.

    Args:
        speeds: Speed of each state (n,) [m/s].
        targets: Target speed of each state (n,) [m/s].
        stride: Simulation steps between two samples.
        along: The way of each of the first states; curves make no difference to the others.
        places: Where the distance at each sample is put (samples + 1, n, plans), or (samples + 1, n) if paired [m].
        reached: Where the speed at each sample is put, in the same shape [m/s].
    """
    shape, here, substeps = changes.shape, len(along), model.substeps
    # Speeds are counted in metres a step, which saves two operations out of ten. Numpy takes an array and a scalar that
    # is an array, too, as fast as two arrays of one shape, and much faster than an array and a number.
    step, gain = np.array(model.step), np.array(model.speed_gain * model.step)
    hardest, slowest = np.array(limits.acceleration * model.step**2), np.array(-limits.braking * model.step**2)
    v, goal, kept, s, pedal = np.empty(shape), np.empty(shape), np.empty(shape), np.zeros(shape), np.empty(shape)
    v.T[...], goal.T[...] = np.multiply(speeds, model.step), np.multiply(targets, model.step)
    tables = _Tables(along, shape, model.step) if along else None
    bends = _comes_to_bends(model, speeds, along)
    aim, travelled = np.empty(shape), s[:here]
    told = aim[:here]
    places[0] = s
    if reached is not None:
        reached[0] = v
    for n in range((len(places) - 1) * stride):
        if n % substeps == 0:
            goal, kept = kept, goal
            # Halfway between two target speeds rounding decides, so speeds that are given are taken as they are.
            if n:
                np.divide(v, step, goal)
            else:
                goal.T[...] = speeds
            changes.apply(n // substeps, goal, goal, kept, v, step)
            wanted = goal[:here]
            if tables is None:
                aim = goal
            else:
                aim[...] = goal
        if tables is not None and n >= bends:
            np.minimum(wanted, tables.reference(travelled), out=told)
        np.subtract(aim, v, pedal)
        np.multiply(pedal, gain, pedal)
        np.minimum(pedal, hardest, out=pedal)
        np.maximum(pedal, slowest, out=pedal)
        np.add(s, v, s)
        np.add(v, pedal, v)
        if (n + 1) % stride == 0:
            places[(n + 1) // stride] = s
            if reached is not None:
                reached[(n + 1) // stride] = v
    if reached is not None:
        reached /= step


def _comes_to_bends(model: DrivingModel, speeds: Sequence[float], along: Sequence[Along]) -> float:
    """Return the simulation step before which no state comes to where its profile is slower than it can be."""
    fastest = [max(speed, model.top_speed) for speed, _ in zip(speeds, along, strict=False)]
    room = (profile.free(fast, s) / (fast * model.step) for fast, (profile, s) in zip(fastest, along, strict=True))
    return min(room, default=inf) - 1


def driven(along: Along, speed: float, most: float, pedal: float, times: Array) -> Array:
    """Distance of a human driver who accelerates up to a speed, and slows down for curves.

    No driver who keeps the profile of the route, the acceleration and the speed gets farther.

    Args:
        most: Speed that the driver wants at most [m/s].
        pedal: Acceleration [m/s2].
    """
    profile, place = along
    wanted = max(speed, most)
    distance = wanted * float(times[-1])
    if profile.allows(wanted, place, distance):
        return accelerated(speed, times, most, pedal)
    count = int(distance / profile.spacing) + 3
    ahead = profile.spacing * np.arange(count)
    allowed = profile.kept(place, count)
    # Who is too fast for the place is so for a while.
    allowed += max(speed - float(allowed[0]), 0.0)
    square = np.minimum(allowed, wanted) ** 2
    square[0] = speed**2
    ramp = 2 * pedal * ahead
    paces = np.sqrt(np.minimum.accumulate(square - ramp) + ramp)
    if most < speed:
        paces = np.minimum(paces, speed)
    elapsed = np.concatenate(([0.0], np.cumsum(2 * profile.spacing / np.maximum(paces[1:] + paces[:-1], SLOW))))
    return np.asarray(np.interp(times, elapsed, ahead))


def accelerated(speed: float, times: Array, limit: float, pedal: float) -> Array:
    """Distance of a driver who accelerates up to a limit on a straight road."""
    rising = np.minimum(times, max(limit - speed, 0.0) / pedal)
    return np.asarray(speed * times + pedal * rising**2 / 2 + pedal * rising * (times - rising))
