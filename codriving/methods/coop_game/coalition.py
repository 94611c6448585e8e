"""The orders of one moment on which all vehicles may agree, each valued by what all would do in it."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

from codriving.datatypes.order import Instance
from codriving.methods.coop_game.levels import Allocation, Levels, Streams, is_free
from codriving.methods.coop_game.payoff import Payoff
from codriving.reasoning.ordering.protocol import JointPlan, JointPlanner
from codriving.reasoning.ordering.schedule import Objective, repaired, timed

TOLERANCE = 1e-9
"""Values that differ by less are equal."""


@dataclass(frozen=True)
class Agreement:
    """An order and what it is worth."""

    instance: Instance
    order: tuple[str, ...]
    levels: Allocation
    plan: JointPlan
    payoffs: dict[str, float]

    @cached_property
    def value(self) -> float:
        """What it is worth to all together; -inf if a vehicle has no plan that keeps clear of the others."""
        return sum(self.payoffs.values()) if self.plan.feasible else float("-inf")

    @cached_property
    def delay(self) -> float:
        """Time that all lose together, as scheduled [s]."""
        return Objective().value(self.instance, timed(self.instance, self.order))

    def better_than(self, other: "Agreement") -> bool:
        """Whether it is worth more; if both are worth the same, whether less time is lost, or the levels are lower.

        What all can keep is better than anything else; of two that some cannot keep, the one with fewer of these.
        """
        if not self.plan.feasible or not other.plan.feasible:
            return self.plan.feasible or (not other.plan.feasible and self.plan.stuck < other.plan.stuck)
        if abs(self.value - other.value) > TOLERANCE * max(1.0, abs(other.value)):
            return self.value > other.value
        if self.delay == other.delay:
            return self.levels < other.levels
        return self.delay < other.delay

    def worse_off(self, other: "Agreement") -> list[str]:
        """Return the vehicles that would rather have another agreement, by id."""
        return [n for n, was in sorted(other.payoffs.items()) if self.payoffs.get(n, was) < was - TOLERANCE]


class Coalition:
    """Evaluates orders, each of them once."""

    def __init__(
        self,
        instance: Instance,
        planner: JointPlanner,
        payoff: Payoff,
        streams: Streams,
        arrived: Sequence[str],
        limit: int,
    ) -> None:
        self.instance, self.planner, self.payoff = instance, planner, payoff
        self.streams, self.arrived, self.limit = streams, tuple(arrived), limit
        self._free = [(a, b) for k, a in enumerate(arrived) for b in arrived[:k] if is_free(instance, a, b)]
        self._known: dict[tuple[bool, ...], Agreement] = {}

    @property
    def evaluated(self) -> tuple[Agreement, ...]:
        """All agreements that have been evaluated, in that order."""
        return tuple(self._known.values())

    def evaluate(self, ranking: Sequence[str], levels: Allocation = ()) -> Agreement | None:
        """Evaluate a ranking of all vehicles.

        Orders in which the same vehicle of each pair goes first, wherever that is open, are one order.

        Returns:
            The agreement; None if it is a new one and the limit is reached.
        """
        order = tuple(repaired(self.instance, ranking))
        place = {name: k for k, name in enumerate(order)}
        key = tuple([place[a] < place[b] for a, b in self._free])
        if key not in self._known:
            if len(self._known) >= self.limit:
                return None
            plan = self.planner.plan(order)
            payoffs = self.payoff.of(self.instance, plan, self.planner) if plan.feasible else {}
            self._known[key] = Agreement(self.instance, order, levels, plan, payoffs)
        return self._known[key]

    def allocate(self, levels: Allocation) -> Agreement | None:
        """Evaluate an allocation of levels; None if it is a new one and the limit is reached."""
        return self.evaluate(self.streams.ranked(levels, self.arrived), levels)

    def ascend(self, starts: Sequence[Allocation], levels: Levels) -> None:
        """Give each stream in turn the level that is best for all, until nothing improves or the limit is reached."""
        current: Agreement | None = None
        for start in starts:
            found = self.allocate(start)
            if found is not None and (current is None or found.better_than(current)):
                current, allocation = found, start
        improved = current is not None
        while improved and current is not None:
            improved = False
            for stream in range(len(self.streams.names)):
                for moved in levels.moves(allocation, stream):
                    found = self.allocate(moved)
                    if found is None:
                        return
                    if found.better_than(current):
                        current, allocation, improved = found, moved, True
