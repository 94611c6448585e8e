"""Where a road side unit stands: in the middle of what CAVs drive across."""

from itertools import combinations

import numpy as np

from codriving.datatypes import Relation
from codriving.geometry import RoadMap

MEETINGS = (Relation.CROSSING, Relation.CONVERGING, Relation.WEAVING)


def centre(road_map: RoadMap) -> tuple[float, float]:
    """Return the middle of all places where routes cross or come together, or of the road if there are none [m]."""
    places = [
        road_map.paths[one].position(zone.point_i)
        for one, other in combinations(sorted(road_map.routes), 2)
        for zone in road_map.zones(one, other)
        if zone.relation in MEETINGS
    ]
    if not places:
        places = [road_map.paths[name].position(route.goal / 2) for name, route in sorted(road_map.routes.items())]
    x, y = np.array(places, dtype=np.float64).mean(axis=0).tolist()
    return round(x, 3), round(y, 3)
