"""Tickets: which vehicle came first, written down once and never changed; and why one vehicle goes before another."""

from collections.abc import Callable, Mapping, Sequence
from itertools import combinations
from typing import NamedTuple

from codriving.datatypes import ApproachingVehicle, Instance, Pair
from codriving.errors import require_range
from codriving.reasoning.ordering.schedule import Times, repaired

CONTROL_RADIUS = 60.0  # Distance to the reference point from which on a vehicle holds a ticket [m]

TIE = 1e-6  # Tickets that lie no farther apart are equal [s]


class Ticket(NamedTuple):
    """When a vehicle can arrive at the earliest, as it was when it came near."""

    time: float  # Simulated time of the earliest arrival [s]
    rank: int
    id: str


class TicketBook:
    """Hands out tickets, and remembers them for one episode.

    Args:
        radius: Distance to the reference point from which on a vehicle holds a ticket [m].

    Raises:
        ConfigError: If the radius is out of range.
    """

    def __init__(self, radius: float = CONTROL_RADIUS) -> None:
        require_range("control_radius", radius, 1, 1000, " m")
        self.radius = radius
        self.reset()

    def reset(self) -> None:
        """Begin an episode: no vehicle holds a ticket."""
        self.held: dict[str, Ticket] = {}
        self.begun = False

    def ranking(self, instance: Instance) -> list[str]:
        """Hand out the tickets of this moment and rank all vehicles.

        At the first step of the episode all get a ticket, later those that are within the radius for the first time.

        Returns:
            Ids by ticket, behind them those without one by earliest arrival; as far as what is physically fixed allows.
        """
        for vehicle in instance.vehicles.values():
            if vehicle.id not in self.held and (not self.begun or vehicle.distance <= self.radius):
                self.held[vehicle.id] = _ticket(vehicle, instance.time)
        self.begun = True
        holders = [self.held[name] for name in instance.vehicles if name in self.held]
        others = [_ticket(e, instance.time) for name, e in instance.vehicles.items() if name not in self.held]
        return repaired(instance, [t.id for t in (*in_turn(holders), *in_turn(others))])


def _ticket(vehicle: ApproachingVehicle, now: float) -> Ticket:
    return Ticket(now + vehicle.eta, -vehicle.priority, vehicle.id)


def in_turn(tickets: list[Ticket]) -> list[Ticket]:
    """Sort tickets by time, equal ones by priority and then by id."""
    groups: list[list[Ticket]] = []
    for ticket in sorted(tickets):
        if not groups or ticket.time - groups[-1][0].time > TIE:
            groups.append([])
        groups[-1].append(ticket)
    return [ticket for group in groups for ticket in sorted(group, key=lambda t: t[1:])]


def reasons(instance: Instance, order: Sequence[str], chosen: Callable[[str, str], str]) -> dict[Pair, str]:
    """Give a reason for each pair of an order that is in conflict."""
    return {
        (one, other): fixed(instance, one, other) if (one, other) in instance.before else chosen(one, other)
        for one, other in combinations(order, 2)
        if instance.conflict(one, other)
    }


def fixed(instance: Instance, one: str, other: str) -> str:
    """Say why it is physically fixed that one vehicle goes before another one."""
    if instance.vehicles[other].leader == one:
        return f"{one} drives ahead of {other}"
    if not instance.approach(one, other).can_stop and instance.approach(other, one).can_stop:
        return f"{one} can no longer stop, {other} can"
    return f"{one} has to go before {other} as they drive"


def by_ticket(one: str, other: str, held: Mapping[str, Ticket]) -> str:
    """Say what the tickets of two vehicles have to do with their order."""
    if one in held and other in held:
        times = f"({held[one].time:.1f} s against {held[other].time:.1f} s)"
        if held[one] <= held[other]:
            return f"{one} holds the earlier ticket {times}"
        return f"{one} goes in spite of its later ticket {times}: {other} has to wait for a vehicle behind it"
    if one in held:
        return f"{one} holds a ticket, {other} is still too far away"
    if other in held:
        return f"{one} goes without a ticket: {other} has to wait for a vehicle behind it"
    return f"{one} can arrive before {other}; both are still too far away for a ticket"


def by_slot(one: str, other: str, held: Mapping[str, Ticket], times: Times) -> str:
    """Say why the slot of one vehicle comes before that of another one."""
    if other in held and (one not in held or held[one] > held[other]):
        return f"{one} fits in before {other} ({times[one]:.1f} s before {times[other]:.1f} s)"
    return by_ticket(one, other, held)
