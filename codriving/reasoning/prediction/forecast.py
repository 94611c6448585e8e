"""Bounds and expectations of how far each vehicle comes: the shared predictor of all reasoning."""

from collections.abc import Callable, Sequence
from functools import cached_property, partial

import numpy as np
from numpy.typing import NDArray

from codriving.datatypes import Action, DrivingModel, TrackedVehicle
from codriving.geometry import Along, Array, RoadMap, accelerated, covered_after, driven
from codriving.reasoning.prediction.rollout import Library, Plan, canonical, travelled

HORIZON = 10.0  # How far ahead each vehicle is predicted [s]; a stop from top speed and a crossing both fit in

SAMPLE = 0.2  # Time between two samples of a prediction, rounded to whole simulation steps [s]

SPEEDING = 1.0  # How much faster than the CAVs' top speed a human driver may become [m/s]

# How far a driver may be from where constant speed leads: at once [m], more each second [m/s], and at most [m].
DRIFT = (1.0, 0.75, 6.0)

USUAL = 1.5  # Acceleration of a driver after a curve [m/s2]

# Time after which a vehicle without limits that changes lanes is off the lane that it leaves [s]; at 5 to 30 m/s.
CLEARS = 1.6

LANE = 4.0  # Width of a lane of a road that is not given [m]

# How far inside of the centre line a vehicle drives in a curve at most, by which it gets along faster [m]; 0.70 m
# were seen, in turns with a radius of 9 m.
CUTS = 0.75

# By how much the arc length of a vehicle may otherwise fall behind what it has driven: a share of that, what the first
# second brings [m/s], and at most [m]; the second number alone also for how far it may get ahead.
STRAYS = (0.15, 0.3, 0.8)

# Where lanes lie beside one another a vehicle may be steered across: of what it drives, at a speed v, it may lose
# 8 / v^2 along the road, at the most a half, and over the width of a lane no more than that width [m].
ACROSS = (8.0, 0.5, 4.0)

NOWHERE = ("", 0.0)

FEW = 8  # Plans that are looked up one by one in no time

BRAKE: Plan = (Action.SLOWER,)
GO: Plan = (Action.FASTER,)


class Reach:
    """How far a vehicle may come from now on; each distance is worked out when it is first needed."""

    def __init__(self, least: Callable[[], Array], steady: Callable[[], Array], most: Callable[[], Array]) -> None:
        self._least, self._steady, self._most = least, steady, most

    @cached_property
    def least(self) -> Array:
        """Distance if it brakes as hard as it can (steps + 1,) [m]."""
        return self._least()

    @cached_property
    def steady(self) -> Array:
        """Distance if it keeps its speed (steps + 1,) [m]."""
        return self._steady()

    @cached_property
    def most(self) -> Array:
        """Distance if it accelerates as hard as it can (steps + 1,) [m]."""
        return self._most()


def _known(distance: Array) -> Array:
    return distance


# Route and arc length of a vehicle [m]; where vehicles have no limits they make no difference.
Where = tuple[str, float]

# Speed and target speed of a CAV [m/s], and where it is.
State = tuple[float, float, str, float]


