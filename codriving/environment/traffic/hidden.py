"""Which vehicles a building hides from one another."""

from collections.abc import Mapping, Sequence

import numpy as np

from codriving.environment.traffic.route_following import RouteFollower
from codriving.geometry import RoadMap

Hidden = Mapping[RouteFollower, frozenset[RouteFollower]]  # By vehicle, those that it cannot see


def hidden_vehicles(road_map: RoadMap, vehicles: Sequence[RouteFollower]) -> Hidden:
    """Return which vehicles cannot see which, from centre to centre; nothing where no buildings stand."""
    if road_map.sight is None:
        return {}
    x, y = np.array([vehicle.position for vehicle in vehicles]).reshape(-1, 2).T
    return {
        vehicle: frozenset(vehicles[k] for k in np.flatnonzero(row).tolist())
        for vehicle, row in zip(vehicles, road_map.sight.hidden(x, y), strict=True)
    }
