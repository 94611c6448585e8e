"""How fast a route can be driven at each place: slow enough for its curves, and for braking before them in time."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from math import ceil, inf

import numpy as np

from codriving.datatypes import DrivingModel, Lane, LaneId, Route, VehicleLimits, beside
from codriving.geometry.curve import FloatArray
from codriving.geometry.lane_path import lane_path
from codriving.geometry.path import Path

FREE = 100.0  # Speed where nothing limits it [m/s]

_ALONG = 4.0  # Length over which curvature is measured [m]; a kink where lanes are joined is driven as a bend

_AROUND = 1.5  # How far before and past a curve its curvature counts [m]; headings follow with a delay

_STRAIGHT = 1e-6  # Less curvature is none [1/m]

_ROUNDING = 1e-6  # Speeds that differ by less are taken to be the same [m/s]

# How far past its end the profile of a route is tabulated [m]; no prediction looks farther.
_BEYOND = 600.0


@dataclass(frozen=True, slots=True, eq=False)
class SpeedProfile:
    """The speed that the proportional speed law is told along a route, so that no place is driven too fast.

    Between two rows it is linear. Before the route the first value holds, past it the last.
    """

    spacing: float  # Arc length between two rows [m]
    gain: float  # Gain of the speed law [1/s]
    values: FloatArray  # Reference speed at each row (n,) [m/s]
    speeds: FloatArray  # Speed that a vehicle keeps which is told the reference (n,) [m/s]
    top: float  # Highest speed that CAVs drive [m/s]
    curvature: FloatArray  # Largest curvature near each row (n,) [1/m]
    slopes: FloatArray = field(init=False, repr=False)  # Reference = base[k] + slopes[k] * x with x = s / spacing
    base: FloatArray = field(init=False, repr=False)
    elapsed: FloatArray = field(init=False, repr=False)  # Time from the first row at least (n,) [s]
    _places: FloatArray = field(init=False, repr=False)  # Arc length of each row (n,) [m]
    _padded: FloatArray = field(init=False, repr=False)
    _slopes: list[float] = field(init=False, repr=False)
    _base: list[float] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        values, padded = (
            np.concatenate((rows, np.full(ceil(_BEYOND / self.spacing), rows[-1])))
            for rows in (self.values, self.speeds)
        )
        object.__setattr__(self, "_padded", padded)
        slopes = np.diff(values)
        base = values[:-1] - slopes * np.arange(len(slopes))
        paces = 1 / np.minimum(self.speeds, self.top)
        elapsed = np.concatenate(([0.0], np.cumsum((paces[1:] + paces[:-1]) / 2 * self.spacing)))
        object.__setattr__(self, "elapsed", elapsed)
        object.__setattr__(self, "_places", np.arange(len(elapsed)) * self.spacing)
        for name, value in (("slopes", slopes), ("base", base), ("_slopes", slopes.tolist()), ("_base", base.tolist())):
            object.__setattr__(self, name, value)

    def reference(self, s: float) -> float:
        """Return the reference speed at an arc length [m/s]."""
        x = max(s, 0.0) / self.spacing
        k = min(int(x), len(self._base) - 1)
        return self._base[k] + self._slopes[k] * x

    def allows(self, speed: float, s: float, distance: float) -> bool:
        """Whether a speed [m/s] is kept for some distance [m] from an arc length on [m]."""
        first = min(max(int(s / self.spacing), 0), len(self.values) - 1)
        return bool(self.values[first : first + int(distance / self.spacing) + 3].min() >= speed)

    def free(self, speed: float, s: float) -> float:
        """Return how far the reference speed surely is no less than a speed [m/s] from an arc length on [m]."""
        first = min(int(max(s, 0.0) / self.spacing), len(self.values) - 1)
        # Between two rows it is as low as the lower one, but for rounding.
        below = self.values[first:] < speed + _ROUNDING
        k = int(below.argmax())
        return max((first + k - 1) * self.spacing - s, 0.0) if below[k] else inf

    def kept(self, s: float, count: int) -> FloatArray:
        """Return the speed that is kept at an arc length and at so many rows' distances from it (count,) [m/s]."""
        x = max(s, 0.0) / self.spacing
        k = int(x)
        rows = self._padded[k : k + count + 1]
        return np.asarray(rows[:-1] + (x - k) * (rows[1:] - rows[:-1]))

    def bend(self, places: FloatArray) -> FloatArray:
        """Return the curvature at arc lengths [m], at least (n,) [1/m]; none before and past the route."""
        rows = (places / self.spacing).astype(np.intp)
        inside = (rows >= 0) & (rows < len(self.curvature))
        return np.where(inside, self.curvature.take(rows, mode="clip"), 0.0)

    def duration(self, s: float, length: float) -> float:
        """Return how long it takes at least to go on from an arc length [m] by a length, which may be negative [m]."""
        end = s + length
        rows = np.interp((s, end), self._places, self.elapsed)
        last = (len(self.elapsed) - 1) * self.spacing
        outside = end - min(max(end, 0.0), last) - (s - min(max(s, 0.0), last))
        return float(rows[1] - rows[0] + outside / self.top)

    def acceleration(self, s: float, speed: float) -> float:
        """Return the acceleration at an arc length [m] below which a vehicle keeps the profile [m/s2]."""
        return self.gain * (self.reference(s) - speed)


