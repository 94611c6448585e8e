"""Controls: codriving with one part taken for something plain, so that a table tells what that part is worth."""

from collections.abc import Mapping

from codriving.datatypes import DrivingModel, Road, RuleModel
from codriving.geometry import RoadMap
from codriving.methods.codriving import CoDriving
from codriving.reasoning import CdaLevel, Decider

CONTROL = "control"  # How the variant of every control begins, so that no table can show one as a method


class Control(CoDriving):
    """Codriving by its rules, without a memory, with another part in a slot."""

    def __init__(self, name: str, said: str, cda: CdaLevel, margin: float, decider: Decider | None) -> None:
        super().__init__(cda, RuleModel(), None, margin)
        self.name, self.said, self.decider = name, said, decider
        self.variant = CONTROL if self.variant == "full" else f"{CONTROL}/{self.variant}"

    def remark(self, road: Road, world: Mapping[str, str]) -> str:
        return f"{self.name}: a control and no method: {self.said}."

    def reset(self, road_map: RoadMap, model: DrivingModel, seed: int) -> None:
        """Fill the slots for a new episode."""
        super().reset(road_map, model, seed)
        if self.decider is not None:
            self.decider.reset(seed)
            self._pipeline.decider = self.decider
