"""The negotiation sub-module: one order for all, or each CAV's own (paper Section III-C.3 and IV-B)."""

from collections.abc import Mapping
from typing import Protocol

from codriving.datatypes.order import PassingOrder
from codriving.reasoning.ordering.coordinator import Coordinator
from codriving.reasoning.ordering.problem import Conflicts, Scenes


class Negotiation(Protocol):
    """Gives every CAV the order that it goes by."""

    def orders(self, scenes: Scenes, conflicts: Conflicts) -> Mapping[str, PassingOrder]:
        """Return the passing order of each CAV, by id."""
        ...


class AgreedOrder:
    """Agreement-seeking (class C) and prescriptive (class D): everybody goes by the coordinator's order."""

    def __init__(self, coordinator: Coordinator) -> None:
        self.coordinator = coordinator

    def orders(self, scenes: Scenes, conflicts: Conflicts) -> Mapping[str, PassingOrder]:
        """Return the same order for every CAV."""
        order = self.coordinator.negotiate(scenes, conflicts)
        return dict.fromkeys(scenes, order)
