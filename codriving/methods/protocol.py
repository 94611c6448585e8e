"""What a method is: it is handed a world state and nothing else of the simulator."""

from typing import Protocol

from codriving.datatypes.driving_model import DrivingModel
from codriving.datatypes.world import WorldState
from codriving.geometry.road_map import RoadMap
from codriving.methods.deliberation import Deliberation


class Method(Protocol):
    """Decides for all CAVs, one decision step after another.

    Attributes:
        reasoner: Who reasons: ``rules`` or the name of a model.
    """

    name: str
    variant: str
    reasoner: str

    def reset(self, road_map: RoadMap, model: DrivingModel, seed: int) -> None:
        """Begin an episode; nothing is remembered from the one before."""
        ...

    def act(self, world: WorldState) -> Deliberation:
        """Decide for every CAV on the road."""
        ...