class Forecast:
    """Predictions, each worked out once a decision step; on a straight road unless a road is given.

    Attributes:
        sample: Time between two samples of a prediction [s].
        times: Time of each sample from now (steps + 1,) [s].
        clears: Samples until a vehicle that changes lanes is off the lane that it leaves.
        values: What each plan of the library is worth to a CAV in this step, as far as it was asked [m].
    """

    def __init__(self, model: DrivingModel, library: tuple[Plan, ...] = (), road_map: RoadMap | None = None) -> None:
        self.model, self._road_map = model, road_map
        self._stride = max(1, round(SAMPLE / model.step))
        self.sample = self._stride * model.step
        self.steps = round(HORIZON / self.sample)
        self.times: Array = np.arange(self.steps + 1, dtype=np.float64) * self.sample
        self._clock: list[float] = self.times.tolist()
        self._first: Array = np.minimum(self.times, 1.0)  # Time of each sample within the first second [s]
        self._profiles = {} if road_map is None else road_map.speed_profiles(model)
        self._legal = {} if road_map is None else {route: road_map.speed_limit(route) for route in road_map.routes}
        self._limited = bool(self._profiles)
        lanes = () if road_map is None else tuple(road_map.lanes)
        self._may_change = len({lane[:2] for lane in lanes}) < len(lanes)
        widest = LANE if road_map is None else road_map.widest
        clears = CLEARS if model.limits is None else model.limits.clears_after(widest)
        self.clears = round(clears / self.sample) + 1
        known = (plan for plan in library if model.steady or Action.HOLD not in plan)
        asked = tuple(dict.fromkeys((*known, BRAKE, GO)))
        # Plans that mean the same, written differently, are worked out once.
        self._library = Library(dict.fromkeys(canonical(plan) for plan in asked))
        rows = {plan: k for k, plan in enumerate(self._library)}
        self._index = {plan: rows[canonical(plan)] for plan in asked}
        self._asked: tuple[Plan, ...] = ()
        self._rows: NDArray[np.intp] | slice = slice(0)
        self._along: dict[tuple[float, Where], tuple[Along, ...]] = {}
        self._travel: dict[State, Array] = {}
        self.values: dict[State, Array] = {}
        self._reach: dict[tuple[bool, float, Where], Reach] = {}
        self._likely: dict[tuple[float, Where], tuple[Array, Array]] = {}

    def begin_step(self, states: Sequence[State] = ()) -> None:
        """Forget the predictions of the step before, and predict the CAVs of this one."""
        self._along.clear()
        self._travel.clear()
        self.values.clear()
        self._reach.clear()
        self._likely.clear()
        self._predict([self.state(speed, target, (route, place)) for speed, target, route, place in states])

    def state(self, speed: float, target: float, where: Where) -> State:
        """Leave out where a CAV is if that makes no difference to it."""
        route, place = where if self._limited and self.along(speed, where) else NOWHERE
        return speed, target, route, place

    def along(self, speed: float, where: Where) -> tuple[Along, ...]:
        """Return the way of a CAV for `rollout`; nothing where it makes no difference within the horizon."""
        if not self._limited or where == NOWHERE:
            return ()
        if (speed, where) not in self._along:
            profile, ahead = self._profiles[where[0]], max(speed, self.model.top_speed)
            free = profile.allows(self.model.top_speed, where[1], ahead * HORIZON)
            self._along[speed, where] = () if free else ((profile, where[1]),)
        return self._along[speed, where]

    def _predict(self, states: Sequence[State]) -> None:
        new = list(dict.fromkeys(state for state in states if state not in self._travel))
        if new:
            if self._limited:
                new.sort(key=lambda state: state[2:] == NOWHERE)
            along = [(self._profiles[route], place) for *_, route, place in new if (route, place) != NOWHERE]
            speeds, targets, *_ = zip(*new, strict=True)
            distances = travelled(self.model, speeds, targets, self._library, self.steps, self._stride, along=along)
            distances.setflags(write=False)
            self._travel.update(zip(new, distances, strict=True))

    def travel_each(self, states: Sequence[State], plans: Sequence[Plan]) -> Array:
        """Distances of several CAVs, each for a plan of its own, which need not be in the library.

        Returns:
            Distance travelled (n, steps + 1) [m].
        """
        speeds, targets = [state[0] for state in states], [state[1] for state in states]
        along = [(self._profiles[route], place) for *_, route, place in states] if self._limited else []
        return travelled(self.model, speeds, targets, tuple(plans), self.steps, self._stride, True, along)

    def travel(self, speed: float, target: float, plans: Sequence[Plan], where: Where = NOWHERE) -> Array:
        """Distances of a CAV for several plans of the library.

        Args:
            speed: Speed now [m/s].
            target: Target speed now [m/s].

        Returns:
            Distance travelled (len(plans), steps + 1) [m]; not to be written to, since others may be given the same.
        """
        return self._travels(speed, target, where)[self._rows_of(plans)]

    def _travels(self, speed: float, target: float, where: Where) -> Array:
        """Distances for every plan of the library."""
        state = self.state(speed, target, where)
        if state not in self._travel:
            self._predict([state])
        return self._travel[state]

    def _rows_of(self, plans: Sequence[Plan]) -> NDArray[np.intp] | slice:
        """Rows of several plans in the library."""
        if plans is not self._asked:
            rows = np.array([self._index[plan] for plan in plans], dtype=np.intp)
            if not isinstance(plans, tuple) or len(plans) <= FEW:
                return rows
            # A long tuple is a library that is asked for again and again; looking at every plan of it takes long. Rows
            # that follow one another need not be copied.
            first, last = int(rows[0]), int(rows[0]) + len(rows)
            follow = bool((rows == np.arange(first, last)).all())
            self._asked, self._rows = plans, slice(first, last) if follow else rows
        return self._rows

    def reach(self, speed: float, is_cav: bool, where: Where = NOWHERE) -> Reach:
        """Bounds of how far a vehicle comes.

        Args:
            speed: Speed now [m/s].
        """
        key = (is_cav, speed, where if self._limited else NOWHERE)
        if key not in self._reach:
            self._reach[key] = self._bounds(speed, is_cav, where)
        return self._reach[key]

    def reach_of(self, vehicle: TrackedVehicle, where: Where) -> Reach:
        """Bounds of how far another vehicle comes, wider by what is not known exactly if it is known by messages.

        Args:
            where: A route of the vehicle, and its arc length there [m].
        """
        told, speed, is_cav = vehicle.told, vehicle.speed, vehicle.is_cav
        if told is None or told.seen:
            return self.reach(speed, is_cav, where)
        least = self.reach(max(speed - told.slower, 0.0), is_cav, where).least - told.behind
        fast = max(speed, min(speed + told.faster, self.fastest(is_cav)))
        # It may be past a curve that it is taken to be in.
        farther = self.reach(fast, is_cav, (where[0], where[1] + told.ahead)).most
        most = np.maximum(self.reach(fast, is_cav, where).most, farther) + told.ahead
        steady = self.reach(speed, is_cav, where).steady
        return Reach(partial(_known, least), partial(_known, steady), partial(_known, most))

    def fastest(self, is_cav: bool) -> float:
        """Return the highest speed that a vehicle is expected to have [m/s]."""
        return self.model.top_speed + (0.0 if is_cav else SPEEDING)

    def _bounds(self, speed: float, is_cav: bool, where: Where) -> Reach:
        steady = partial(self._steady, speed, where)
        if is_cav:
            # Without limits neither depends on the present target, so that of any state with this speed will do.
            here = self.state(speed, speed, where)[2:]
            target = next((goal for v, goal, *there in self._travel if v == speed and (*there,) == here), speed)
            travels = self._travels(speed, target, where)
            rows = (self._index[BRAKE], self._index[GO]) if self.model.limits is None else (-2, -1)
            least, most = travels[rows[0]], travels[rows[1]]
            if self.model.limits is None:
                return Reach(partial(_known, least), steady, partial(_known, most))
            return Reach(partial(self._astray, least), steady, partial(self._ahead, most, where))
        return Reach(partial(self._human_least, speed), steady, partial(self._human_most, speed, where))

    def _human_least(self, speed: float) -> Array:
        least = slowest(speed, self.times, self.model.human_braking)
        return least if self.model.limits is None else self._astray(least)

    def _human_most(self, speed: float, where: Where) -> Array:
        pedal = self.model.human_acceleration
        legal = self._legal[where[0]] if self._limited else self.model.top_speed + SPEEDING
        if not self._limited:
            most = accelerated(speed, self.times, legal, pedal)
        else:
            most = driven((self._profiles[where[0]], where[1]), speed, legal, pedal, self.times)
        return most if self.model.limits is None else self._ahead(most, where)

    def _astray(self, least: Array) -> Array:
        """The least that a vehicle comes ahead on its route which drives so far at least."""
        astray = self._strays(least) + (self._across(least) if self._may_change else 0.0)
        return np.maximum(least - astray, 0.0)

    def _ahead(self, most: Array, where: Where) -> Array:
        """The most that a vehicle comes ahead on its route which drives so far at most."""
        return self._cutting(most, where) + STRAYS[1] * self._first

    def _cutting(self, distance: Array, where: Where) -> Array:
        """Distance of a vehicle that cuts all corners: where it drives inside, it takes less time for the same way."""
        bends = CUTS * self._profiles[where[0]].bend(where[1] + distance)
        if not bends.any():
            return distance
        shares = 1.0 - np.minimum(np.maximum(bends[1:], bends[:-1]), 0.5)
        arrives = np.concatenate(([0.0], np.cumsum(self.sample * shares)))
        beyond = np.maximum(self.times - arrives[-1], 0.0) * (distance[-1] - distance[-2]) / self.sample
        return np.asarray(np.interp(self.times, arrives, distance) + beyond)

    def _strays(self, distance: Array) -> Array:
        share, each_second, at_most = STRAYS
        return np.asarray(np.minimum(share * distance + each_second * self._first, at_most))

    def _across(self, distance: Array) -> Array:
        lateral, at_most, width = ACROSS
        driven_each = np.diff(distance, prepend=0.0)
        speeds = np.maximum(driven_each / self.sample, 1.0)
        return np.asarray(np.minimum(np.cumsum(driven_each * np.minimum(lateral / speeds**2, at_most)), width))

    def _steady(self, speed: float, where: Where) -> Array:
        """Distance of a vehicle that keeps its speed but for curves."""
        if not self._limited:
            return speed * self.times
        return driven((self._profiles[where[0]], where[1]), speed, speed, USUAL, self.times)

    def likely(self, speed: float, where: Where = NOWHERE) -> tuple[Array, Array]:
        """Distances between which a human driver is expected, apart from what it could do at the worst.

        Args:
            speed: Speed now [m/s].

        Returns:
            The least and the most, each (steps + 1,) [m].
        """
        key = (speed, where if self._limited else NOWHERE)
        if key not in self._likely:
            self._likely[key] = likely_distances(self._steady(speed, where), self.times)
        return self._likely[key]

    def likely_of(self, human: TrackedVehicle, where: Where) -> tuple[Array, Array]:
        """Distances between which a human driver is expected, wider by what is not known exactly.

        Args:
            where: A route of the vehicle, and its arc length there [m].
        """
        slow, fast = self.likely(human.speed, where)
        return (slow, fast) if human.told is None else (slow - human.told.behind, fast + human.told.ahead)

    def duration(self, where: Where, length: float) -> float:
        """Return how long the fastest vehicle takes from a place on for a length of the centre line [m], in s."""
        if not self._limited:
            return length / self.model.top_speed
        return self._profiles[where[0]].duration(where[1], length)

    def time_to(self, distance: float, travel: Array) -> float:
        """Return when a distance has been covered.

        Args:
            distance: Distance [m].
            travel: Distance travelled (steps + 1,) [m].

        Returns:
            Time from now, going on at the last speed past the horizon; inf if the vehicle stands then [s].
        """
        return self.times_to((distance,), travel)[0]

    def times_to(self, distances: Sequence[float], travel: Array) -> tuple[float, ...]:
        """Return `time_to` of several distances for one motion."""
        return covered_after(distances, travel.tolist(), self._clock, self.sample)


def likely_distances(steady: Array, times: Array) -> tuple[Array, Array]:
    """Distances between which a driver is expected, who goes on at about the present speed."""
    at_once, each_second, at_most = DRIFT
    drift = np.minimum(at_once + each_second * times, at_most)
    return np.maximum(steady - drift, 0.0), steady + drift


def slowest(speed: float, times: Array, pedal: float) -> Array:
    """Distance of a driver who brakes hard at once [m/s2]."""
    braking = np.minimum(times, speed / pedal)
    return np.asarray(speed * braking - pedal * braking**2 / 2)
