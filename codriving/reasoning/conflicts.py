"""The conflict description: whose way ahead shares a zone with the ego vehicle's, and how soon (III-C.3, Eq. 3)."""

from codriving.datatypes import Conflict, Relation, SceneDescription, Severity, TrackedVehicle
from codriving.geometry import ConflictZone, RoadMap

OPEN = (Relation.CROSSING, Relation.CONVERGING, Relation.WEAVING)  # Relations in which it is open who goes first

# Speed below which the time to the conflict point is counted as if at this speed [m/s]; at rest it has none.
SLOWEST = 0.5


def find_conflicts(scene: SceneDescription, road_map: RoadMap) -> tuple[Conflict, ...]:
    """Find the conflicts of one CAV, most urgent first."""
    found = (
        _conflict(scene, neighbour, route, place, index, zone)
        for neighbour in scene.neighbours
        for route, place in neighbour.routes
        for index, zone in enumerate(road_map.zones(scene.intent.route, route))
        if is_open(zone, scene.place, place)
    )
    return tuple(sorted(found, key=lambda c: (c.dttcp + 0.2 * min(c.ttcp), c.other, c.routes[1], c.zone)))


def is_open(zone: ConflictZone, place_i: float, place_j: float) -> bool:
    """Whether two vehicles still have a zone ahead of which it is open, or matters, who goes first.

    Where ways merge this is open until one of the two has passed the beginning of the zone. From there on the other one
    cannot get past it any more, and follows or leads it. A vehicle that comes by a lane change may still be beside.

    Args:
        place_i: Arc length of i on its route [m].
        place_j: Arc length of j on its route [m].
    """
    if zone.relation not in OPEN or place_i > zone.exit_i or place_j > zone.exit_j:
        return False
    if zone.merge_i is None or zone.merge_j is None:
        return True
    if zone.changes_i or zone.changes_j:
        merged_i, merged_j = place_i >= zone.merge_i, place_j >= zone.merge_j
        settled = (merged_i and merged_j) or (merged_i and not zone.changes_i) or (merged_j and not zone.changes_j)
        return not settled
    return place_i <= zone.entry_i and place_j <= zone.entry_j


def is_behind(zone: ConflictZone, place: float, other: float) -> bool:
    """Whether a vehicle follows another one on a stretch that both routes share, or into it.

    Args:
        place: Arc length of the vehicle [m].
        other: Arc length of the other vehicle [m].
    """
    if place > zone.exit_i or other > zone.exit_j:
        return False
    if zone.relation in (Relation.FOLLOWING, Relation.DIVERGING):
        return place < other
    if zone.merge_i is None or zone.merge_j is None or is_open(zone, place, other) or other <= zone.entry_j:
        return False
    if place <= zone.entry_i:
        return True
    begin, end = zone.over_i.blocked(place)
    if begin <= other <= end:
        return place - zone.merge_i < other - zone.merge_j
    return bool(other > end)


def has_joined(zone: ConflictZone, place: float) -> bool:
    """Whether a vehicle at a place on route i [m] is on the stretch itself where both drive one behind the other."""
    return zone.merge_i is None or place >= zone.merge_i


def _conflict(
    scene: SceneDescription, neighbour: TrackedVehicle, route: str, place: float, index: int, zone: ConflictZone
) -> Conflict:
    distances = (max(zone.entry_i - scene.place, 0.0), max(zone.entry_j - place, 0.0))
    times = (ttcp(distances[0], scene.ego.speed), ttcp(distances[1], neighbour.speed))
    return Conflict(
        ego=scene.ego.id,
        other=neighbour.id,
        relation=zone.relation,
        routes=(scene.intent.route, route),
        zone=index,
        places=(scene.place, place),
        distances=distances,
        exits=(zone.exit_i - scene.place, zone.exit_j - place),
        ttcp=times,
        dttcp=abs(times[0] - times[1]),
        severity=severity(abs(times[0] - times[1])),
        certain=neighbour.intent is not None or len(neighbour.routes) == 1,
    )


def ttcp(distance: float, speed: float) -> float:
    """Time to the conflict point at the present speed.

    Args:
        distance: Distance to the conflict point [m].
        speed: Speed [m/s].

    Returns:
        Time [s]; 0 at or past the point.
    """
    return max(distance, 0.0) / max(speed, SLOWEST)


def severity(dttcp: float) -> Severity:
    """Put a difference of times to the conflict point into the paper's bands."""
    if dttcp <= 2.0:
        return Severity.SERIOUS
    if dttcp <= 5.0:
        return Severity.GENERAL
    return Severity.SLIGHT if dttcp <= 8.0 else Severity.NONE
