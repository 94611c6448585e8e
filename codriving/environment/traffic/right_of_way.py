"""Which vehicles meet at the junction, and which can still wait before it."""

import math
from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from codriving.datatypes import Relation
from codriving.environment.traffic.route_following import RouteFollower
from codriving.geometry import RoadMap

Array = NDArray[np.float64]
Spot = tuple[str, float]  # A route, and the arc length on it [m]

# Times at which the right of way looks for a conflict; highway-env looks as far [s].
HORIZON = np.arange(0.25, 3.0, 0.25)

SIGHT = 25.0  # How far ahead a driver minds vehicles in the junction [m]

# How far a driver may come over the line or into a zone and still wait there; the bodies do not touch yet [m].
OVERSHOOT = 1.0

STARTING = 4.0  # Speed that a driver who creeps or stands expects to have soon [m/s]

GRID = 1.0  # More than what the tables of a zone reach beyond its ends [m]


class Ahead:
    """Where a vehicle may be on its route, or on another one, at some times; worked out as far as it is asked for.

    A CAV is expected to keep its speed. A human driver may also speed up: one who has braked to wait would else be let
    go for the low speed, speed up, and be in the way when it is too late to wait.

    Attributes:
        route, s: The route, and the arc length on it [m].
    """

    __slots__ = ("_elsewhere", "_pace", "_places", "_times", "route", "s", "vehicle")

    def __init__(self, vehicle: RouteFollower, times: Array = HORIZON, spot: Spot | None = None) -> None:
        self.vehicle, self._times, self._pace = vehicle, times, pace(vehicle)
        self.route, self.s = spot or (vehicle.route_path.route.id, vehicle.s)
        self._elsewhere = spot is not None
        self._places: Array | None = None

    def reach(self, count: int) -> float:
        """Return the farthest place at the last of so many times [m]; the last one of `places`."""
        vehicle, time = self.vehicle, float(self._times[count - 1])
        farthest = vehicle.s + self._pace * time
        if vehicle.by_idm:
            rising = min(time, self._gain() / vehicle.COMFORT_ACC_MAX)
            faster = vehicle.s + vehicle.speed * time + vehicle.COMFORT_ACC_MAX * rising * (time - rising / 2)
            farthest = max(farthest, faster)
        return float(farthest - vehicle.s + self.s if self._elsewhere else farthest)

    def places(self, count: int) -> Array:
        """Return where it may be at so many times [m]: steadily and, by a human driver, faster (1 or 2, count)."""
        if self._places is None:
            vehicle, times = self.vehicle, self._times
            found = (vehicle.s + self._pace * times)[None]
            if vehicle.by_idm:
                rising = np.minimum(times, self._gain() / vehicle.COMFORT_ACC_MAX)
                faster = vehicle.s + vehicle.speed * times + vehicle.COMFORT_ACC_MAX * rising * (times - rising / 2)
                found = np.concatenate((found, np.maximum(found, faster)))
            self._places = found - vehicle.s + self.s if self._elsewhere else found
        return self._places[:, :count]

    def _gain(self) -> float:
        vehicle = self.vehicle
        return float(max(min(vehicle.target_speed, vehicle.lane.speed_limit) - vehicle.speed, 0.0))


def meet(road_map: RoadMap, one: Ahead, other: Ahead, count: int = len(HORIZON)) -> bool:
    """Whether two vehicles would be in a conflict zone together at one of so many times.

    Vehicles that merely follow one another are left to the car-following model.
    """
    zones = road_map.zones(one.route, other.route)
    if not zones:
        return False
    reach_one, reach_other = one.reach(count) + GRID, other.reach(count) + GRID
    for zone in zones:
        if one.s > zone.exit_i or other.s > zone.exit_j or reach_one < zone.entry_i or reach_other < zone.entry_j:
            continue
        if zone.relation in (Relation.FOLLOWING, Relation.DIVERGING):
            continue
        # Each way in which the one may go on against each of the other one's.
        ones = one.places(count)
        back, front = zone.blocked(other.places(count)[:, None])
        if ((ones >= back) & (ones <= front)).any():
            return True
    return False


def pace(vehicle: RouteFollower) -> float:
    """Return the speed at which a vehicle is expected to go on [m/s]: a driver who creeps or stands means to start."""
    return float(max(vehicle.speed, STARTING if vehicle.by_idm else 0.0))


def can_wait(driver: RouteFollower) -> bool:
    """Whether a driver can still stop before the junction, its front over the line by a metre at most."""
    return stops_before_junction(driver, driver.ACC_MAX)


def stops_before_junction(vehicle: RouteFollower, braking: float) -> bool:
    """Whether a vehicle can still stop before the junction with some braking [m/s2]."""
    room = vehicle.route_path.route.entry + OVERSHOOT - vehicle.s - vehicle.LENGTH / 2
    return bool(room > 0 and vehicle.speed**2 / (2 * braking) <= room)


def occupied_ahead(road_map: RoadMap, driver: RouteFollower, others: Iterable[RouteFollower]) -> float | None:
    """Find the nearest occupied conflict zone on a driver's route, if the driver can still stop before it."""
    spots = ((other.route_path.route.id, other.s) for other in others if other is not driver)
    return occupied_by(road_map, driver, spots)


def occupied_by(road_map: RoadMap, driver: RouteFollower, others: Iterable[Spot]) -> float | None:
    """Find the nearest conflict zone that is occupied, by where the others are taken to be."""
    stop = driver.s + driver.speed**2 / (2 * driver.ACC_MAX)
    own, sight, nearest = driver.route_path.route.id, driver.s + SIGHT, math.inf
    for route, place in others:
        for zone in road_map.zones(own, route):
            if not (stop < zone.entry_i + OVERSHOOT and zone.entry_i < sight and zone.entry_i < nearest):
                continue
            inside = zone.entry_j < place < (zone.exit_j if zone.merge_j is None else zone.merge_j)
            if inside and zone.relation not in (Relation.FOLLOWING, Relation.DIVERGING):
                nearest = zone.entry_i
    return nearest if nearest < math.inf else None
