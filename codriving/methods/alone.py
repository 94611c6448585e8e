"""Methods for a single vehicle: each CAV on its own, by what it sees; a driver decides, the rest is shared."""

from collections import Counter

from codriving.datatypes.action import Action
from codriving.datatypes.driving_model import DrivingModel
from codriving.datatypes.order import PassingOrder
from codriving.datatypes.situation import ActionAssessment, Decision, Situation
from codriving.datatypes.world import WorldState
from codriving.geometry.road_map import RoadMap
from codriving.methods.deliberation import Deliberation
from codriving.methods.perception import single_vehicle_perception
from codriving.prediction.forecast import Forecast
from codriving.reasoning.severity import SLOWEST
from codriving.single_vehicle.protocol import Choice, Driver, View


class Alone:
    """A method by which every CAV decides alone.

    Nothing is shared or negotiated: a CAV knows position, speed and heading of those around it, and the map.

    Args:
        driver: Decides for one CAV at a time.
    """

    reasoner = "none"

    def __init__(self, driver: Driver) -> None:
        self.driver = driver
        self.name, self.variant = driver.name, driver.variant

    def reset(self, road_map: RoadMap, model: DrivingModel, seed: int) -> None:
        """Begin an episode; nothing is remembered from the one before.

        Args:
            road_map: The precomputed road.
            model: How CAVs answer to actions.
            seed: Seed of the episode; nothing is drawn.
        """
        self._perception = single_vehicle_perception(road_map, Forecast(model))
        self.driver.reset()

    def act(self, world: WorldState) -> Deliberation:
        """Decide for every CAV on the road, one by one.

        Args:
            world: The world, of which each CAV sees its own part.
        """
        perception = self._perception
        perceived = perception.perceive(world)
        situations, decisions, counts = [], [], Counter[str]()
        for name, scene in perceived.scenes.items():
            view = View(
                scene,
                perceived.conflicts[name],
                world.available[name],
                perception.road_map,
                perception.forecast,
                world.time,
            )
            choice = self.driver.decide(view)
            situations.append(_situation(view, choice))
            decisions.append(Decision(name, choice.action, choice.reason))
            counts.update(choice.counts)
        return Deliberation(world.time, world.step, tuple(situations), tuple(decisions), dict(counts))


def _situation(view: View, choice: Choice) -> Situation:
    """Write down what a decision rests on, in the form in which every method's decisions are recorded."""
    name = view.scene.ego.id
    speeds = {n.id: n.speed for n in view.scene.neighbours}
    before = [p.first for p in choice.precedences if p.second == name]
    after = [p.second for p in choice.precedences if p.first == name]
    sequence = (*before, name, *after) if choice.precedences else ()
    return Situation(
        scene=view.scene,
        conflicts=view.conflicts,
        order=PassingOrder(sequence, choice.precedences),
        clear_times=tuple(
            max(c.exits[1], 0.0) / max(speeds[c.other], SLOWEST) if c.other in before else 0.0 for c in view.conflicts
        ),
        assessments=tuple(_assessment(action, choice) for action in view.actions),
    )


def _assessment(action: Action, choice: Choice) -> ActionAssessment:
    why = choice.refused.get(action, "")
    return ActionAssessment(action, not why, (why,) if why else (), (), None)
