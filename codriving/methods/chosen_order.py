"""An order rule in the place of the negotiation: its order is what all CAVs of ``codriving`` agree on."""

from collections.abc import Mapping

from codriving.datatypes import Pair, PassingOrder
from codriving.protocol import with_given
from codriving.reasoning import (
    HEADWAY,
    PAD,
    Coordinator,
    Executor,
    JointPlanner,
    JointPlans,
    Moment,
    OrderRule,
    agreement,
    pose,
)


class ChosenOrder(Coordinator):
    """Hands a rule the problem that the negotiation solves, and writes its order down as the negotiation does.

    What a rule grants or holds back beyond an order, lane changes and earliest times, is left to the pipeline.
    """

    def __init__(self, rule: OrderRule, binding: bool, margin: float, executor: Executor | None = None) -> None:
        self.rule, self.binding, self.margin = rule, binding, margin
        self.executor = executor  # What drives by the order, if that is not the pipeline

    def negotiate(self, moment: Moment, given: Mapping[Pair, str] | None = None) -> PassingOrder:
        """Return the order of the rule, and who of a CAV and a human driver goes first in its schedule."""
        given = given or {}
        problem = with_given(pose(moment) if self.executor is None else pose(moment, self.executor.gap), given)
        # For rules that look at plans: with the margins of the pipeline, or those of the executor.
        planner: JointPlanner = JointPlans(moment, {}, self.margin, PAD, HEADWAY)
        if self.executor is not None:
            planner = self.executor.planner(moment)
        ordering = self.rule.order(problem.instance, planner)

        def reason(first: str, second: str) -> str:
            return given.get((first, second)) or ordering.reason(first, second)

        return agreement(moment, problem, ordering.times, reason, self.binding)


def order_variant(cda: str, rule: OrderRule | None) -> str:
    """Name a variant of ``codriving`` for tables: what is removed from its reasoning, and by what rule it orders."""
    if rule is None:
        return cda
    order = "/".join(word for word in (rule.chosen_as or rule.name, rule.variant) if word)
    return "/".join([*([cda] if cda != "full" else []), f"order={order}"])
