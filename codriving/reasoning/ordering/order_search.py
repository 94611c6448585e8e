"""What rules that search for the best order share: the instance in numbers, and when the last order is kept."""

from abc import abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import isfinite

from codriving.datatypes import Instance
from codriving.errors import require_range
from codriving.reasoning.ordering.protocol import JointPlanner, Ordering, OrderRule
from codriving.reasoning.ordering.schedule import (
    LONGEST_WAIT,
    Objective,
    after_windows,
    carried_over,
    inserted,
    left,
    repaired,
    sequence,
    timed,
)
from codriving.reasoning.ordering.tickets import TicketBook, reasons

PACE = 5.0  # What a second of hysteresis counts as in plans [m/s]


@dataclass(frozen=True, slots=True)
class Found:
    """What a search has found."""

    order: tuple[str, ...]
    cost: float  # Its J [s]
    tried: int
    complete: bool  # Whether every order was tried or shown to be no better


class SearchedOrder(OrderRule):
    """An order rule that searches at each step.

    The seeds are the order of tickets, that of the earliest free slots, and that of the last step, which stays unless
    the search finds one that is better by more than the hysteresis, or unless it has become impossible.
    Where CAVs may pass zone by zone, the plans of the executor choose among the seeds and what the search finds.
    """

    def __init__(
        self, hysteresis: float = 0.3, evacuation_weight: float = 0.0, fairness: Mapping[str, float] | None = None
    ) -> None:
        require_range("hysteresis", hysteresis, 0, 10, " s")
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
            there = [name for name in self.previous if name in set(arrival)]
            seeds.append(kept or repaired(instance, there + [name for name in arrival if name not in set(there)]))
        problem = Coded(instance, self.objective)
        found = self.search(problem, seeds)
        order, keeps = found.order, False
        if instance.zones:
            # The schedule is a model: here, of the orders that it leads to, the plans say which one is the best.
            order = self._best_driven(planner, [order, *map(tuple, seeds)], kept)
            keeps = kept is not None and order == tuple(kept) and order != found.order
        elif kept is not None and problem.cost(problem.run(kept)) <= found.cost + self.hysteresis:
            order, keeps = tuple(kept), tuple(kept) != found.order
        self.previous = order
        times = timed(instance, order)

        def reason(one: str, other: str) -> str:
            passes = f"{one} passes in {times[one]:.1f} s and {other} in {times[other]:.1f} s"
            if keeps:
                return f"{passes} in the order kept from before, since no other one is enough better"
            which = "of all orders" if found.complete else f"of {found.tried} orders tried"
            return f"{passes} in the one that costs all together least time {which}"

        counts = {"orders_tried": found.tried, "all_orders_tried": int(found.complete), "order_kept": int(keeps)}
        return Ordering(order, times, reasons(instance, order, reason), counts)

    def _best_driven(
        self, planner: JointPlanner, orders: Sequence[tuple[str, ...]], kept: Sequence[str] | None
    ) -> tuple[str, ...]:
        """Return the order with which CAVs get farthest by the plans that the executor makes of it."""

        def standing(order: tuple[str, ...]) -> tuple[int, float]:
            plan = planner.plan(order)
            is_kept = kept is not None and order == tuple(kept)
            return -plan.stuck, plan.worth + (PACE * self.hysteresis if is_kept else 0.0)

        return max(dict.fromkeys(orders), key=standing)

    @abstractmethod
    def search(self, problem: "Coded", seeds: Sequence[Sequence[str]]) -> Found:
        """Return the best order that is found."""


@dataclass(slots=True)
class Prefix:
    """The first vehicles of an order, scheduled. It knows all that the rest of the order depends on."""

    order: list[int]
    waiting: list[int]
    mask: int
    earliest: list[float]  # When each vehicle can pass at the earliest given those placed, by number [s]
    delay: float  # Weighted delay of those placed [s]
    finish: float  # When the last of those placed has left its zones [s]
    shut: list[list[tuple[float, float]]]  # When each vehicle must not pass, by number [s]

    def copy(self) -> "Prefix":
        """Return a prefix of its own."""
        shut = [spans[:] for spans in self.shut]
        return Prefix(self.order[:], self.waiting[:], self.mask, self.earliest[:], self.delay, self.finish, shut)


