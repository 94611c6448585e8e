"""iDFST with times: each vehicle takes the earliest free slot in ticket order (Chen et al., 2022, weighted)."""

from collections.abc import Sequence
from itertools import combinations
from math import inf

from codriving.datatypes import Instance, Pair
from codriving.errors import require_range
from codriving.reasoning import (
    CONTROL_RADIUS,
    LONGEST_WAIT,
    JointPlanner,
    Objective,
    Ordering,
    OrderRule,
    Request,
    TicketBook,
    by_slot,
    carried_over,
    inserted,
    reasons,
    sequence,
    timed,
)

Windows = Sequence[tuple[float, float]]  # When human drivers block the reference point, (begin, end) [s]


class SpanningTree(OrderRule):
    """Improved depth-first spanning tree, with times in place of layers.

    A vehicle that is scheduled keeps its rank, a new one is inserted. All are scheduled anew if an earliest arrival
    or a window of a human driver has moved, or if what is physically fixed has changed.
    """

    name = "idfst"

    def __init__(self, control_radius: float = CONTROL_RADIUS, drift: float = 1.0, hysteresis: float = 0.3) -> None:
        require_range("drift", drift, 0, 10, " s")
        require_range("hysteresis", hysteresis, 0, 10, " s")
        self.tickets, self.drift, self.hysteresis = TicketBook(control_radius), drift, hysteresis
        self.objective = Objective()
        self.reset(0)

    def reset(self, seed: int) -> None:
        """Begin an episode: no vehicle holds a ticket or a slot."""
        self.tickets.reset()
        self.scheduled: tuple[str, ...] = ()
        self.arrivals: dict[str, float] = {}
        self.windows: dict[str, list[tuple[float, float]]] = {}
        self.before: frozenset[Pair] = frozenset()

    def order(self, instance: Instance, planner: JointPlanner) -> Ordering:
        """Return the order of the slots."""
        ranking = self.tickets.ranking(instance)
        kept = carried_over(instance, self.scheduled, ranking)
        anew = kept is None or self._has_moved(instance)
        order = kept or []
        if anew:
            fresh = sequence(instance, inserted(instance, ranking, {}))
            if kept is None or self._delay(instance, fresh) < self._delay(instance, kept) - self.hysteresis:
                order = fresh
        self._remember(instance, order, anew)
        times = timed(instance, order)
        why = reasons(instance, order, lambda one, other: by_slot(one, other, self.tickets.held, times))
        return Ordering(tuple(order), times, why, {"scheduled_anew": int(anew)})

    def grant(self, requests: Sequence[Request]) -> frozenset[str]:
        """Put each request into the first layer in which none overlaps with it, and grant the largest layer."""
        overlaps = {(r.ego, other) for r in requests for other in r.excludes}
        layers: list[list[str]] = []
        for r in requests:
            for layer in layers:
                if not any((r.ego, other) in overlaps or (other, r.ego) in overlaps for other in layer):
                    layer.append(r.ego)
                    break
            else:
                layers.append([r.ego])
        largest: list[str] = max(layers, key=len, default=[])
        return frozenset(largest)

    def _delay(self, instance: Instance, order: Sequence[str]) -> float:
        return self.objective.value(instance, timed(instance, order))

    def _has_moved(self, instance: Instance) -> bool:
        """Whether something has changed too much since the vehicles that are scheduled were."""
        kept = [name for name in self.scheduled if name in instance.vehicles]
        pairs = [pair for one, other in combinations(kept, 2) for pair in ((one, other), (other, one))]
        if any((pair in self.before) != (pair in instance.before) for pair in pairs):
            return True
        for name in kept:
            vehicle = instance.vehicles[name]
            arrival = instance.time + vehicle.eta
            if arrival != self.arrivals[name] and not abs(arrival - self.arrivals[name]) <= self.drift:
                return True
            then = clock_windows([(b - instance.time, e - instance.time) for b, e in self.windows[name]], instance.time)
            if moved_windows(then, clock_windows(vehicle.windows, instance.time), self.drift):
                return True
        return False

    def _remember(self, instance: Instance, order: Sequence[str], anew: bool) -> None:
        """Note what the slots rest on; a vehicle without a ticket is inserted again at the next step."""
        known = set() if anew else set(self.scheduled)
        self.scheduled = tuple(name for name in order if name in self.tickets.held)
        self.before = frozenset(instance.before)
        for name in self.scheduled:
            if name not in known:
                vehicle = instance.vehicles[name]
                self.arrivals[name] = instance.time + vehicle.eta
                self.windows[name] = clock_windows(vehicle.windows, instance.time)


def moved_windows(one: Windows, other: Windows, most: float) -> bool:
    """Whether windows on one clock differ by more than a given time [s]."""
    if len(one) != len(other):
        return True
    bounds = zip(sorted(one), sorted(other), strict=True)
    return any(a != b and not abs(a - b) <= most for pair in bounds for a, b in zip(*pair, strict=True))


def clock_windows(windows: Windows, now: float) -> list[tuple[float, float]]:
    """Put windows that are counted from now on the clock of the simulation, overlapping ones as one."""
    joined: list[tuple[float, float]] = []
    seen = [(max(b, 0.0), e if e < LONGEST_WAIT else inf) for b, e in windows]
    for begin, end in sorted((b + now, e + now) for b, e in seen if e > b):
        if joined and begin <= joined[-1][1]:
            joined[-1] = joined[-1][0], max(joined[-1][1], end)
        else:
            joined.append((begin, end))
    return joined
