"""A vehicle that drives its route alone: what its travel time is compared with."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from codriving.datatypes import Action, beside
from codriving.environment.cav import ConnectedVehicle
from codriving.environment.traffic.traffic import Traffic
from codriving.geometry import FloatArray


def drive_alone(traffic: Traffic, step: float, substeps: int, time_limit: float) -> FloatArray:
    """Drive the only vehicle of a traffic to the goal of its route, a CAV as fast as its actions let it.

    Returns:
        Its arc length along the route with which it began, from its start on, one a simulation step (n,) [m].
    """
    (vehicle,) = traffic.vehicles
    route_path, place = vehicle.route_path, vehicle.s
    places = [place]
    # There is none to give way to; but drivers with a style note what they see.
    move = vehicle.step if traffic.past is None else traffic.step
    while place < route_path.route.goal and len(places) * step <= time_limit and traffic.vehicles:
        if isinstance(vehicle, ConnectedVehicle) and (len(places) - 1) % substeps == 0:
            vehicle.act(_fastest(vehicle))
        traffic.act()
        move(step)
        # After a lane change it may count along another route.
        place = (
            vehicle.s if vehicle.route_path is route_path else route_path.follow(*vehicle.position.tolist(), place)[0]
        )
        places.append(place)
    return np.array(places)


def _fastest(vehicle: ConnectedVehicle) -> Action:
    """Faster, or to the lane that the route goes on along as soon as that can be done."""
    lanes, available = vehicle.route_path.route.lanes, vehicle.available()
    start, end, index = vehicle.target_lane_index
    for side, other in ((Action.LANE_LEFT, index - 1), (Action.LANE_RIGHT, index + 1)):
        if side in available and (start, end, other) in _after(lanes, (start, end, index)):
            return side
    return Action.FASTER


def _after(lanes: Sequence[tuple[str, str, int]], lane: tuple[str, str, int]) -> list[tuple[str, str, int]]:
    """The lanes beside one that a route has to change to from it."""
    return [b for a, b in pairwise(lanes) if a == lane and beside(a, b)]
