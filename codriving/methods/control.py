"""Controls: codriving with one part taken for something plain, so that a table tells what that part is worth."""

from collections.abc import Mapping

from codriving.datatypes import DrivingModel, Road, RuleModel
from codriving.geometry import RoadMap
from codriving.methods.codriving import CoDriving
from codriving.reasoning import CdaLevel, Decider, OrderRule

CONTROL = "control"  # How the variant of every control begins, so that no table can show one as a method


class Control(CoDriving):
    """Codriving by its rules, without a memory, with another part in a slot."""

    def __init__(
        self,
        name: str,
        said: str,
        cda: CdaLevel,
        margin: float,
        order: OrderRule | None = None,
        decider: Decider | None = None,
        by_zone: bool = True,
    ) -> None:
        super().__init__(cda, RuleModel(), None, margin, order, by_zone)
        self.name, self.said, self.decider = name, said, decider
        # The name of a control of the order says which one it has.
        own = self.variant if decider is not None or self.knows_drivers else cda.variant
        self.variant = CONTROL if own == "full" else f"{CONTROL}/{own}"

    def remark(self, road: Road, world: Mapping[str, str]) -> str:
        return f"{self.name}: a control and no method: {self.said}."

    def reset(self, road_map: RoadMap, model: DrivingModel, seed: int) -> None:
        """Fill the slots for a new episode."""
        super().reset(road_map, model, seed)
        if self.decider is not None:
            self.decider.reset(seed)
            self.pipeline.decider = self.decider
