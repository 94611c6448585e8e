"""The cooperative game: streams agree on the levels that are worth most to all together (Fang et al., 2024)."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import islice

from codriving.datatypes import Instance
from codriving.errors import require, require_range
from codriving.methods.coop_game.levels import Allocation, OwnLevels, Streams, find_streams, is_free, levels_of
from codriving.methods.coop_game.payoff import Goal, Payoff, Scale
from codriving.reasoning import (
    JointPlan,
    JointPlanner,
    Objective,
    Ordering,
    OrderRule,
    TicketBook,
    by_ticket,
    reasons,
    repaired,
    timed,
)

TOLERANCE = 1e-9  # Values that differ by less are equal


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
        return (self.delay, self.levels) < (other.delay, other.levels)

    def worse_off(self, other: "Agreement") -> list[str]:
        """Return the vehicles that would rather have another agreement, by id."""
        return [n for n, was in sorted(other.payoffs.items()) if self.payoffs.get(n, was) < was - TOLERANCE]


@dataclass(eq=False)
class Coalition:
    """Evaluates orders, each of them once."""

    instance: Instance
    planner: JointPlanner
    payoff: Payoff
    streams: Streams
    arrived: Sequence[str]
    limit: int

    def __post_init__(self) -> None:
        pairs = ((a, b) for k, a in enumerate(self.arrived) for b in self.arrived[:k])
        self._free = [pair for pair in pairs if is_free(self.instance, *pair)]
        self._known: dict[tuple[bool, ...], Agreement] = {}

    @property
    def evaluated(self) -> tuple[Agreement, ...]:
        """All agreements that have been evaluated, in that order."""
        return tuple(self._known.values())

    def evaluate(self, ranking: Sequence[str], levels: Allocation = ()) -> Agreement | None:
        """Evaluate a ranking of all vehicles.

        Orders in which the same vehicle of each pair goes first, wherever that is open, are one order.
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

    def ascend(self, starts: Sequence[Allocation], levels: OwnLevels) -> None:
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


