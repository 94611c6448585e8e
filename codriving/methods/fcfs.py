"""First come, first served: who could have arrived first goes first (Dresner and Stone, 2008)."""

from collections.abc import Sequence
from typing import Literal

from codriving.datatypes.ordering_problem import Instance
from codriving.errors import ConfigError
from codriving.reasoning.ordering.protocol import JointPlanner, Ordering
from codriving.reasoning.ordering.reasons import by_slot, by_ticket, reasons
from codriving.reasoning.ordering.request import Request, in_order
from codriving.reasoning.ordering.schedule import after_windows, timed
from codriving.reasoning.ordering.slots import inserted, sequence
from codriving.reasoning.ordering.tickets import CONTROL_RADIUS, TicketBook

Mode = Literal["conflict", "global", "reservation"]
MODES = ("conflict", "global", "reservation")


class FirstComeFirstServed:
    """Right of way in the order of tickets.

    Args:
        control_radius: Distance to the reference point from which on a vehicle holds a ticket, 1 to 1000 [m].
        mode: Whom a vehicle waits for. ``conflict``: those with earlier tickets that it is in conflict with.
            ``global``: everybody of the group before; a group is a run of tickets of which no two are in conflict.
            ``reservation``: it takes the earliest slot that those with earlier tickets leave, also between them.

    Raises:
        ConfigError: If the radius is out of range or the mode unknown.
    """

    name = "fcfs"

    def __init__(self, control_radius: float = CONTROL_RADIUS, mode: Mode = "conflict") -> None:
        if mode not in MODES:
            raise ConfigError(f"mode must be {', '.join(MODES[:-1])} or {MODES[-1]}, got {mode}")
        self.tickets, self.mode = TicketBook(control_radius), mode
        self.variant: str = "" if mode == "conflict" else mode

    def reset(self, seed: int) -> None:
        """Begin an episode: nobody holds a ticket."""
        self.tickets.reset()

    def order(self, instance: Instance, planner: JointPlanner) -> Ordering:
        """Return everybody by ticket, as far as what is physically fixed allows."""
        ranking = self.tickets.ranking(instance)
        if self.mode == "reservation":
            ranking = sequence(instance, inserted(instance, ranking, {}))
        times = group_times(instance, ranking) if self.mode == "global" else timed(instance, ranking)
        return Ordering(
            tuple(ranking),
            times,
            reasons(instance, ranking, lambda one, other: self._reason(times, one, other)),
            not_before=times if self.mode == "global" else {},
        )

    def grant(self, requests: Sequence[Request]) -> frozenset[str]:
        """Grant the earliest request, then each next one that overlaps with none granted."""
        return in_order(requests)

    def _reason(self, times: dict[str, float], one: str, other: str) -> str:
        held = self.tickets.held
        return by_slot(one, other, held, times) if self.mode == "reservation" else by_ticket(one, other, held)


def group_times(instance: Instance, order: Sequence[str]) -> dict[str, float]:
    """Schedule an order group by group: nobody passes before all of the group before have left their zones.

    Returns:
        When each vehicle passes, in that order [s].
    """
    times: dict[str, float] = {}
    group: list[str] = []
    clear = float("-inf")
    for name in order:
        if any(instance.conflict(name, other) for other in group):
            clear = max([clear] + [times[other] + instance.entrants[other].crossing for other in group])
            group = []
        group.append(name)
        apart = [t + instance.separation.get((other, name), float("-inf")) for other, t in times.items()]
        entrant = instance.entrants[name]
        times[name] = after_windows(max([entrant.eta, clear, *apart]), entrant.windows)
    return times
