"""A control: codriving that is told of each human driver what no vehicle can know, whether it gives way."""

from collections.abc import Mapping

from codriving.datatypes import Conflict, DrivingModel, Manner, TrackedVehicle
from codriving.geometry import RoadMap
from codriving.methods.control import Control
from codriving.reasoning import gives_way, known_to_give_way


class Oracle(Control):
    """Codriving that knows where it has to assume."""

    knows_drivers = True

    def reset(self, road_map: RoadMap, model: DrivingModel, seed: int) -> None:
        """Fill the slots for a new episode."""
        super().reset(road_map, model, seed)
        self._manners: Mapping[str, Manner] = {}
        self.pipeline.perception.gives_way = self._gives_way

    def be_told(self, manners: Mapping[str, Manner]) -> None:
        self._manners = manners

    def _gives_way(self, c: Conflict, human: TrackedVehicle, road_map: RoadMap) -> str:
        if human.id not in self._manners:
            return gives_way(c, human, road_map)
        return known_to_give_way(c, human, road_map, self._manners[human.id])
