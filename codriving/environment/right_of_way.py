"""Who meets whom at the junction, and who can still wait before it."""

from collections.abc import Iterable

import numpy as np
from highway_env.vehicle.behavior import IDMVehicle

from codriving.datatypes.conflict import Relation
from codriving.environment.on_way import OnWay
from codriving.geometry.road_map import RoadMap

HORIZON = np.arange(0.25, 3.0, 0.25)
"""Times at which the right of way looks for a conflict at constant speed, as highway-env does [s]."""

LAST = float(HORIZON[-1])

SIGHT = 25.0
"""How far ahead a driver minds who is in the junction [m]."""

OVERSHOOT = 1.0
"""How far a driver may come into a zone and still wait there; the bodies do not touch yet [m]."""

STARTING = 4.0
"""Speed that a driver who creeps or stands expects to have soon [m/s]."""

GRID = 1.0
"""More than what the tables of a zone reach beyond its ends [m]."""


def will_meet(road_map: RoadMap, one: OnWay, other: OnWay) -> bool:
    """Whether two vehicles would be in a conflict zone together at constant speed within three seconds.

    Vehicles that merely follow one another are left to the car-following model.

    Args:
        road_map: The precomputed road.
        one: A vehicle.
        other: Another vehicle.
    """
    reach_one = one.s + pace(one) * LAST + GRID
    reach_other = other.s + pace(other) * LAST + GRID
    for zone in road_map.zones(one.way.route.id, other.way.route.id):
        if zone.relation in (Relation.FOLLOWING, Relation.DIVERGING):
            continue
        if one.s > zone.exit_i or other.s > zone.exit_j or reach_one < zone.entry_i or reach_other < zone.entry_j:
            continue
        s_one, s_other = one.s + pace(one) * HORIZON, other.s + pace(other) * HORIZON
        if np.any((s_one >= zone.back(s_other)) & (s_one <= zone.front(s_other))):
            return True
    return False


def pace(vehicle: OnWay) -> float:
    """Speed at which a vehicle is expected to go on: a driver who creeps or stands means to start.

    Args:
        vehicle: A vehicle.

    Returns:
        Speed [m/s].
    """
    return float(max(vehicle.speed, STARTING if isinstance(vehicle, IDMVehicle) else 0.0))


def can_wait(driver: OnWay) -> bool:
    """Whether a driver is still before the entry of the junction and can stop there.

    Args:
        driver: A human driver.
    """
    room = driver.way.route.entry - driver.s - driver.LENGTH / 2
    return bool(room > 0 and driver.speed**2 / (2 * driver.ACC_MAX) <= room)


def occupied_ahead(road_map: RoadMap, driver: OnWay, others: Iterable[OnWay]) -> float | None:
    """Find the nearest conflict zone on a driver's way that somebody is in, if the driver can still stop before it.

    Args:
        road_map: The precomputed road.
        driver: A human driver.
        others: Vehicles on the road; the driver may be among them.

    Returns:
        Arc length of the driver's centre at which it must stand [m], or None.
    """
    stop = driver.s + driver.speed**2 / (2 * driver.ACC_MAX)
    nearest: float | None = None
    for other in others:
        if other is driver:
            continue
        for zone in road_map.zones(driver.way.route.id, other.way.route.id):
            if zone.relation in (Relation.FOLLOWING, Relation.DIVERGING):
                continue
            inside = zone.entry_j < other.s < (zone.exit_j if zone.merge_j is None else zone.merge_j)
            if (
                inside
                and stop < zone.entry_i + OVERSHOOT
                and zone.entry_i < driver.s + SIGHT
                and (nearest is None or zone.entry_i < nearest)
            ):
                nearest = zone.entry_i
    return nearest
