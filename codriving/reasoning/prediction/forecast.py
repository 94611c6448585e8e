"""Bounds and expectations of how far each vehicle comes: the shared predictor of all reasoning."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from codriving.datatypes import Action, DrivingModel
from codriving.reasoning.prediction.clearance import Array
from codriving.reasoning.prediction.rollout import Plan, canonical, travelled

HORIZON = 10.0  # How far ahead each vehicle is predicted [s]; a stop from top speed and a crossing both fit in

SAMPLE = 0.2  # Time between two samples of a prediction, rounded to whole simulation steps [s]

SPEEDING = 1.0  # How much faster than the CAVs' top speed a human driver may become [m/s]

HARD_BRAKING = 6.0  # Hardest braking expected of a human driver [m/s2]

HARD_ACCELERATION = 1.5  # Hardest acceleration expected of a human driver [m/s2]


# How far a driver may be from where constant speed leads: at once [m], more each second [m/s], and at most [m].
DRIFT = (1.0, 0.75, 6.0)

FEW = 8  # Plans that are looked up one by one in no time

BRAKE: Plan = (Action.SLOWER,)
GO: Plan = (Action.FASTER,)


@dataclass(frozen=True, slots=True)
class Reach:
    """How far a vehicle may come from now on."""

    least: Array  # Distance if it brakes as hard as it can (steps + 1,) [m]
    steady: Array  # Distance if it keeps its speed (steps + 1,) [m]
    most: Array  # Distance if it accelerates as hard as it can (steps + 1,) [m]


class Forecast:
    """Predictions, each worked out once a decision step.

    Attributes:
        sample: Time between two samples of a prediction [s].
        times: Time of each sample from now (steps + 1,) [s].
    """

    def __init__(self, model: DrivingModel, library: tuple[Plan, ...] = ()) -> None:
        self.model = model
        self._stride = max(1, round(SAMPLE / model.step))
        self.sample = self._stride * model.step
        self.steps = round(HORIZON / self.sample)
        self.times: Array = np.arange(self.steps + 1, dtype=np.float64) * self.sample
        asked = tuple(dict.fromkeys((*library, BRAKE, GO)))
        # Plans that mean the same, written differently, are worked out once.
        self._library = tuple(dict.fromkeys(canonical(plan) for plan in asked))
        rows = {plan: k for k, plan in enumerate(self._library)}
        self._index = {plan: rows[canonical(plan)] for plan in asked}
        self._asked: tuple[Plan, ...] = ()
        self._rows: NDArray[np.intp] = np.empty(0, dtype=np.intp)
        self._travel: dict[tuple[float, float], Array] = {}
        self._reach: dict[tuple[bool, float], Reach] = {}
        self._likely: dict[float, tuple[Array, Array]] = {}

    def begin_step(self, states: Sequence[tuple[float, float]] = ()) -> None:
        """Forget the predictions of the step before, and predict the CAVs of this one.

        Args:
            states: Speed and target speed of each CAV [m/s].
        """
        self._travel.clear()
        self._reach.clear()
        self._likely.clear()
        self._predict(states)

    def _predict(self, states: Sequence[tuple[float, float]]) -> None:
        new = list(dict.fromkeys(state for state in states if state not in self._travel))
        if new:
            speeds, targets = zip(*new, strict=True)
            distances = travelled(self.model, speeds, targets, self._library, self.steps, self._stride)
            self._travel.update(zip(new, distances, strict=True))

    def travel_each(self, states: Sequence[tuple[float, float]], plans: Sequence[Plan]) -> Array:
        """Distances of several CAVs, each for a plan of its own, which need not be in the library.

        Args:
            states: Speed and target speed of each CAV [m/s].

        Returns:
            Distance travelled (n, steps + 1) [m].
        """
        speeds, targets = [speed for speed, _ in states], [target for _, target in states]
        return travelled(self.model, speeds, targets, tuple(plans), self.steps, self._stride, paired=True)

    def travel(self, speed: float, target: float, plans: Sequence[Plan]) -> Array:
        """Distances of a CAV for several plans of the library.

        Args:
            speed: Speed now [m/s].
            target: Target speed now [m/s].

        Returns:
            Distance travelled (len(plans), steps + 1) [m].
        """
        return self._travels(speed, target)[self._rows_of(plans)]

    def _travels(self, speed: float, target: float) -> Array:
        """Distances for every plan of the library."""
        if (speed, target) not in self._travel:
            self._predict([(speed, target)])
        return self._travel[speed, target]

    def _rows_of(self, plans: Sequence[Plan]) -> NDArray[np.intp]:
        """Rows of several plans in the library."""
        if plans is not self._asked:
            rows = np.array([self._index[plan] for plan in plans], dtype=np.intp)
            if not isinstance(plans, tuple) or len(plans) <= FEW:
                return rows
            # A long tuple is a library that is asked for again and again; looking at every plan of it takes long.
            self._asked, self._rows = plans, rows
        return self._rows

    def reach(self, speed: float, is_cav: bool) -> Reach:
        """Bounds of how far a vehicle comes.

        Args:
            speed: Speed now [m/s].
        """
        key = (is_cav, speed)
        if key not in self._reach:
            if is_cav:
                # Neither depends on the present target, so that of any state with this speed will do.
                travels = self._travels(speed, next((goal for v, goal in self._travel if v == speed), speed))
                least, most = travels[self._index[BRAKE]], travels[self._index[GO]]
            else:
                least = slowest(speed, self.times)
                most = fastest(speed, self.times, self.model.target_speeds[-1] + SPEEDING)
            self._reach[key] = Reach(least, speed * self.times, most)
        return self._reach[key]

    def likely(self, speed: float) -> tuple[Array, Array]:
        """Distances between which a human driver is expected, apart from what it could do at the worst.

        Args:
            speed: Speed now [m/s].

        Returns:
            The least and the most, each (steps + 1,) [m].
        """
        if speed not in self._likely:
            self._likely[speed] = likely_distances(speed, self.times)
        return self._likely[speed]

    def time_to(self, distance: float, travel: Array) -> float:
        """Return when a distance has been covered.

        Args:
            distance: Distance [m].
            travel: Distance travelled (steps + 1,) [m].

        Returns:
            Time from now, going on at the last speed past the horizon; inf if the vehicle stands then [s].
        """
        if distance <= 0:
            return 0.0
        index = int(np.searchsorted(travel, distance))
        if index <= self.steps:
            pace = (travel[index] - travel[index - 1]) / self.sample
            return float(self.times[index] - (travel[index] - distance) / pace)
        pace = (travel[-1] - travel[-2]) / self.sample
        return float(self.times[-1] + (distance - travel[-1]) / pace) if pace > 0.05 else float("inf")


def likely_distances(speed: float, times: Array) -> tuple[Array, Array]:
    """Distances between which a driver is expected, who goes on at about the present speed."""
    at_once, each_second, at_most = DRIFT
    drift = np.minimum(at_once + each_second * times, at_most)
    return np.maximum(speed * times - drift, 0.0), speed * times + drift


def slowest(speed: float, times: Array) -> Array:
    """Distance of a driver who brakes hard at once."""
    braking = np.minimum(times, speed / HARD_BRAKING)
    return np.asarray(speed * braking - HARD_BRAKING * braking**2 / 2)


def fastest(speed: float, times: Array, limit: float) -> Array:
    """Distance of a driver who accelerates hard up to the speed limit."""
    rising = np.minimum(times, max(limit - speed, 0.0) / HARD_ACCELERATION)
    return np.asarray(speed * times + HARD_ACCELERATION * rising**2 / 2 + HARD_ACCELERATION * rising * (times - rising))
