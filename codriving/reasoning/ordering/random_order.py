"""A random passing order, the same for all CAVs and throughout an episode: a control, not a method."""

from collections.abc import Sequence

import numpy as np

from codriving.datatypes import Instance
from codriving.reasoning.ordering.protocol import JointPlanner, Ordering, OrderRule, Request, in_order
from codriving.reasoning.ordering.schedule import repaired, timed
from codriving.reasoning.ordering.tickets import reasons


class RandomOrder(OrderRule):
    """Draws a place in the order for each vehicle once; what is physically fixed comes before it."""

    name = "random"

    def reset(self, seed: int) -> None:
        """Begin an episode: the seed and the id of a vehicle tell its place, however many others there are."""
        self._seed = seed

    def order(self, instance: Instance, planner: JointPlanner) -> Ordering:
        """Return the order that was drawn, as far as what is physically fixed allows."""
        ranking = repaired(instance, sorted(instance.vehicles, key=self._place))
        why = reasons(instance, ranking, lambda one, other: f"{one} was drawn before {other}")
        return Ordering(tuple(ranking), timed(instance, ranking), why)

    def grant(self, requests: Sequence[Request]) -> frozenset[str]:
        """Grant the request of the CAV that was drawn first, then each next one that overlaps with none granted."""
        return in_order(sorted(requests, key=lambda request: self._place(request.ego)))

    def _place(self, name: str) -> tuple[float, str]:
        key = np.random.SeedSequence(entropy=self._seed, spawn_key=tuple(name.encode()))
        return float(np.random.default_rng(key).random()), name
