"""Tickets: who came first, written down once and never changed."""

from dataclasses import dataclass
from typing import NamedTuple

from codriving.datatypes.ordering_problem import Entrant, Instance
from codriving.errors import ConfigError
from codriving.reasoning.ordering.schedule import repaired

CONTROL_RADIUS = 60.0
"""Distance to the reference point from which on a vehicle holds a ticket [m]."""

TIE = 1e-6
"""Tickets that lie no farther apart are equal [s]."""


class Ticket(NamedTuple):
    """When a vehicle can arrive at the earliest, as it was when it came near.

    Attributes:
        time: Simulated time of the earliest arrival [s].
    """

    time: float
    rank: int
    id: str


@dataclass(slots=True)
class TicketBook:
    """Hands out tickets, and remembers them for one episode.

    Attributes:
        radius: Distance to the reference point from which on a vehicle holds a ticket [m].

    Raises:
        ConfigError: If the radius is out of range.
    """

    radius: float
    held: dict[str, Ticket]
    begun: bool

    def __init__(self, radius: float = CONTROL_RADIUS) -> None:
        if not 1 <= radius <= 1000:
            raise ConfigError(f"control_radius must be 1 to 1000 m, got {radius:g}")
        self.radius = radius
        self.reset()

    def reset(self) -> None:
        """Begin an episode: nobody holds a ticket."""
        self.held, self.begun = {}, False

    def ranking(self, instance: Instance) -> list[str]:
        """Hand out the tickets of this moment and rank everybody.

        At the first step of the episode everybody gets a ticket, later whoever is within the radius for the first time.

        Returns:
            Ids by ticket, behind them those without one by earliest arrival; nobody before whom it has to let go.
        """
        for entrant in instance.entrants.values():
            if entrant.id not in self.held and (not self.begun or entrant.distance <= self.radius):
                self.held[entrant.id] = _ticket(entrant, instance.time)
        self.begun = True
        holders = [self.held[name] for name in instance.entrants if name in self.held]
        others = [_ticket(e, instance.time) for name, e in instance.entrants.items() if name not in self.held]
        return repaired(instance, [t.id for t in (*in_turn(holders), *in_turn(others))])


def _ticket(entrant: Entrant, now: float) -> Ticket:
    return Ticket(now + entrant.eta, -entrant.priority, entrant.id)


def in_turn(tickets: list[Ticket]) -> list[Ticket]:
    """Sort tickets by time, equal ones by priority and then by id."""
    ordered: list[Ticket] = []
    equal: list[Ticket] = []
    for ticket in sorted(tickets):
        if equal and ticket.time - equal[0].time > TIE:
            ordered += sorted(equal, key=lambda t: t[1:])
            equal = []
        equal.append(ticket)
    return ordered + sorted(equal, key=lambda t: t[1:])
