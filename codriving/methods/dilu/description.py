"""Describe: a situation from what one CAV sees alone and the map; rules and language models get the same."""

from dataclasses import replace

from codriving.datatypes.order import PassingOrder
from codriving.datatypes.road import LaneId
from codriving.datatypes.situation import ActionAssessment, SceneDescription, Situation
from codriving.methods.single_vehicle.lane_choice import look
from codriving.reasoning.perception import Moment
from codriving.reasoning.safety.safety_input import SIDES


def describe_alone(moment: Moment, ego: str) -> Situation:
    """Describe what one CAV sees, without an order and without a check of the actions."""
    return Situation(
        scene=placed(moment, ego),
        conflicts=moment.conflicts[ego],
        order=PassingOrder((), ()),
        # Which vehicle passes when is for the reasoner to find out.
        clear_times=(float("inf"),) * len(moment.conflicts[ego]),
        assessments=tuple(ActionAssessment(action, True, (), (), None) for action in moment.available[ego]),
    )


def placed(moment: Moment, ego: str) -> SceneDescription:
    """Return the scene in which those next ahead and behind on the lanes beside are put onto these lanes.

    That is read off where they are and what the map says, since other vehicles share no lane with a vehicle on its own.
    """
    scene = moment.scenes[ego]
    lanes: dict[str, LaneId] = {}
    for action in (a for a in SIDES if a in moment.available[ego]):
        side = look(moment, ego, action, 0.0)
        if side is not None:
            lanes.update({n.id: side.lane for n in (side.ahead, side.behind) if n is not None})
    if not lanes:
        return scene
    return replace(scene, neighbours=tuple(replace(n, lane=lanes.get(n.id)) for n in scene.neighbours))
