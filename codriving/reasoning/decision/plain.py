"""Decisions that need no model: nobody to consider, and nothing to weigh up."""

from math import cos, sin

from codriving.datatypes.action import Action
from codriving.datatypes.scene_description import Role, SceneDescription, TrackedVehicle
from codriving.datatypes.situation import Situation
from codriving.reasoning.decision.rules import EAGERNESS, decide_one

HORIZON = 10.0
"""How far ahead the progress of an action is predicted [s]."""

HEADWAY = 2.0
"""Whoever drives ahead is not to be considered if the CAV stays this far behind at least [s]."""


def is_plain(situation: Situation, sees_conflicts: bool) -> bool:
    """Whether a CAV has nobody to consider, and its best action is plain.

    It has nobody to consider if

    - it is in no conflict, however slight, and in no pair of the order;
    - whoever drives ahead of it on its lane is so far away that it stays 2 s behind for the next 10 s, the other one
      keeping its speed;
    - where conflicts cannot be seen, since intents are not shared: nobody is ahead of it, on whichever lane, as near as
      it gets within 10 s.

    Its best action is plain if every action along the lane is safe and keeps the order, it is on one lane only, its
    route asks for no lane change, and the rules say FASTER: no lane change would get it clearly farther either.
    """
    scene = situation.scene
    if situation.conflicts or scene.must_change is not None or scene.covers:
        return False
    if any(scene.ego.id in (p.first, p.second) for p in situation.order.precedences):
        return False
    along = [a for a in situation.assessments if a.action in EAGERNESS]
    if not all(a.safe and not a.reasons and a.progress is not None for a in along):
        return False
    reach = max((a.progress or 0.0 for a in along), default=0.0)
    if any(_catches_up(n, reach) or (not sees_conflicts and _is_ahead(scene, n, reach)) for n in scene.neighbours):
        return False
    return decide_one(situation).action is Action.FASTER


def _catches_up(n: TrackedVehicle, reach: float) -> bool:
    """Whether the CAV comes near a vehicle on its lane within the horizon, or is near it already."""
    if n.role is not Role.LEADING:
        return False
    gap, pace = n.gap or 0.0, reach / HORIZON
    return min(gap, gap + HORIZON * n.speed - reach) < HEADWAY * pace


def _is_ahead(scene: SceneDescription, n: TrackedVehicle, reach: float) -> bool:
    along = cos(scene.ego.heading) * (n.x - scene.ego.x) + sin(scene.ego.heading) * (n.y - scene.ego.y)
    return 0 < along <= reach
