"""What decides and orders in tests of thinking time, and notes when it is asked."""

from collections.abc import Mapping, Sequence

from codriving.datatypes.order import Instance, Pair, PassingOrder
from codriving.datatypes.situation import Decision, Situation
from codriving.datatypes.world import Action
from codriving.reasoning.decision.rules import Decider
from codriving.reasoning.ordering.coordinator import Coordinator
from codriving.reasoning.ordering.protocol import JointPlanner, Ordering, OrderRule
from codriving.reasoning.perception import Moment


class Wishes(Decider):
    """Wants the same for all, whatever is allowed; notes for whom it decides each time."""

    def __init__(self, action: Action) -> None:
        self.action = action
        self.asked: list[list[str]] = []

    def decide(self, situations: Sequence[Situation]) -> list[Decision]:
        self.asked.append([s.scene.ego.id for s in situations])
        return [Decision(s.scene.ego.id, self.action, f"answer {len(self.asked)}") for s in situations]


class Told(Coordinator):
    """Gives one order after the other, the last one for ever; notes when it is asked."""

    def __init__(self, *orders: PassingOrder) -> None:
        self.orders = orders
        self.asked: list[float] = []

    def negotiate(self, moment: Moment, given: Mapping[Pair, str] | None = None) -> PassingOrder:
        self.asked.append(moment.time)
        return self.orders[min(len(self.asked), len(self.orders)) - 1]


class Backwards(OrderRule):
    """Lets who has the highest id go first; notes when it is asked."""

    name = "backwards"

    def reset(self, seed: int) -> None:
        self.asked: list[float] = []

    def order(self, instance: Instance, planner: JointPlanner) -> Ordering:
        self.asked.append(instance.time)
        ranking = sorted(instance.vehicles, reverse=True)
        return Ordering(tuple(ranking), {name: float(k) for k, name in enumerate(ranking)}, {}, {"asked": 1})
