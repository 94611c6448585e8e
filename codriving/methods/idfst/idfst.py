"""iDFST with times: each vehicle takes the earliest free slot in ticket order (Chen et al., 2022, weighted)."""

from collections.abc import Sequence
from itertools import combinations

from codriving.datatypes.ordering_problem import Instance, Pair
from codriving.errors import ConfigError
from codriving.methods.idfst.spanning_tree import request_layers
from codriving.reasoning.ordering.objective import Objective
from codriving.reasoning.ordering.protocol import JointPlanner, Ordering
from codriving.reasoning.ordering.reasons import by_slot, reasons
from codriving.reasoning.ordering.request import Request
from codriving.reasoning.ordering.schedule import timed
from codriving.reasoning.ordering.slots import carried_over, inserted, sequence
from codriving.reasoning.ordering.tickets import CONTROL_RADIUS, TicketBook
from codriving.reasoning.ordering.windows import clock_windows, moved_windows


class SpanningTree:
    """Improved depth-first spanning tree, with times in place of layers.

    Whoever is scheduled keeps its rank, who is new is inserted. Everybody is scheduled anew if an earliest arrival or a
    window of a human driver has moved, or if what is physically fixed has changed.

    Args:
        control_radius: Distance to the reference point from which on a vehicle holds a ticket, 1 to 1000 [m].
        drift: How far an earliest arrival or a window may move before everybody is scheduled anew, 0 to 10 [s].
        hysteresis: Delay that a new schedule must save everybody together to be taken, 0 to 10 [s].

    Raises:
        ConfigError: If a value is out of range.
    """

    name = "idfst"

    def __init__(self, control_radius: float = CONTROL_RADIUS, drift: float = 1.0, hysteresis: float = 0.3) -> None:
        if not 0 <= drift <= 10:
            raise ConfigError(f"drift must be 0 to 10 s, got {drift:g}")
        if not 0 <= hysteresis <= 10:
            raise ConfigError(f"hysteresis must be 0 to 10 s, got {hysteresis:g}")
        self.tickets, self.drift, self.hysteresis = TicketBook(control_radius), drift, hysteresis
        self.objective = Objective()
        self.variant: str = ""
        self.reset(0)

    def reset(self, seed: int) -> None:
        """Begin an episode: nobody holds a ticket or a slot."""
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
        return Ordering(
            tuple(order),
            times,
            reasons(instance, order, lambda one, other: by_slot(one, other, self.tickets.held, times)),
            {"scheduled_anew": int(anew)},
        )

    def grant(self, requests: Sequence[Request]) -> frozenset[str]:
        """Sort the requests into layers, first request first, and grant the largest layer."""
        return max(request_layers(requests), key=len, default=frozenset())

    def _delay(self, instance: Instance, order: Sequence[str]) -> float:
        return self.objective.value(instance, timed(instance, order))

    def _has_moved(self, instance: Instance) -> bool:
        """Whether something has changed too much for those who are scheduled, since they were."""
        kept = [name for name in self.scheduled if name in instance.entrants]
        for one, other in combinations(kept, 2):
            for pair in ((one, other), (other, one)):
                if (pair in self.before) != (pair in instance.before):
                    return True
        for name in kept:
            entrant = instance.entrants[name]
            arrival = instance.time + entrant.eta
            if arrival != self.arrivals[name] and not abs(arrival - self.arrivals[name]) <= self.drift:
                return True
            then = clock_windows([(b - instance.time, e - instance.time) for b, e in self.windows[name]], instance.time)
            if moved_windows(then, clock_windows(entrant.windows, instance.time), self.drift):
                return True
        return False

    def _remember(self, instance: Instance, order: Sequence[str], anew: bool) -> None:
        """Note what holds for those who have a slot; a vehicle without a ticket is inserted again at the next step."""
        known = set() if anew else set(self.scheduled)
        self.scheduled = tuple(name for name in order if name in self.tickets.held)
        self.before = frozenset(instance.before)
        for name in self.scheduled:
            if name not in known:
                entrant = instance.entrants[name]
                self.arrivals[name] = instance.time + entrant.eta
                self.windows[name] = clock_windows(entrant.windows, instance.time)
