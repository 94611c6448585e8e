"""What all rules that search for the best order do between two steps: keep the order unless another one saves time."""

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence

from codriving.datatypes.ordering_problem import Instance
from codriving.errors import ConfigError
from codriving.methods.order_search.coded import Coded
from codriving.methods.order_search.tree_search import Found
from codriving.reasoning.ordering.objective import Objective
from codriving.reasoning.ordering.protocol import JointPlanner, Ordering
from codriving.reasoning.ordering.reasons import reasons
from codriving.reasoning.ordering.request import Request, best_subset
from codriving.reasoning.ordering.schedule import repaired, timed
from codriving.reasoning.ordering.slots import carried_over, inserted, sequence
from codriving.reasoning.ordering.tickets import TicketBook


class SearchedOrder(ABC):
    """An order rule that searches at each step.

    The orders of FCFS, of iDFST and of the last step are the seeds. The order of the last step stays unless the search
    finds one that is better by more than the hysteresis, or unless it has become impossible.

    Args:
        hysteresis: J that another order must save to be taken, 0 to 10 [s].

    Raises:
        ConfigError: If a value is out of range.
    """

    name: str
    variant: str

    def __init__(self, hysteresis: float, evacuation_weight: float, fairness: Mapping[str, float] | None) -> None:
        if not 0 <= hysteresis <= 10:
            raise ConfigError(f"hysteresis must be 0 to 10 s, got {hysteresis:g}")
        self.hysteresis, self.objective = hysteresis, Objective(evacuation_weight, fairness)
        self.tickets = TicketBook()
        self.variant: str = self.objective.variant
        self.reset(0)

    def reset(self, seed: int) -> None:
        """Begin an episode: there is no order yet."""
        self.tickets.reset()
        self.seed, self.calls = seed, 0
        self.previous: tuple[str, ...] = ()

    def order(self, instance: Instance, planner: JointPlanner) -> Ordering:
        """Return the best order that is found."""
        self.calls += 1
        arrival = self.tickets.ranking(instance)
        seeds = [arrival, sequence(instance, inserted(instance, arrival, {}))]
        kept = carried_over(instance, self.previous, arrival)
        if self.previous:
            seeds.append(kept or repaired(instance, _up_to_date(self.previous, arrival)))
        problem = Coded(instance, self.objective)
        found = self.search(problem, seeds)
        order, keeps = found.order, False
        if kept is not None and problem.cost(problem.run(kept)) <= found.cost + self.hysteresis:
            order, keeps = tuple(kept), tuple(kept) != found.order
        self.previous = order
        times = timed(instance, order)
        return Ordering(
            order,
            times,
            reasons(instance, order, lambda one, other: _reason(times, found, keeps, one, other)),
            {"orders_tried": found.tried, "all_orders_tried": int(found.complete), "order_kept": int(keeps)},
        )

    @abstractmethod
    def search(self, problem: Coded, seeds: Sequence[Sequence[str]]) -> Found:
        """Return the best order that is found."""

    def grant(self, requests: Sequence[Request]) -> frozenset[str]:
        """Grant the requests that do not overlap and gain most together."""
        return best_subset(requests)


def _up_to_date(previous: Sequence[str], arrival: Sequence[str]) -> list[str]:
    there = set(arrival)
    kept = [name for name in previous if name in there]
    return kept + [name for name in arrival if name not in set(kept)]


def _reason(times: Mapping[str, float], found: Found, keeps: bool, one: str, other: str) -> str:
    passes = f"{one} passes in {times[one]:.1f} s and {other} in {times[other]:.1f} s"
    if keeps:
        return f"{passes} in the order kept from before, since no other one saves enough time"
    which = "of all orders" if found.complete else f"of {found.tried} orders tried"
    return f"{passes} in the one that costs everybody together least time {which}"
