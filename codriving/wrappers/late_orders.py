"""Orders that take time to think of: until the next one is there the last valid one drives."""

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations

from codriving.datatypes import Instance, Pair, PassingOrder
from codriving.protocol import with_given
from codriving.reasoning import (
    Coordinator,
    JointPlanner,
    Moment,
    Negotiation,
    Ordering,
    OrderRule,
    OwnOrders,
    Request,
    agreement,
    find_circle,
    open_pairs,
    pose,
    repaired,
    timed,
)
from codriving.wrappers.delays import EARLY, Asked, Delays


@dataclass(frozen=True, slots=True)
class OrderThought:
    """An order, and when it was asked for."""

    begun: float  # [s]
    due: float  # [s]
    ordering: Ordering
    pairs: tuple[Pair, ...]  # CAVs of which it was open who goes first, the one that does first


class StandingOrder:
    """The order that CAVs go by, and the one that is being thought of."""

    def __init__(self, counts: Counter[str]) -> None:
        self._counts = counts
        self._standing: OrderThought | None = None
        self._next: OrderThought | None = None

    @property
    def thinks(self) -> bool:
        """Whether an order is being thought of."""
        return self._next is not None

    def arrive(self, instance: Instance) -> None:
        """Take over the order that was thought of, if it is ready and its premise has not gone."""
        thought = self._next
        if thought is None or thought.due > instance.time + EARLY:
            return
        self._next = None
        if holds(thought.pairs, instance):
            self._standing = thought
            self._counts["late_orders"] += 1
        else:
            self._counts["dropped_orders"] += 1

    def begin(self, instance: Instance, ordering: Ordering, seconds: float) -> None:
        """Begin to think of an order, which takes some time [s]; one that takes none stands at once."""
        pairs = tuple(p for p in combinations(ordering.sequence, 2) if instance.conflict(*p))
        thought = OrderThought(instance.time, instance.time + seconds, ordering, tuple(open_pairs(instance, pairs)))
        if seconds > 0 and thought.pairs:
            self._next = thought
        else:
            self._standing = thought

    def now(self, instance: Instance) -> Ordering | None:
        """Return the standing order as it is now; None if there is none.

        Who has left is not in it; who has come since goes last, the one first that can be there first. What has become
        physically fixed goes before what was ordered.
        """
        if self._standing is None:
            return None
        ordering, age = self._standing.ordering, instance.time - self._standing.begun
        left = [name for name in ordering.sequence if name in instance.vehicles]
        if not left:
            return None
        order = repaired(instance, [*left, *by_arrival(instance, left)])
        not_before = {name: at - age for name, at in ordering.not_before.items() if name in instance.vehicles}
        return Ordering(tuple(order), timed(instance, order), ordering.reasons, not_before=not_before)


def holds(pairs: Sequence[Pair], instance: Instance) -> bool:
    """Whether something is left of what an order is about, and nothing of that contradicts who is in the way by now."""
    left = {pair for pair in pairs if pair[0] in instance.vehicles and pair[1] in instance.vehicles}
    left = {pair for pair in left if instance.conflict(*pair)}
    return bool(left) and find_circle({*left, *instance.before}) is None


def by_arrival(instance: Instance, besides: Sequence[str] = ()) -> list[str]:
    """Return the CAVs by when each can be there at the earliest."""
    others = [vehicle for name, vehicle in instance.vehicles.items() if name not in besides]
    return [vehicle.id for vehicle in sorted(others, key=lambda v: (v.eta, v.id))]


class LateCoordinator(Coordinator):
    """A coordinator whose order comes late; before the first one there is none."""

    def __init__(
        self,
        coordinator: Coordinator,
        binding: bool,
        delays: Delays,
        asked: Callable[[], Asked],
        counts: Counter[str],
        gap: float | None = None,
    ) -> None:
        self.coordinator, self._binding, self._delays, self._gap = coordinator, binding, delays, gap
        self._asked, self._standing = asked, StandingOrder(counts)

    def negotiate(self, moment: Moment, given: Mapping[Pair, str] | None = None) -> PassingOrder:
        """Return the order that stands, which is empty before the first one."""
        return self.standing(moment, given or {}) or PassingOrder((), ())

    def standing(self, moment: Moment, given: Mapping[Pair, str]) -> PassingOrder | None:
        """Return the order that stands; None before the first one."""
        problem = with_given(pose(moment) if self._gap is None else pose(moment, self._gap), given)
        self._standing.arrive(problem.instance)
        if not self._standing.thinks:
            order = self.coordinator.negotiate(moment, given)
            self._standing.begin(problem.instance, ordering_of(order), self._delays.of_order(self._asked()))
            if not self._standing.thinks:
                return order
        ordering = self._standing.now(problem.instance)
        if ordering is None:
            return None

        def reason(first: str, second: str) -> str:
            return given.get((first, second)) or ordering.reason(first, second)

        return agreement(moment, problem, ordering.times, reason, self._binding)


class LateOrders(Negotiation):
    """The negotiation of ``codriving``, whose order comes late; before the first one each CAV goes by its own."""

    def __init__(self, coordinator: LateCoordinator, own: OwnOrders) -> None:
        self.coordinator, self._own = coordinator, own

    def orders(self, moment: Moment) -> Mapping[str, PassingOrder]:
        """Return the order that stands, for every CAV."""
        order = self.coordinator.standing(moment, {})
        return self._own.orders(moment) if order is None else dict.fromkeys(moment.scenes, order)


def ordering_of(order: PassingOrder) -> Ordering:
    """Return an order as its sequence and reasons; when each passes is worked out anew each step."""
    return Ordering(order.sequence, {}, {(p.first, p.second): p.reason for p in order.precedences})


class LateRule(OrderRule):
    """An ordering rule whose order comes late; before the first one who can be there first goes first."""

    def __init__(self, rule: OrderRule, seconds: float, counts: Counter[str]) -> None:
        self.rule, self._seconds, self._counts = rule, seconds, counts
        self.name, self.variant, self.most_cavs = rule.name, rule.variant, rule.most_cavs

    def reset(self, seed: int) -> None:
        """Begin an episode: no order has been thought of."""
        self.rule.reset(seed)
        self._standing = StandingOrder(self._counts)

    def order(self, instance: Instance, planner: JointPlanner) -> Ordering:
        """Return the order that stands."""
        self._standing.arrive(instance)
        if self._standing.thinks:
            return self.now(instance)
        made = self.rule.order(instance, planner)
        self._standing.begin(instance, made, self._seconds)
        return replace(self.now(instance), counts=made.counts) if self._standing.thinks else made

    def now(self, instance: Instance) -> Ordering:
        """Return the order that stands, without thinking of another one."""
        found = self._standing.now(instance)
        if found is not None:
            return found
        order = repaired(instance, by_arrival(instance))
        return Ordering(tuple(order), timed(instance, order))

    def grant(self, requests: Sequence[Request]) -> frozenset[str]:
        return self.rule.grant(requests)
