"""Which vehicles meet at the junction, and which can still wait before it."""

import math
from collections.abc import Iterable

import numpy as np
from highway_env.vehicle.behavior import IDMVehicle
from numpy.typing import NDArray

from codriving.datatypes import Relation
from codriving.environment.traffic.route_following import RouteFollower
from codriving.geometry import RoadMap

Array = NDArray[np.float64]
Spot = tuple[str, float]  # A route, and the arc length on it [m]

# Times at which the right of way looks for a conflict; highway-env looks as far [s].
HORIZON = np.arange(0.25, 3.0, 0.25)

LAST = float(HORIZON[-1])

SIGHT = 25.0  # How far ahead a driver minds vehicles in the junction [m]

# How far a driver may come over the line or into a zone and still wait there; the bodies do not touch yet [m].
OVERSHOOT = 1.0

STARTING = 4.0  # Speed that a driver who creeps or stands expects to have soon [m/s]

GRID = 1.0  # More than what the tables of a zone reach beyond its ends [m]


def will_meet(road_map: RoadMap, one: RouteFollower, other: RouteFollower) -> bool:
    """Whether two vehicles would be in a conflict zone together within three seconds.

    Vehicles that merely follow one another are left to the car-following model. A CAV is expected to keep its speed. A
    human driver may also speed up: one who has braked to wait would else be let go for the low speed, speed up, and be
    in the way when it is too late to wait.
    """
    return meet(road_map, one, other, motions(one), motions(other))


def meet(road_map: RoadMap, one: RouteFollower, other: RouteFollower, ones: Array, others: Array) -> bool:
    """Whether two vehicles would be in a conflict zone together, by where each may be soon."""
    places = ((one.route_path.route.id, one.s), (other.route_path.route.id, other.s))
    return meet_on(road_map, *places, ones, others)


def meet_on(road_map: RoadMap, one: Spot, other: Spot, ones: Array, others: Array) -> bool:
    """Whether two vehicles would be in a conflict zone together, by the routes on which they are taken to be."""
    reach_one, reach_other = ones[-1, -1] + GRID, others[-1, -1] + GRID
    for zone in road_map.zones(one[0], other[0]):
        if zone.relation in (Relation.FOLLOWING, Relation.DIVERGING):
            continue
        if one[1] > zone.exit_i or other[1] > zone.exit_j or reach_one < zone.entry_i or reach_other < zone.entry_j:
            continue
        # Each way in which the one may go on against each of the other one's.
        back, front = zone.blocked(others[:, None])
        if ((ones >= back) & (ones <= front)).any():
            return True
    return False


def motions(vehicle: RouteFollower, times: Array = HORIZON) -> Array:
    """Where a vehicle may be on its route at some times [s]."""
    steady: Array = vehicle.s + pace(vehicle) * times
    if not isinstance(vehicle, IDMVehicle):
        return steady[None]
    gain = max(min(vehicle.target_speed, vehicle.lane.speed_limit) - vehicle.speed, 0.0)
    rising = np.minimum(times, gain / vehicle.COMFORT_ACC_MAX)
    faster = vehicle.s + vehicle.speed * times + vehicle.COMFORT_ACC_MAX * rising * (times - rising / 2)
    return np.stack((steady, np.maximum(steady, faster)))


def pace(vehicle: RouteFollower) -> float:
    """Return the speed at which a vehicle is expected to go on [m/s]: a driver who creeps or stands means to start."""
    return float(max(vehicle.speed, STARTING if isinstance(vehicle, IDMVehicle) else 0.0))


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
    nearest = math.inf
    for route, place in others:
        for zone in road_map.zones(driver.route_path.route.id, route):
            if zone.relation in (Relation.FOLLOWING, Relation.DIVERGING):
                continue
            inside = zone.entry_j < place < (zone.exit_j if zone.merge_j is None else zone.merge_j)
            if inside and stop < zone.entry_i + OVERSHOOT and zone.entry_i < min(driver.s + SIGHT, nearest):
                nearest = zone.entry_i
    return nearest if nearest < math.inf else None
