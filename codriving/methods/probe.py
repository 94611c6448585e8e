"""A method asked once, at one moment: who goes first, and what a single CAV is to do."""

from collections.abc import Sequence

from codriving.datatypes.deliberation import Deliberation
from codriving.datatypes.driving_model import DrivingModel
from codriving.datatypes.parts import Method
from codriving.datatypes.situation import Decision, Situation
from codriving.datatypes.world import WorldState
from codriving.geometry.road_map import RoadMap
from codriving.methods.codriving import CoDriving
from codriving.reasoning.decision.rules import Decider, decide_one


class Probe:
    """Goes through the whole pipeline, but has only one CAV's decision made by the model.

    Args:
        method: The method; one that is not ``CoDriving`` decides for all CAVs.
    """

    def __init__(self, method: Method) -> None:
        self.method = method

    def act(self, road_map: RoadMap, model: DrivingModel, seed: int, world: WorldState) -> Deliberation:
        """Decide for every CAV on the road, as at the beginning of an episode.

        Raises:
            ModelUnavailableError: If a language model is asked and does not answer.
            ModelError: If it must not be used.
        """
        self.method.reset(road_map, model, seed)
        if isinstance(self.method, CoDriving):
            pipeline = self.method._pipeline
            pipeline.decider = _ForOne(pipeline.decider)
        return self.method.act(world)


class _ForOne(Decider):
    """Has another one decide for the CAV with the most conflicts; the rules decide for the others."""

    def __init__(self, decider: Decider) -> None:
        self.decider = decider

    def decide(self, situations: Sequence[Situation]) -> list[Decision]:
        """Return one decision a situation, in the same order."""
        chosen = max(situations, key=lambda s: (len(s.allowed) > 1, len(s.conflicts)))
        return [self.decider.decide([s])[0] if s is chosen else decide_one(s) for s in situations]
