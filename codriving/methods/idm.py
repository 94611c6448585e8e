"""No method at all: every CAV drives as an attentive human driver does, by IDM and the right of way."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from codriving.datatypes import Action, Deliberation, DrivingModel, Method, Road, WorldState
from codriving.geometry import RoadMap
from codriving.methods.control import CONTROL


@dataclass(frozen=True, slots=True)
class Undecided(Deliberation):
    """A step in which nothing is decided."""

    world: WorldState
    counts: Mapping[str, float]

    @property
    def actions(self) -> dict[str, Action]:
        return {}

    def as_dict(self) -> dict[str, Any]:
        why = "drives as a human driver does, by IDM and the right of way"
        scenes = {cav.id: {"intent": {"route": self.world.intents[cav.id].route}} for cav in self.world.cavs}
        cavs = [{"id": name, "action": "", "reason": why, "scene": scene} for name, scene in scenes.items()]
        return {"time": self.world.time, "step": self.world.step, "cavs": cavs}


class Idm(Method):
    """A control: no decisions, no cooperation."""

    name, variant, hands_over = "idm", CONTROL, True

    def remark(self, road: Road, world: Mapping[str, str]) -> str:
        return f"{self.name}: a control and no method: all CAVs drive as attentive human drivers do."

    def reset(self, road_map: RoadMap, model: DrivingModel, seed: int) -> None:
        """Begin an episode."""

    def act(self, world: WorldState) -> Undecided:
        """Decide nothing."""
        return Undecided(world, {})
