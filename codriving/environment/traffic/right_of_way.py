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
    reach_one, reach_other = ones[-1, -1] + GRID, others[-1, -1] + GRID
    for zone in road_map.zones(one.route_path.route.id, other.route_path.route.id):
        if zone.relation in (Relation.FOLLOWING, Relation.DIVERGING):
            continue
        if one.s > zone.exit_i or other.s > zone.exit_j or reach_one < zone.entry_i or reach_other < zone.entry_j:
            continue
        for places in others:
            if np.any((ones >= zone.back(places)) & (ones <= zone.front(places))):
                return True
    return False


def motions(vehicle: RouteFollower) -> Array:
    """Where a vehicle may be on its route at the times of the horizon."""
    steady: Array = vehicle.s + pace(vehicle) * HORIZON
    if not isinstance(vehicle, IDMVehicle):
        return steady[None]
    gain = max(min(vehicle.target_speed, vehicle.lane.speed_limit) - vehicle.speed, 0.0)
    rising = np.minimum(HORIZON, gain / vehicle.COMFORT_ACC_MAX)
    faster = vehicle.s + vehicle.speed * HORIZON + vehicle.COMFORT_ACC_MAX * rising * (HORIZON - rising / 2)
    return np.stack((steady, np.maximum(steady, faster)))


def pace(vehicle: RouteFollower) -> float:
    """Return the speed at which a vehicle is expected to go on [m/s]: a driver who creeps or stands means to start."""
    return float(max(vehicle.speed, STARTING if isinstance(vehicle, IDMVehicle) else 0.0))


def can_wait(driver: RouteFollower) -> bool:
    """Whether a driver can still stop before the junction, its front over the line by a metre at most."""
    room = driver.route_path.route.entry + OVERSHOOT - driver.s - driver.LENGTH / 2
    return bool(room > 0 and driver.speed**2 / (2 * driver.ACC_MAX) <= room)


def occupied_ahead(road_map: RoadMap, driver: RouteFollower, others: Iterable[RouteFollower]) -> float | None:
    """Find the nearest occupied conflict zone on a driver's route, if the driver can still stop before it."""
    stop = driver.s + driver.speed**2 / (2 * driver.ACC_MAX)
    nearest = math.inf
    for other in others:
        if other is driver:
            continue
        for zone in road_map.zones(driver.route_path.route.id, other.route_path.route.id):
            if zone.relation in (Relation.FOLLOWING, Relation.DIVERGING):
                continue
            inside = zone.entry_j < other.s < (zone.exit_j if zone.merge_j is None else zone.merge_j)
            if inside and stop < zone.entry_i + OVERSHOOT and zone.entry_i < min(driver.s + SIGHT, nearest):
                nearest = zone.entry_i
    return nearest if nearest < math.inf else None
