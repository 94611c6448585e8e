"""The same CAV as if it had changed lanes already: what a lane change is judged by."""

from collections.abc import Iterable, Mapping
from dataclasses import replace

from codriving.datatypes.action import Action
from codriving.datatypes.conflict import Conflict
from codriving.datatypes.order import PassingOrder, Precedence
from codriving.datatypes.road import LaneId
from codriving.datatypes.scene_description import SceneDescription
from codriving.reasoning.conflicts import find_conflicts
from codriving.reasoning.safety.outlook import Outlook
from codriving.reasoning.sharing.scenes import with_conflicts, with_roles

SIDES: Mapping[Action, int] = {Action.LANE_LEFT: -1, Action.LANE_RIGHT: 1}
"""By how much a lane change changes the index of the lane."""


def lane_after(outlook: Outlook, action: Action) -> LaneId:
    """Return the lane to which a lane change leads."""
    start, end, index = outlook.scene.intent.target_lane
    return start, end, index + SIDES[action]


def beside(outlook: Outlook, action: Action) -> Outlook | None:
    """Return the view from the lane beside, at the same place and speed, the body still reaching onto the present lane.

    Each is worked out once.

    Returns:
        The view, with one action: to go on at the same speed. None if no route along that lane leads where the CAV
        goes.
    """
    if action not in outlook.sides:
        outlook.sides[action] = _look(outlook, action)
    return outlook.sides[action]


def _look(outlook: Outlook, action: Action) -> Outlook | None:
    road_map, scene = outlook.road_map, outlook.scene
    lane = lane_after(outlook, action)
    options = [
        name
        for name, side in road_map.changes.routes_beside(scene.intent.route, scene.intent.target_lane)
        if side == lane
    ]
    if not options:
        return None
    route = options[0]
    place, _ = road_map.project(route, scene.ego.x, scene.ego.y)
    there = replace(
        scene,
        intent=replace(scene.intent, route=route, target_lane=lane),
        place=place,
        neighbours=with_roles(scene.neighbours, scene.ego, route, place, road_map),
        covers=((scene.intent.route, scene.place),),
        must_change=None,
    )
    conflicts = find_conflicts(there, road_map) if outlook.minds_conflicts else ()
    there = with_conflicts(there, conflicts, road_map)
    own = outlook.others[scene.ego.id]
    moved = replace(own, routes=((route, place), *there.covers), intent=there.intent)
    k = outlook.actions.index(action)
    return replace(
        outlook,
        scene=there,
        conflicts=conflicts,
        order=_with_pairs(outlook, there, conflicts),
        others={**outlook.others, own.id: moved},
        actions=(Action.IDLE,),
        stops=outlook.stops[k : k + 1] - scene.place + place,
        goes=outlook.goes[k : k + 1] - scene.place + place,
        sides={},
    )


def _with_pairs(outlook: Outlook, there: SceneDescription, conflicts: Iterable[Conflict]) -> PassingOrder:
    """Complete the order by the pairs that meet only after the lane change: who is nearer to the zone goes first."""
    pairs = list(outlook.order.precedences)
    for c in conflicts:
        if all({p.first, p.second} != {c.ego, c.other} for p in pairs):
            zone = outlook.road_map.zones(*c.routes)[c.zone]
            ahead = zone.point_i - c.places[0] <= zone.point_j - c.places[1]
            first, second = (c.ego, c.other) if ahead else (c.other, c.ego)
            pairs.append(Precedence(first, second, f"{first} is nearer to where they meet"))
    return replace(outlook.order, precedences=tuple(pairs))
