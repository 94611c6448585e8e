"""Second layer: a lane change must not collide with the vehicles of the adjacent lane (Section III-C.4)."""

from codriving.datatypes.action import Action
from codriving.datatypes.road import LaneId
from codriving.datatypes.scene_description import Neighbour
from codriving.reasoning.safety.outlook import Outlook

MARGIN = 2.0
"""Free distance to keep to both sides [m]."""

HEADWAY = 0.5
"""Time gap to keep to both sides [s]."""

COMFORT = 4.0
"""Braking that the one behind may be asked for [m/s2]."""


def check_adjacent(outlook: Outlook) -> dict[Action, list[str]]:
    """Remove lane changes into gaps in which the one behind could not brake in time.

    Args:
        outlook: The CAV's view.

    Returns:
        Reasons by action; no entry where the action is safe.
    """
    start, end, index = outlook.scene.ego.lane
    found: dict[Action, list[str]] = {}
    for action, side in ((Action.LANE_LEFT, -1), (Action.LANE_RIGHT, 1)):
        if action not in outlook.actions:
            continue
        lane: LaneId = (start, end, index + side)
        reasons = [_too_close(outlook, n) for n in outlook.scene.neighbours if n.lane in (lane, None)]
        reasons = [reason for reason in reasons if reason]
        if reasons:
            found[action] = [f"adjacent lane: {reason}" for reason in reasons]
    return found


def _too_close(outlook: Outlook, n: Neighbour) -> str:
    path = outlook.road_map.paths[outlook.scene.intent.route]
    s, _ = path.project(n.x, n.y)
    ego = outlook.scene.ego
    gap = abs(s - outlook.scene.place) - (n.length + ego.length) / 2
    front, back = (n.speed, ego.speed) if s > outlook.scene.place else (ego.speed, n.speed)
    needed = MARGIN + HEADWAY * back + max(0.0, (back**2 - front**2) / (2 * COMFORT))
    return "" if gap >= needed else f"{n.id} is {max(gap, 0.0):.0f} m away there, {needed:.0f} m are needed"
