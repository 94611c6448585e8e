"""The variables of DiLu's prompts: what one CAV sees, lane by lane and vehicle by vehicle."""

from math import atan2, degrees
from typing import Any

from codriving.datatypes.order import Conflict
from codriving.datatypes.situation import SceneDescription, Situation, TrackedVehicle
from codriving.datatypes.world import Action, DrivingModel
from codriving.geometry.road_map import RoadMap
from codriving.llm.prompts.free_text import Names, seen_names
from codriving.llm.prompts.variables import lane_views, side_name
from codriving.llm.prompts.views import MeaningView, SeenView, WayView
from codriving.reasoning.prediction.rollout import CHANGE

MOST = 6
"""Vehicles at most of which it is told where they are and which ways they may take."""

DIRECTIONS = (
    *("ahead", "ahead right", "to the right", "behind right"),
    *("behind", "behind left", "to the left", "ahead left"),
)
"""Words for eighths of a turn, clockwise from straight ahead."""


def seen_view(
    situation: Situation, road_map: RoadMap, driving: DrivingModel, nearest: int | None = None
) -> dict[str, Any]:
    """Return the variables that all of DiLu's prompts have.

    Args:
        nearest: Number of vehicles, nearest first, that are mentioned; None for all.
    """
    scene, names = situation.scene, seen_names(situation.scene)
    start, end, index = scene.ego.lane
    targets = _targets_after(driving, scene.ego.speed, scene.intent.target_speed)
    mentioned = scene.by_distance()[:nearest]
    lanes = lane_views(scene, mentioned, names)
    placed = {v.id for lane in lanes for v in (lane.leading, lane.rear) if v is not None}
    meets = {c.other: k for k, c in reversed(list(enumerate(situation.conflicts)))}
    # Those whose ways may meet come first, the most urgent of them before the others; the rest by distance.
    ranked = sorted(mentioned, key=lambda n: (meets.get(n.id, len(meets) + len(situation.conflicts)),))
    shown = [n for n in ranked if n.id in meets or names(n.id) not in placed][:MOST]
    return {
        "speed": scene.ego.speed,
        "target_speed": scene.intent.target_speed,
        "route": scene.intent.route,
        "lane_rank": index + 1,
        "lane_count": sum((a, b) == (start, end) for a, b, _ in road_map.lanes),
        "between_lanes": bool(scene.covers),
        "must_change": None if scene.must_change is None else side_name(scene, scene.must_change.lane),
        "room": 0.0 if scene.must_change is None else scene.must_change.room,
        "lanes": lanes,
        "vehicles": [_seen(situation, n, names) for n in shown],
        "actions": [MeaningView(str(a), targets.get(a)) for a in situation.allowed],
        "allowed": [str(a) for a in situation.allowed],
    }


def _seen(situation: Situation, n: TrackedVehicle, names: Names) -> SeenView:
    """Describe one vehicle; of each way that it may take, the most urgent place where that meets the CAV's."""
    scene = situation.scene
    ways: dict[str, Conflict] = {}
    for c in situation.conflicts:
        if c.other == n.id:
            ways.setdefault(c.routes[1], c)
    return SeenView(
        id=names(n.id),
        where=_direction(scene, n),
        distance=scene.distance(n),
        speed=n.speed,
        standing=n.standing,
        ways=_apart([_way(c) for c in ways.values()]),
        elsewhere=sum(route not in ways for route, _ in n.routes),
    )


def _apart(ways: list[WayView]) -> tuple[WayView, ...]:
    """Leave out ways that would read the same."""
    apart = {(w.relation, round(w.mine), round(w.its), round(w.dttcp, 1)): w for w in reversed(ways)}
    return tuple(w for w in ways if w in apart.values())


def _way(c: Conflict) -> WayView:
    return WayView(str(c.relation), *c.distances, *c.ttcp, c.dttcp, str(c.severity))


def _direction(scene: SceneDescription, n: TrackedVehicle) -> str:
    ahead, right = scene.offset(n)
    # The y axis points to the right of the x axis, so that angles grow clockwise.
    angle = degrees(atan2(right, ahead))
    return DIRECTIONS[round(angle / 45) % len(DIRECTIONS)]


def _targets_after(model: DrivingModel, speed: float, target: float) -> dict[Action, float]:
    """Return the target speed after each action along the lane [m/s].

    Args:
        speed: Speed now [m/s].
        target: Target speed now [m/s].
    """
    speeds = model.target_speeds
    top = len(speeds) - 1
    nearest = round(min(max((speed - speeds[0]) / (speeds[-1] - speeds[0]) * top, 0), top))
    stepped = {action: speeds[min(max(nearest + step, 0), top)] for action, step in CHANGE.items()}
    return {Action.SLOWER: stepped[Action.SLOWER], Action.IDLE: target, Action.FASTER: stepped[Action.FASTER]}
