"""Methods for a single vehicle: each CAV on its own, by what it sees; a driver decides, the rest is shared."""

from collections import Counter

from codriving.datatypes.deliberation import ReasonedDeliberation
from codriving.datatypes.driving_model import DrivingModel
from codriving.datatypes.parts import Method
from codriving.datatypes.situation import Decision
from codriving.datatypes.world import WorldState
from codriving.geometry.road_map import RoadMap
from codriving.methods.single_vehicle.account import account
from codriving.methods.single_vehicle.protocol import Driver, View
from codriving.reasoning.perception import single_vehicle_perception
from codriving.reasoning.prediction.forecast import Forecast


class Alone(Method):
    """A method by which every CAV decides alone.

    Nothing is shared or negotiated: a CAV knows position, speed and heading of those around it, and the map.
    """

    def __init__(self, driver: Driver) -> None:
        self.driver = driver
        self.name, self.variant = driver.name, driver.variant

    def reset(self, road_map: RoadMap, model: DrivingModel, seed: int) -> None:
        """Begin an episode; nothing is remembered from the one before."""
        self._perception = single_vehicle_perception(road_map, Forecast(model))
        self.driver.reset()

    def act(self, world: WorldState) -> ReasonedDeliberation:
        """Decide for every CAV on the road, one by one."""
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
            situations.append(account(view, choice))
            decisions.append(Decision(name, choice.action, choice.reason))
            counts.update(choice.counts)
        return ReasonedDeliberation(world.time, world.step, tuple(situations), tuple(decisions), dict(counts))
