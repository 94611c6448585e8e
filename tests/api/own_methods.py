"""Methods of a user's, in a module that worker processes can import."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from codriving.datatypes import Action, Deliberation, DrivingModel, Method, Model, WorldState
from codriving.geometry import RoadMap
from codriving.ordering import Instance, JointPlanner, Ordering, OrderRule, Request, in_order, repaired, schedule


@dataclass(frozen=True)
class Same(Deliberation):
    """One action for all."""

    world: WorldState
    action: Action
    counts: Mapping[str, float] = field(default_factory=dict)
    transcript: tuple[dict[str, Any], ...] = ()

    @property
    def actions(self) -> dict[str, Action]:
        return dict.fromkeys(self.world.deciding, self.action)

    def as_dict(self) -> dict[str, Any]:
        return {"time": self.world.time, "step": self.world.step}


class Steady(Method):
    """Does the same at each step."""

    name = "steady"

    def __init__(self, action: str = "SLOWER") -> None:
        self.action = Action[action]
        self.variant = "" if action == "SLOWER" else action.lower()

    def reset(self, road_map: RoadMap, model: DrivingModel, seed: int) -> None:
        """Nothing is remembered."""

    def act(self, world: WorldState) -> Same:
        return Same(world, self.action)


class Told(Steady):
    """Is handed the language model."""

    name = "told"

    def __init__(self, llm: Model) -> None:
        super().__init__()
        self.reasoner = llm.name


class Farthest(OrderRule):
    """The farthest goes first."""

    name = "farthest"
    variant = ""

    def reset(self, seed: int) -> None:
        """Nothing is remembered."""

    def order(self, instance: Instance, planner: JointPlanner) -> Ordering:
        ranked = sorted(instance.vehicles.values(), key=lambda e: (-e.distance, e.id))
        sequence = repaired(instance, [vehicle.id for vehicle in ranked])
        times = schedule(instance, sequence) or {name: instance.vehicles[name].eta for name in sequence}
        return Ordering(tuple(sequence), times)

    def grant(self, requests: Sequence[Request]) -> frozenset[str]:
        return in_order(requests)
