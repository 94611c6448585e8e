"""Scene descriptions: states and intents put in relation to the ego vehicle, lane by lane (Section III-C.1 and 2)."""

from collections.abc import Mapping
from dataclasses import replace
from math import cos, pi

from codriving.datatypes.conflict import Conflict
from codriving.datatypes.road import LaneId
from codriving.datatypes.scene_description import Neighbour, Role, SceneDescription
from codriving.datatypes.vehicle import Intent
from codriving.datatypes.world import WorldState
from codriving.geometry.road_map import RoadMap
from codriving.reasoning.glimpse import Glimpse
from codriving.reasoning.state_sharing import Views
from codriving.reasoning.tracking import Tracking

SAME_LANE = 2.0
"""A vehicle is on the ego lane within this lateral offset, half a lane [m]."""

ALIGNED = cos(pi / 3)
"""A vehicle on the ego lane heads within 60 degrees of it, where its heading is known."""


def describe_scenes(
    world: WorldState, views: Views, intents: Mapping[str, Intent], tracking: Tracking
) -> dict[str, SceneDescription]:
    """Describe the surroundings of every CAV; who is in conflict with whom is filled in later.

    Args:
        world: The world, of which each CAV's own state and intent are read.
        views: What each CAV knows of the others.
        intents: Intents that have been shared.
        tracking: What each CAV remembers of the others.

    Returns:
        One description a CAV, by id.
    """
    tracking.begin_step()
    road_map = tracking.road_map
    scenes = {}
    for ego in world.cavs:
        intent = world.intents[ego.id]
        path = road_map.paths[intent.route]
        place, _ = path.project(ego.x, ego.y)
        neighbours = [_neighbour(seen, intents.get(seen.id), tracking, ego.id, world.time) for seen in views[ego.id]]
        ahead: tuple[float, str] | None = None
        behind: tuple[float, str] | None = None
        for n in neighbours:
            s, side = path.project(n.x, n.y)
            aligned = n.heading is None or cos(n.heading - float(path.heading(s))) > ALIGNED
            if abs(side) > SAME_LANE or not aligned:
                continue
            gap = abs(s - place) - (n.length + ego.length) / 2
            if s > place and (ahead is None or gap < ahead[0]):
                ahead = (gap, n.id)
            elif s <= place and (behind is None or gap < behind[0]):
                behind = (gap, n.id)
        roles = {}
        if ahead:
            roles[ahead[1]] = (Role.LEADING, ahead[0])
        if behind:
            roles[behind[1]] = (Role.REARING, behind[0])
        scenes[ego.id] = SceneDescription(
            ego=ego,
            intent=intent,
            place=place,
            adjacent_lanes=adjacent_lanes(road_map, ego.lane),
            conflict_lanes=(),
            neighbours=tuple(
                replace(n, role=roles[n.id][0], gap=roles[n.id][1]) if n.id in roles else n for n in neighbours
            ),
        )
    return scenes


def with_conflicts(scene: SceneDescription, conflicts: tuple[Conflict, ...], road_map: RoadMap) -> SceneDescription:
    """Mark the vehicles and lanes with which the ego vehicle is in conflict.

    Args:
        scene: The description so far.
        conflicts: Conflicts of the ego vehicle.
        road_map: The precomputed road.
    """
    others = {c.other for c in conflicts}
    lanes: set[LaneId] = set()
    for c in conflicts:
        zone = road_map.zones(*c.routes)[c.zone]
        lanes.add(lane_at(road_map, c.routes[1], zone.point_j))
    neighbours = tuple(
        replace(n, role=Role.CONFLICT) if n.id in others and n.role is Role.OTHER else n for n in scene.neighbours
    )
    return replace(scene, neighbours=neighbours, conflict_lanes=tuple(sorted(lanes)))


def adjacent_lanes(road_map: RoadMap, lane: LaneId) -> tuple[LaneId, ...]:
    """Return the lanes to the left and right of a lane that run its way.

    Args:
        road_map: The precomputed road.
        lane: A lane.
    """
    start, end, index = lane
    sides = ((start, end, index - 1), (start, end, index + 1))
    return tuple(side for side in sides if side in road_map.lanes)


def lane_at(road_map: RoadMap, route: str, s: float) -> LaneId:
    """Return the lane of a route at an arc length.

    Args:
        road_map: The precomputed road.
        route: Id of the route.
        s: Arc length [m].
    """
    lanes = road_map.routes[route].lanes
    return [lane for lane in lanes if road_map.lane_start(route, lane) <= max(s, 0.0)][-1]


def _neighbour(seen: Glimpse, intent: Intent | None, tracking: Tracking, ego: str, time: float) -> Neighbour:
    return Neighbour(
        id=seen.id,
        # Whoever shares an intent has said that it is a CAV.
        kind="CAV" if intent is not None else seen.kind,
        x=seen.x,
        y=seen.y,
        speed=seen.speed,
        heading=seen.heading,
        acceleration=seen.acceleration,
        lane=seen.lane,
        length=seen.length,
        routes=tracking.places(ego, seen, intent),
        intent=intent,
        standing=tracking.standing(ego, seen, time),
        role=Role.OTHER,
        gap=None,
    )