def speed_profile(path: Path, curvature: FloatArray, model: DrivingModel, limits: VehicleLimits) -> SpeedProfile:
    """Work out the profile of a route.

    The speed v(s) keeps v^2 kappa below the lateral comfort, and falls before a curve by the comfortable braking b. A
    proportional law with gain K lags behind what it is told; told v - b / K while v falls, it follows v.

    Args:
        curvature: Curvature at each point of the path (n,) [1/m].
    """
    square = np.full(len(curvature), FREE**2)
    bends = curvature > _STRAIGHT
    square[bends] = np.minimum(limits.comfort_lateral / curvature[bends], FREE**2)
    rise = 2 * limits.comfort_braking * path.spacing
    # The lowest of what comes, each raised by what can be braked off on the way there.
    ramp = rise * np.arange(len(square))
    square = np.minimum.accumulate((square + ramp)[::-1])[::-1] - ramp
    speeds = np.sqrt(square)
    braking = np.clip(np.diff(square, append=square[-1]) / (2 * path.spacing), -limits.comfort_braking, 0.0)
    told = speeds + braking / model.speed_gain
    # A vehicle is told anew once a step; what holds at the end of the step is kept from its beginning on.
    for _ in range(ceil(model.top_speed * model.step / path.spacing)):
        told[:-1] = np.minimum(told[:-1], told[1:])
    return SpeedProfile(path.spacing, model.speed_gain, np.maximum(told, 0.0), speeds, model.top_speed, curvature)


def curvature_of(path: Path) -> FloatArray:
    """Return the curvature at each point of a path (n,) [1/m], the largest nearby."""
    half = max(round(_ALONG / 2 / path.spacing), 1)
    padded = np.pad(path.headings, half, mode="edge")
    bend = np.abs(padded[2 * half :] - padded[: -2 * half]) / (2 * half * path.spacing)
    around = max(round(_AROUND / path.spacing), 1)
    windows = np.lib.stride_tricks.sliding_window_view(np.pad(bend, around, mode="edge"), 2 * around + 1)
    return np.asarray(windows.max(axis=1))


def route_curvature(
    route: Route, path: Path, lanes: Mapping[LaneId, Lane], starts: Mapping[tuple[str, LaneId], float]
) -> FloatArray:
    """Return the curvature along a route (n,) [1/m]; at a lane change that of the lane that is left."""
    found = curvature_of(path)
    s = path.arc_lengths
    for left, entered in pairwise(route.lanes):
        if beside(left, entered):
            middle = starts[route.id, entered]
            there = np.abs(s - middle) <= route.taper / 2 + _ALONG
            own = lane_path(lanes[left])
            found[there] = np.interp(s[there] - starts[route.id, left], own.arc_lengths, curvature_of(own))
    return found
