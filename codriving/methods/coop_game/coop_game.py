"""The cooperative game: streams agree on the levels that are worth most to all together (Fang et al., 2024)."""

from collections.abc import Sequence
from itertools import islice

from codriving.datatypes.order import Instance
from codriving.errors import require, require_range
from codriving.methods.coop_game.coalition import Agreement, Coalition
from codriving.methods.coop_game.levels import Levels, Streams, find_streams, levels_of
from codriving.methods.coop_game.payoff import Goal, Payoff, Scale
from codriving.reasoning.ordering.protocol import JointPlanner, Ordering, OrderRule, Request, best_subset
from codriving.reasoning.ordering.schedule import timed
from codriving.reasoning.ordering.tickets import TicketBook, by_ticket, reasons


class CoopGame(OrderRule):
    """All CAVs form a coalition, and their streams take the levels that are worth most to all together.

    Without an agreement all would go first come, first served; that order is always among those evaluated.

    Args:
        objective: What is summed up: ``inverse_distance`` or ``utility``.
        scale: Which distances are put on the scale of the others: ``turning``, ``straight`` or ``none``.
        levels: The highest level, 1 to 20; None for as many as there are streams.
        hysteresis: The order of the step before stays unless another one is worth more than being this much ahead
            is worth to one vehicle, 0 to 10 [s].
        reference_acceleration: Acceleration that costs the whole weight of comfort, 0.1 to 20 [m/s2].
        risk_time: Gap in time at which the risk has fallen to 1/e, 0.1 to 10 [s].
        control_radius: Distance to the reference point from which on a vehicle holds a ticket, 1 to 1000 [m].

    Raises:
        ConfigError: If a setting is out of range.
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
        require_range("efficiency", efficiency, 0, 100)
        require_range("comfort", comfort, 0, 100)
        require_range("safety", safety, 0, 100)
        require_range("reference_acceleration", reference_acceleration, 0.1, 20, " m/s2")
        require_range("risk_time", risk_time, 0.1, 10, " s")
        some = efficiency + comfort + safety != 0
        require(some, "efficiency, comfort and safety must not all be 0, got 0, 0 and 0")
        self.payoff = Payoff(
            Goal(objective), Scale(scale), efficiency, comfort, safety, reference_acceleration, risk_time
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
        counts = {
            "orders": len(coalition.evaluated),
            "infeasible": sum(not a.plan.feasible for a in coalition.evaluated),
            "enumerated": int(enumerated),
            "fallback": int(not chosen.plan.feasible),
            "kept": int(kept),
            "worse_off": len(chosen.worse_off(alone)),
        }
        return self._ordering(instance, streams, chosen, counts)

    def grant(self, requests: Sequence[Request]) -> frozenset[str]:
        """Grant the requests that do not overlap and gain most together."""
        return best_subset(requests)

    def _as_before(self, arrived: Sequence[str]) -> list[str]:
        """Rank all as in the step before, and new ones behind them as they came."""
        there = [name for name in self._agreed if name in arrived]
        return there + [name for name in arrived if name not in there]

    def _search(self, coalition: Coalition, levels: Levels) -> bool:
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
                levels = f"level {level[one]}, that of {other} on {level[other]}"
                return f"all gain most with the stream of {one} on {levels}"
            if agreed:
                return f"all gain most if {one} goes before {other}"
            return by_ticket(one, other, self.tickets.held)

        return Ordering(self._agreed, timed(instance, self._agreed), reasons(instance, self._agreed, reason), counts)
