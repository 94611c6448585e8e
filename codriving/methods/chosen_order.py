"""An order rule in the place of the negotiation: its order is what all CAVs of ``codriving`` agree on."""

from codriving.datatypes import PassingOrder
from codriving.reasoning import HEADWAY, PAD, Coordinator, JointPlans, Moment, OrderRule, agreement, pose


class ChosenOrder(Coordinator):
    """Hands a rule the problem that the negotiation solves, and writes its order down as the negotiation does.

    What a rule grants or holds back beyond an order, lane changes and earliest times, is left to the pipeline.
    """

    def __init__(self, rule: OrderRule, binding: bool, margin: float) -> None:
        self.rule, self.binding, self.margin = rule, binding, margin

    def negotiate(self, moment: Moment) -> PassingOrder:
        """Return the order of the rule, and who of a CAV and a human driver goes first in its schedule."""
        problem = pose(moment)
        # For rules that look at plans: with the margins of the pipeline.
        planner = JointPlans(moment, {}, self.margin, PAD, HEADWAY)
        ordering = self.rule.order(problem.instance, planner)
        return agreement(moment, problem, ordering.times, ordering.reason, self.binding)


def order_variant(cda: str, rule: OrderRule | None) -> str:
    """Name a variant of ``codriving`` for tables: what is removed from its reasoning, and by what rule it orders."""
    if rule is None:
        return cda
    order = "/".join(word for word in (rule.chosen_as or rule.name, rule.variant) if word)
    return "/".join([*([cda] if cda != "full" else []), f"order={order}"])
