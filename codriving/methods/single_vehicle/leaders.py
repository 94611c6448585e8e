"""Who drives ahead of a vehicle on a stretch that both share, on any way that is possible for either."""

from collections.abc import Iterator
from dataclasses import dataclass

from codriving.datatypes.conflict import Relation
from codriving.datatypes.scene_description import Role, SceneDescription
from codriving.geometry.road_map import RoadMap
from codriving.geometry.zone import ConflictZone
from codriving.reasoning.prediction.expectation import is_behind


@dataclass(frozen=True, slots=True)
class Leader:
    """Somebody, or something, that a vehicle must not run into.

    Attributes:
        gap: Free distance [m].
        speed: Its speed along the way [m/s].
    """

    id: str
    gap: float
    speed: float


def leaders(scene: SceneDescription, road_map: RoadMap) -> tuple[Leader, ...]:
    """Return everybody who drives ahead, at the smallest gap on any of the ways, in order of id.

    The end of a lane that has to be left stands still.
    """
    ways = ((scene.intent.route, scene.place), *scene.covers)
    found = []
    for n in scene.neighbours:
        bodies = (n.length + scene.ego.length) / 2
        gaps = [ahead - bodies for route, place in n.routes for ahead in _ahead(ways, route, place, road_map)]
        if n.role is Role.LEADING and n.gap is not None:
            gaps.append(n.gap)
        if gaps:
            found.append(Leader(n.id, min(gaps), n.speed))
    if scene.must_change is not None:
        found.append(Leader("the end of the lane", scene.must_change.room - scene.ego.length / 2, 0.0))
    return tuple(found)


def _ahead(ways: tuple[tuple[str, float], ...], route: str, place: float, road_map: RoadMap) -> Iterator[float]:
    """Distances of the centres by which a vehicle on a route is ahead, where it is [m]."""
    for own, here in ways:
        for zone in road_map.zones(own, route):
            if is_behind(zone, here, place):
                yield lead(zone, here, place)


def lead(zone: ConflictZone, place: float, other: float) -> float:
    """Return by how much another vehicle is ahead on a stretch that two routes share [m]; negative if it is behind.

    Args:
        place: Arc length of the vehicle [m].
        other: Arc length of the other vehicle [m].
    """
    if zone.relation in (Relation.FOLLOWING, Relation.DIVERGING) or zone.merge_i is None or zone.merge_j is None:
        return (other - zone.entry_j) - (place - zone.entry_i)
    return (other - zone.merge_j) - (place - zone.merge_i)
