"""Room past the junction, without which a CAV does not enter it, and room to get out of it.

Germany's StVO 11(1) and rule 174 of the UK's Highway Code ("until your exit is clear") ask for this.
"""

from collections.abc import Mapping
from functools import lru_cache

import numpy as np

from codriving.datatypes import Relation, TrackedVehicle
from codriving.geometry import TRUE, RoadMap, corners, overlaps
from codriving.reasoning.perception import Moment

PATIENCE = 2.0  # A human driver who has been standing for this long is taken to give way [s]

BESIDE = 0.15  # Room on each side of a CAV that drives past one that stands [m]

APART = 0.25  # Distance of two places at which it is looked at [m]

GAP = 2.0  # Free distance that is left to a vehicle that stands [m]

STANDS = 0.5  # Below this speed a vehicle stands [m/s]


@lru_cache(maxsize=1024)
def boxes(road_map: RoadMap, route: str) -> tuple[tuple[float, float], ...]:
    """Return where a vehicle on a route is in the way of those who cross it: begin and end of each stretch [m]."""
    zones = [z for other in road_map.routes if other != route for z in road_map.zones(route, other)]
    found: list[tuple[float, float]] = []
    for begin, end in sorted((z.entry_i, z.exit_i) for z in zones if z.relation is Relation.CROSSING):
        if found and begin <= found[-1][1]:
            found[-1] = (found[-1][0], max(end, found[-1][1]))
        else:
            found.append((begin, end))
    return tuple(found)


def full_exit(moment: Moment, vehicles: Mapping[str, TrackedVehicle], cav: TrackedVehicle) -> tuple[str, float] | None:
    """Return which vehicle leaves no room past the next junction, and the place where a CAV has to stop for it [m].

    Returns:
        None if there is room, and for a CAV that is in the junction or can no longer stop before it.
    """
    road_map, forecast = moment.road_map, moment.forecast
    if all(v.speed >= STANDS or v.id == cav.id for v in vehicles.values()):
        return None
    route, place = cav.routes[0]
    begin, end = next((box for box in boxes(road_map, route) if place < box[1]), (place, place))
    if not forecast.model.steady or place >= begin:
        return None
    others = (v for v in vehicles.values() if v.id != cav.id)
    ahead = [(s, v) for v in others if (s := _along(road_map, cav, v)) is not None]
    standing = {v.id: s - v.length / 2 - GAP for s, v in ahead if v.speed < STANDS and s - v.length / 2 > end}
    if not standing:
        return None
    first = min(standing, key=lambda name: (standing[name], name))
    between = sum(v.length + GAP for s, v in ahead if s < standing[first])
    stops = place + float(forecast.reach(cav.speed, True, cav.routes[0]).least[-1])
    full = standing[first] - between - cav.length / 2 < end
    return (first, begin) if full and stops < begin else None


def _along(road_map: RoadMap, cav: TrackedVehicle, other: TrackedVehicle) -> float | None:
    """Return where another vehicle is that is in the next junction, or past it, and leaves as a CAV does [m].

    It is measured along the route of the CAV, from the lane on which both leave.
    """
    (route, place), lane = cav.routes[0], road_map.routes[cav.routes[0][0]].lanes[-1]
    for way, there in other.routes:
        if road_map.routes[way].lanes[-1] == lane:
            s = there - road_map.lane_start(way, lane) + road_map.lane_start(route, lane)
            if s > place and (way == route or there >= road_map.routes[way].entry):
                return s
    return None


def gets_out(moment: Moment, cav: TrackedVehicle, other: TrackedVehicle, goes_first: bool) -> bool:
    """Whether a CAV that is in the junction may drive out of it past another vehicle, which stands.

    Of two CAVs the one that goes first may, and before a human driver who has been standing for a while either may. The
    body of the other one, where it stands, must not be in the way.
    """
    if not moment.forecast.model.steady or other.speed >= STANDS or other.heading is None:
        return False
    (route, place), road_map = cav.routes[0], moment.road_map
    box = next((box for box in boxes(road_map, route) if box[0] <= place < box[1]), None)
    if box is None or not (goes_first if other.is_cav else other.standing >= PATIENCE):
        return False
    path, s = road_map.paths[route], np.arange(place, box[1], APART)
    own = corners(*path.position(s), path.heading(s), cav.length, TRUE.width + 2 * BESIDE)
    return not overlaps(own, corners(other.x, other.y, other.heading, other.length, TRUE.width)).any()