class CoopGame(OrderRule):
    """All CAVs form a coalition, and their streams take the levels that are worth most to all together.

    Without an agreement all would go first come, first served; that order is always among those evaluated.
    """

    name = "coop_game"

    def __init__(
        self,
        objective: str,
        scale: str,
        levels: int | None,
        evaluations: int,
        hysteresis: float,
        rational: bool,
        efficiency: float,
        comfort: float,
        safety: float,
        reference_acceleration: float,
        risk_time: float,
        control_radius: float,
    ) -> None:
        require(objective in list(Goal), f"objective must be {' or '.join(Goal)}, got {objective}")
        require(scale in list(Scale), f"scale must be {' or '.join(Scale)}, got {scale}")
        require_range("levels", 1 if levels is None else levels, 1, 20)
        require_range("evaluations", evaluations, 2, 10000)
        require_range("hysteresis", hysteresis, 0, 10, " s")
        weights = {"efficiency": efficiency, "comfort": comfort, "safety": safety}
        for name, weight in weights.items():
            require_range(name, weight, 0, 100)
        require_range("reference_acceleration", reference_acceleration, 0.1, 20, " m/s2")
        require_range("risk_time", risk_time, 0.1, 10, " s")
        require(sum(weights.values()) != 0, "efficiency, comfort and safety must not all be 0, got 0, 0 and 0")
        self.payoff = Payoff(
            Goal(objective), Scale(scale), **weights, reference_acceleration=reference_acceleration, risk_time=risk_time
        )
        self.levels, self.evaluations, self.hysteresis, self.rational = levels, evaluations, hysteresis, rational
        self.tickets = TicketBook(control_radius)
        self._agreed: tuple[str, ...] = ()
        words = [] if levels is None else [f"levels={levels}"]
        words += [] if self.payoff.objective is Goal.INVERSE_DISTANCE else [str(self.payoff.objective)]
        words += [] if self.payoff.scale is Scale.TURNING else [f"scale={self.payoff.scale}"]
        self.variant: str = ", ".join([*words, "rational"] if rational else words)

    def reset(self, seed: int) -> None:
        """Begin an episode; nothing is remembered from the one before."""
        self.tickets.reset()
        self._agreed = ()

    def order(self, instance: Instance, planner: JointPlanner) -> Ordering:
        """Return the order on which all agree."""
        arrived = self.tickets.ranking(instance)
        streams = find_streams(instance, arrived)
        if not streams.conflicts:
            # No pair is open: there is but one order, and nothing to agree on.
            self._agreed = tuple(arrived)
            return self._ordering(instance, streams, None, {"orders": 0})
        coalition = Coalition(instance, planner, self.payoff, streams, arrived, self.evaluations)
        alone = coalition.evaluate(arrived)
        before = coalition.evaluate(self._as_before(arrived)) if self._agreed else None
        enumerated = self._search(coalition, levels_of(len(streams.names), streams.conflicts, self.levels))
        assert alone is not None
        best = self._best(coalition.evaluated, alone)
        kept = before is not None and self._keeps(before, best, alone, planner)
        chosen = before if kept and before is not None else best
        self._agreed = chosen.order
        infeasible, worse_off = sum(not a.plan.feasible for a in coalition.evaluated), len(chosen.worse_off(alone))
        counts = {"orders": len(coalition.evaluated), "infeasible": infeasible, "enumerated": int(enumerated)}
        counts |= {"fallback": int(not chosen.plan.feasible), "kept": int(kept), "worse_off": worse_off}
        return self._ordering(instance, streams, chosen, counts)

    def _as_before(self, arrived: Sequence[str]) -> list[str]:
        """Rank all as in the step before, and new ones behind them as they came."""
        there = [name for name in self._agreed if name in arrived]
        return there + [name for name in arrived if name not in there]

    def _search(self, coalition: Coalition, levels: OwnLevels) -> bool:
        """Evaluate all allocations if they are few enough, else climb; return whether it was all."""
        some = list(islice(levels.allocations(), self.evaluations + 1))
        if len(some) <= self.evaluations:
            return None not in [coalition.allocate(allocation) for allocation in some]
        place = {name: k for k, name in enumerate(self._as_before(coalition.arrived))}
        before = [min(place[name] for name in members) for members in coalition.streams.members.values()]
        coalition.ascend([levels.of(range(levels.streams)), levels.of(before)], levels)
        return False

    def _best(self, evaluated: Sequence[Agreement], alone: Agreement) -> Agreement:
        """Return the best agreement; if none can be kept, one that the fewest vehicles cannot keep."""
        best = alone
        for found in evaluated:
            if found.better_than(best) and not (self.rational and found.worse_off(alone)):
                best = found
        return best

    def _keeps(self, before: Agreement, best: Agreement, alone: Agreement, planner: JointPlanner) -> bool:
        """Whether the order of the step before stays, since another one is not worth enough more."""
        if not before.plan.feasible or (self.rational and before.worse_off(alone)):
            return False
        gain = self.payoff.gain(before.instance, before.plan, planner, before.payoffs, self.hysteresis)
        return best.value <= before.value + gain

    def _ordering(
        self, instance: Instance, streams: Streams, chosen: Agreement | None, counts: dict[str, int]
    ) -> Ordering:
        level = streams.by_vehicle(chosen.levels) if chosen is not None and chosen.levels else {}
        agreed = chosen is not None and chosen.plan.feasible and not level

        def reason(one: str, other: str) -> str:
            if level and level[one] < level[other]:
                levels = f"the stream of {one} on level {level[one]}, that of {other} on {level[other]}"
                return f"all gain most with {levels}"
            if agreed:
                return f"all gain most if {one} goes before {other}"
            return by_ticket(one, other, self.tickets.held)

        return Ordering(self._agreed, timed(instance, self._agreed), reasons(instance, self._agreed, reason), counts)
