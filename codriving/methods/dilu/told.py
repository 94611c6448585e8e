"""Describe: what one CAV is told, from what it sees alone and the map; rules and language models get the same."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

from codriving.datatypes.action import Action
from codriving.datatypes.driving_model import DrivingModel
from codriving.datatypes.order import PassingOrder
from codriving.datatypes.road import LaneId
from codriving.datatypes.scene_description import SceneDescription
from codriving.datatypes.situation import ActionAssessment, Situation
from codriving.methods.single_vehicle.lane_choice import look
from codriving.reasoning.moment import Moment
from codriving.reasoning.prediction.rollout import CHANGE
from codriving.reasoning.safety.safety_input import SIDES


@dataclass(frozen=True, slots=True)
class Told:
    """What one CAV is told.

    Attributes:
        targets: Target speed after each action along the lane [m/s].
    """

    moment: Moment
    ego: str
    situation: Situation
    lane: tuple[int, int]
    targets: Mapping[Action, float]


def tell(moment: Moment, ego: str) -> Told:
    """Describe what one CAV sees."""
    scene = placed(moment, ego)
    situation = Situation(
        scene=scene,
        conflicts=moment.conflicts[ego],
        order=PassingOrder((), ()),
        # Who passes when is for whoever reasons to find out.
        clear_times=(float("inf"),) * len(moment.conflicts[ego]),
        assessments=tuple(ActionAssessment(action, True, (), (), None) for action in moment.available[ego]),
    )
    start, end, index = scene.ego.lane
    count = sum((a, b) == (start, end) for a, b, _ in moment.road_map.lanes)
    targets = targets_after(moment.forecast.model, scene.ego.speed, scene.intent.target_speed)
    return Told(moment, ego, situation, (index + 1, count), targets)


def placed(moment: Moment, ego: str) -> SceneDescription:
    """Return the scene in which those next ahead and behind on the lanes beside are put onto these lanes.

    That is read off where they are and what the map says, since a vehicle on its own is told nobody's lane.
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


def targets_after(model: DrivingModel, speed: float, target: float) -> dict[Action, float]:
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
