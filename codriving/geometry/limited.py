"""The near future of vehicles that have limits: step by step, since the speed then depends on the place."""

from collections.abc import Sequence

import numpy as np

from codriving.datatypes import DrivingModel, VehicleLimits
from codriving.geometry.clearance import Array
from codriving.geometry.speed_profile import SpeedProfile

Along = tuple[SpeedProfile, float]  # The speed profile of a route, and the arc length of a vehicle there [m]

SLOW = 0.05  # Vehicles that stand are taken to start within a row of a speed profile by this speed [m/s]


class _Tables:
    """Speed profiles of several states, put one after another so that all are looked up at once."""

    def __init__(self, along: Sequence[Along], shape: tuple[int, ...], scale: float) -> None:
        profiles = list({id(profile): profile for profile, _ in along}.values())
        starts = np.cumsum([0, *(len(profile.base) for profile in profiles)])
        first = {id(profile): start for profile, start in zip(profiles, starts.tolist(), strict=False)}
        # As one number of two parts, base and slope are looked up in one go.
        lines = np.empty(starts[-1], dtype=np.complex128)
        lines.real = np.concatenate([profile.base for profile in profiles]) * scale
        lines.imag = np.concatenate([profile.slopes for profile in profiles]) * scale
        self.lines = lines
        # A hundred steps write to the same places, with arrays of one shape, which is twice as fast as with columns.
        shape = (len(along), *shape[1:])
        self.rows, self.now, self.first = np.empty(shape), np.empty(shape), np.empty(shape, dtype=np.intp)
        self.rows.T[...] = [1 / profile.spacing for profile, _ in along]
        self.now.T[...] = [max(s, 0.0) / profile.spacing for profile, s in along]
        self.first.T[...] = [first[id(profile)] for profile, _ in along]
        self._x, self._k, self._found = np.empty(shape), np.empty(shape, dtype=np.intp), np.empty(shape, np.complex128)
        self._base, self._slope = self._found.real, self._found.imag

    def reference(self, travelled: Array) -> Array:
        """Return the reference speed after some distance [m], in m/s times the scale; good until the next call."""
        x, k = self._x, self._k
        np.multiply(travelled, self.rows, x)
        np.add(x, self.now, x)
        k[...] = x
        np.add(k, self.first, k)
        self.lines.take(k, None, self._found, "clip")
        np.multiply(self._slope, x, x)
        return np.add(x, self._base, x)


def limited(
    model: DrivingModel,
    limits: VehicleLimits,
    speeds: Sequence[float],
    targets: Sequence[float],
    changes: Array,
    steps: int,
    stride: int,
    along: Sequence[Along],
    paired: bool = False,
    bounds: bool = False,
) -> tuple[Array, Array]:
    """Simulate states under changes of the target speed, as the environment moves them.

    Args:
        speeds: Speed of each state (n,) [m/s].
        targets: Target speed of each state (n,) [m/s].
        changes: Steps of the target speed at each decision (decisions, plans); each for one state if paired. Not a
            number where the speed that is driven becomes the target.
        steps: Number of simulation steps.
        stride: Simulation steps between two samples.
        along: The way of each of the first states; curves make no difference to the others.
        bounds: Whether two plans follow that no other can fall behind and outrun: the lowest and the highest of the
            target that is kept and the one to which SLOWER and FASTER step.

    Returns:
        Distance [m] and speed [m/s], each (n, plans, samples + 1), or (n, samples + 1) if paired.
    """
    low, top = model.target_speeds[0], len(model.target_speeds) - 1
    span = model.target_speeds[-1] - low
    if bounds:
        extremes = np.tile([-1.0, 1.0], (len(changes), 1))
        changes = np.concatenate((changes, extremes), axis=1)
    holds = np.isnan(changes)
    holding = [bool(row.any()) for row in holds]
    shape = (len(speeds),) if paired else (len(speeds), changes.shape[1])
    # Speeds are counted in metres a step, which saves two operations out of ten.
    step = model.step
    v, goal, s, pedal = np.empty(shape), np.empty(shape), np.zeros(shape), np.empty(shape)
    v.T[...], goal.T[...] = np.multiply(speeds, step), np.multiply(targets, step)
    # Numpy takes two arrays of one shape in half the time of an array and a number.
    hardest, slowest = np.full(shape, limits.acceleration * step**2), np.full(shape, -limits.braking * step**2)
    gains = np.full(shape, model.speed_gain * model.step)
    tables = _Tables(along, shape, step) if along else None
    here = s[: len(along)]
    samples, substeps = steps // stride, model.substeps
    distances, reached = np.zeros((samples + 1, *shape)), np.empty((samples + 1, *shape))
    reached[0] = v
    for n in range(samples * stride):
        if n % substeps == 0:
            change = changes[n // substeps]
            # Halfway between two target speeds rounding decides, so speeds that are given are taken as they are.
            speed = v / step if n else np.broadcast_to(np.reshape(speeds, (-1, *(1,) * (len(shape) - 1))), shape)
            index = np.minimum(np.maximum(np.rint((speed - low) / span * top), 0), top) + change
            stepped = (low + span / top * np.minimum(np.maximum(index, 0), top)) * step
            kept = goal
            goal = np.where(change == 0, kept, stepped)
            if holding[n // substeps]:
                np.copyto(goal, v, where=holds[n // substeps])
            if bounds:
                goal[:, -2] = np.minimum(kept[:, -2], stepped[:, -2])
                goal[:, -1] = np.maximum(kept[:, -1], stepped[:, -1])
            aim, wanted = goal.copy(), goal[: len(along)]
            told = aim[: len(along)]
        if tables is not None:
            np.minimum(wanted, tables.reference(here), out=told)
        np.subtract(aim, v, pedal)
        np.multiply(pedal, gains, pedal)
        np.minimum(pedal, hardest, out=pedal)
        np.maximum(pedal, slowest, out=pedal)
        np.add(s, v, s)
        np.add(v, pedal, v)
        if (n + 1) % stride == 0:
            distances[(n + 1) // stride], reached[(n + 1) // stride] = s, v
    reached /= step
    return np.ascontiguousarray(np.moveaxis(distances, 0, -1)), np.ascontiguousarray(np.moveaxis(reached, 0, -1))


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
