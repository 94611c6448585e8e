"""First come, first served: the vehicle that could have arrived first goes first (Dresner and Stone, 2008)."""

from collections.abc import Sequence
from typing import Literal, get_args

from codriving.datatypes import Instance
from codriving.errors import require
from codriving.reasoning import (
    CONTROL_RADIUS,
    JointPlanner,
    Ordering,
    OrderRule,
    Request,
    TicketBook,
    after_windows,
    by_slot,
    by_ticket,
    in_order,
    inserted,
    reasons,
    sequence,
    timed,
)

Mode = Literal["conflict", "global", "reservation"]


class FirstComeFirstServed(OrderRule):
    """Right of way in the order of tickets."""

    name = "fcfs"

    def __init__(self, control_radius: float = CONTROL_RADIUS, mode: Mode = "conflict") -> None:
        require(mode in get_args(Mode), f"mode must be conflict, global or reservation, got {mode}")
        self.tickets, self.mode = TicketBook(control_radius), mode
        self.variant: str = "" if mode == "conflict" else mode

    def reset(self, seed: int) -> None:
        """Begin an episode: no vehicle holds a ticket."""
        self.tickets.reset()

    def order(self, instance: Instance, planner: JointPlanner) -> Ordering:
        """Return the order of tickets, as far as what is physically fixed allows."""
        ranking, held = self.tickets.ranking(instance), self.tickets.held
        if self.mode == "reservation":
            ranking = sequence(instance, inserted(instance, ranking, {}))
        times = group_times(instance, ranking) if self.mode == "global" else timed(instance, ranking)

        def reason(one: str, other: str) -> str:
            return by_slot(one, other, held, times) if self.mode == "reservation" else by_ticket(one, other, held)

        not_before = times if self.mode == "global" else {}
        return Ordering(tuple(ranking), times, reasons(instance, ranking, reason), not_before=not_before)

    def grant(self, requests: Sequence[Request]) -> frozenset[str]:
        """Grant the earliest request, then each next one that overlaps with none granted."""
        return in_order(requests)


def group_times(instance: Instance, order: Sequence[str]) -> dict[str, float]:
    """Schedule an order group by group: none passes before all of the group before have left their zones."""
    times: dict[str, float] = {}
    group: list[str] = []
    clear = float("-inf")
    for name in order:
        if any(instance.conflict(name, other) for other in group):
            clear = max([clear] + [times[other] + instance.vehicles[other].crossing for other in group])
            group = []
        group.append(name)
        apart = [t + instance.separation.get((other, name), float("-inf")) for other, t in times.items()]
        vehicle = instance.vehicles[name]
        times[name] = after_windows(max([vehicle.eta, clear, *apart]), vehicle.windows)
    return times
