"""Scene descriptions: states and intents put in relation to the ego vehicle, lane by lane (Section III-C.1 and 2)."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from math import cos, pi

from codriving.datatypes import (
    Conflict,
    Intent,
    Kind,
    LaneChange,
    LaneId,
    LaneNeighbour,
    Role,
    SceneDescription,
    TrackedVehicle,
    VehicleState,
    WorldState,
)
from codriving.geometry import RoadMap
from codriving.reasoning.conflicts import is_behind
from codriving.reasoning.sharing.sharing import Detections
from codriving.reasoning.sharing.tracking import Tracking

SAME_LANE = 2.0  # A vehicle is on the ego lane within this lateral offset, half a lane [m]

ALIGNED = cos(pi / 3)  # A vehicle on the ego lane heads within 60 degrees of it, where its heading is known


NO_ROLE: tuple[Role, float | None] = (Role.OTHER, None)  # Who is neither ahead nor behind; conflicts are found later


def describe_scenes(
    world: WorldState, detections: Detections, intents: Mapping[str, Intent], tracking: Tracking
) -> dict[str, SceneDescription]:
    """Describe the surroundings of every CAV; who is in conflict with whom is filled in later.

    Returns:
        One description a CAV, by id.
    """
    tracking.begin_step()
    road_map = tracking.road_map
    scenes = {}
    for ego in world.cavs:
        intent, seen = world.intents[ego.id], detections[ego.id]
        road_map.project_all(intent.route, [(ego.x, ego.y), *((other.x, other.y) for other in seen)])
        place, _ = road_map.project(intent.route, ego.x, ego.y)
        change = road_map.changes.ahead(intent.route, place)
        others = [_neighbour(other, intents.get(other.id), world, tracking, ego.id) for other in seen]
        lanes = adjacent_lanes(road_map, ego.lane)
        scenes[ego.id] = SceneDescription(
            ego=ego,
            intent=intent,
            place=place,
            adjacent_lanes=lanes,
            conflict_lanes=(),
            covers=road_map.changes.covered(intent.route, road_map.lane_at(intent.route, place), ego.x, ego.y),
            must_change=None if change is None else _must_change(change[0], change[1] - place, intent, road_map),
            neighbours=with_roles(others, ego, intent.route, place, road_map),
            beside=tuple(_beside(lanes, others, ego, road_map)),
        )
    return scenes


def _must_change(lane: LaneId, room: float, intent: Intent, road_map: RoadMap) -> LaneChange:
    return LaneChange(lane, room, road_map.changes.action(intent.route, lane))


def _beside(
    lanes: Iterable[LaneId], others: Iterable[TrackedVehicle], ego: VehicleState, road_map: RoadMap
) -> Iterator[LaneNeighbour]:
    """Find the vehicles next ahead and next behind on each adjacent lane, before its beginning and past its end too."""
    for lane in lanes:
        nearest: dict[Role, tuple[float, str]] = {}
        for route, along in road_map.changes.routes_along(lane):
            there = [n for n in others if n.lane in along]
            road_map.project_all(route, [(ego.x, ego.y), *((n.x, n.y) for n in there)])
            place, _ = road_map.project(route, ego.x, ego.y)
            for n in there:
                ahead = road_map.project(route, n.x, n.y)[0] - place
                role = Role.LEADING if ahead > 0 else Role.REARING
                gap = max(abs(ahead) - (n.length + ego.length) / 2, 0.0)
                nearest[role] = min(nearest.get(role, (gap, n.id)), (gap, n.id))
        yield from (LaneNeighbour(name, lane, role, gap) for role, (gap, name) in nearest.items())


def with_roles(
    neighbours: Iterable[TrackedVehicle], ego: VehicleState, route: str, place: float, road_map: RoadMap
) -> tuple[TrackedVehicle, ...]:
    """Mark who drives ahead of the ego vehicle and who behind it on its lane.

    Args:
        place: Its arc length there [m].
    """
    others = tuple(neighbours)
    road_map.project_all(route, [(n.x, n.y) for n in others])
    roles = _roles(others, ego, route, place, road_map)
    wanted = ((n, *roles.get(n.id, NO_ROLE)) for n in others)
    return tuple(n if (n.role, n.gap) == (role, gap) else n.in_role(role, gap) for n, role, gap in wanted)


def _roles(
    others: Sequence[TrackedVehicle], ego: VehicleState, route: str, place: float, road_map: RoadMap
) -> dict[str, tuple[Role, float | None]]:
    """Return who drives next ahead and next behind on the ego vehicle's lane, and at which gap."""
    path = road_map.paths[route]
    nearest: dict[Role, tuple[float, str]] = {}
    for n in others:
        s, side = road_map.project(route, n.x, n.y)
        ahead: float | None = s - place
        if abs(side) > SAME_LANE or (n.heading is not None and cos(n.heading - path.place(s)[2]) <= ALIGNED):
            ahead = _merging(n, route, place, road_map)
        if ahead is None:
            continue
        role = Role.LEADING if ahead > 0 else Role.REARING
        gap = abs(ahead) - (n.length + ego.length) / 2
        if role not in nearest or gap < nearest[role][0]:
            nearest[role] = (gap, n.id)
    return {name: (role, gap) for role, (gap, name) in nearest.items()}


def _merging(n: TrackedVehicle, route: str, place: float, road_map: RoadMap) -> float | None:
    """Return how far ahead a vehicle drives that comes onto the ego vehicle's lane where ways merge, or may [m].

    Returns:
        Distance of the centres; negative behind; None if no way of it leads there, or if it is open who goes first.
    """
    found = [
        (there - zone.merge_j) - (place - zone.merge_i)
        for theirs, there in n.routes
        for zone in road_map.zones(route, theirs)
        if zone.merge_i is not None
        and zone.merge_j is not None
        and (is_behind(zone, place, there) or is_behind(zone.mirrored(), there, place))
    ]
    return min(found, key=abs, default=None)


def with_conflicts(scene: SceneDescription, conflicts: tuple[Conflict, ...], road_map: RoadMap) -> SceneDescription:
    """Mark the vehicles and lanes with which the ego vehicle is in conflict."""
    others = {c.other for c in conflicts}
    lanes = {road_map.lane_at(c.routes[1], road_map.zones(*c.routes)[c.zone].point_j) for c in conflicts}
    neighbours = tuple(
        n.in_role(Role.CONFLICT, n.gap) if n.id in others and n.role is Role.OTHER else n for n in scene.neighbours
    )
    return replace(scene, neighbours=neighbours, conflict_lanes=tuple(sorted(lanes)))


def adjacent_lanes(road_map: RoadMap, lane: LaneId) -> tuple[LaneId, ...]:
    """Return the lanes to the left and right of a lane that run its way."""
    start, end, index = lane
    return tuple(side for k in (-1, 1) if (side := (start, end, index + k)) in road_map.lanes)


def _neighbour(
    n: TrackedVehicle, intent: Intent | None, world: WorldState, tracking: Tracking, ego: str
) -> TrackedVehicle:
    # A vehicle that shares an intent has said that it is a CAV.
    kind = Kind.CAV if intent is not None else n.kind
    n = replace(n, told=world.told.get(n.id)) if world.told else n
    routes = tracking.places(ego, n, intent or world.way_of(n.id, n.speed), world.signals.get(n.id, ""))
    standing = tracking.standing(ego, n, world.time)
    motion = (n.x, n.y, n.speed, n.heading, n.acceleration, n.lane, n.length)
    return TrackedVehicle(n.id, kind, *motion, routes, intent, standing, told=n.told)