class Coded:
    """An instance with its objective; vehicles are numbered by id.

    Attributes:
        eta: Earliest arrival, by number [s].
    """

    def __init__(self, instance: Instance, objective: Objective) -> None:
        self.names = sorted(instance.vehicles)
        self._number = {name: k for k, name in enumerate(self.names)}
        self._entrants = [instance.vehicles[name] for name in self.names]
        self.eta = [e.eta for e in self._entrants]
        self._base = [e.eta if isfinite(e.eta) else 0.0 for e in self._entrants]
        self._weights = [objective.weight(e.id) if isfinite(e.eta) else 0.0 for e in self._entrants]
        self._windows = [joined(e.windows, e.eta) for e in self._entrants]
        self._share = objective.evacuation_weight
        self._held = [0] * len(self.names)
        self._followers: list[list[tuple[int, float]]] = [[] for _ in self.names]
        self._either: list[list[tuple[int, tuple[tuple[float, float], ...]]]] = [[] for _ in self.names]
        for first, second in instance.before:
            if first in self._number and second in self._number:
                self._held[self._number[second]] |= 1 << self._number[first]
        for (first, second), apart in instance.separation.items():
            if first in self._number and second in self._number:
                k, j = self._number[first], self._number[second]
                if (first, second) in instance.zones:
                    self._either[k].append((j, instance.zones[first, second]))
                else:
                    self._followers[k].append((j, apart))

    def root(self) -> Prefix:
        """Return the empty prefix."""
        finish = max((left(e, e.eta) for e in self._entrants), default=0.0)
        earliest = [after_windows(eta, spans) for eta, spans in zip(self.eta, self._windows, strict=True)]
        count, shut = len(self.names), [list(spans) for spans in self._windows]
        return Prefix([], list(range(count)), (1 << count) - 1, earliest, 0.0, finish, shut)

    def candidates(self, prefix: Prefix) -> list[int]:
        """Return the vehicles that can be next: those that no waiting one precedes, and all if there are none."""
        held, mask = self._held, prefix.mask
        return [k for k in prefix.waiting if not held[k] & mask] or prefix.waiting[:]

    def place(self, prefix: Prefix, number: int) -> None:
        """Let a vehicle be the next one of an order."""
        earliest, shut, time = prefix.earliest, prefix.shut, prefix.earliest[number]
        prefix.order.append(number)
        prefix.waiting.remove(number)
        prefix.mask ^= 1 << number
        late = time - self._base[number]
        prefix.delay += self._weights[number] * (late if late < LONGEST_WAIT else LONGEST_WAIT)
        if self._share:
            prefix.finish = max(prefix.finish, left(self._entrants[number], time))
        for other, apart in self._followers[number]:
            if time + apart > earliest[other] and prefix.mask >> other & 1:
                earliest[other] = after_windows(time + apart, shut[other])
        for other, spans in self._either[number]:
            if prefix.mask >> other & 1:
                closed, now = shut[other], earliest[other]
                hit = False
                for before, after in spans:
                    closed.append((time - before, time + after))
                    hit = hit or time - before < now < time + after
                if hit:
                    earliest[other] = after_windows(now, closed)

    def complete(self, prefix: Prefix, heuristic: float, draw: Callable[[], float]) -> tuple[Prefix, list[int]]:
        """Complete an order by chance and rule of thumb; most of the time of a search is spent here."""
        whole, held, eta = prefix.copy(), self._held, self.eta
        earliest, waiting, place, chosen = whole.earliest, whole.waiting, self.place, list[int]()
        while waiting:
            mask = whole.mask
            options = [k for k in waiting if not held[k] & mask] or waiting
            number = options[0]
            if len(options) > 1:
                if draw() < heuristic:
                    for k in options:
                        if earliest[k] < earliest[number] or (earliest[k] == earliest[number] and eta[k] < eta[number]):
                            number = k
                else:
                    number = options[int(draw() * len(options))]
                chosen.append(number)
            place(whole, number)
        return whole, chosen

    def cost(self, prefix: Prefix) -> float:
        """Return J of those placed [s]; it only grows with the order."""
        return prefix.delay + self._share * prefix.finish if self._share else prefix.delay

    def bound(self, prefix: Prefix) -> float:
        """Return what J of any order that begins so is at least [s]."""
        base, weights, earliest = self._base, self._weights, prefix.earliest
        return self.cost(prefix) + sum([weights[k] * min(earliest[k] - base[k], LONGEST_WAIT) for k in prefix.waiting])

    def run(self, order: Sequence[str]) -> Prefix:
        """Schedule a whole order."""
        prefix = self.root()
        for name in order:
            self.place(prefix, self._number[name])
        return prefix

    def named(self, order: Sequence[int]) -> list[str]:
        """Return the ids of an order."""
        return [self.names[k] for k in order]


def joined(windows: Sequence[tuple[float, float]], earliest: float) -> list[tuple[float, float]]:
    """Return as few windows as give the same times from `earliest` on: apart from one another, by begin [s]."""
    found: list[tuple[float, float]] = []
    for begin, end in sorted(window for window in windows if window[0] < window[1] and window[1] > earliest):
        if found and begin < found[-1][1]:
            found[-1] = found[-1][0], max(found[-1][1], end)
        else:
            found.append((begin, end))
    return found
