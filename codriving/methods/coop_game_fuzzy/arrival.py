"""The order in which vehicles come, shown beside a cooperative game in which actions are chosen, and no order."""

from collections.abc import Sequence

from codriving.methods.fcfs import FirstComeFirstServed
from codriving.reasoning.ordering.request import Request, best_subset


class Arrival(FirstComeFirstServed):
    """First come, first served for the eye; lane changes are granted as in the game.

    Args:
        control_radius: Distance to the reference point from which on a vehicle holds a ticket, 1 to 1000 [m].

    Raises:
        ConfigError: If the radius is out of range.
    """

    name = "coop_game"

    def __init__(self, control_radius: float) -> None:
        super().__init__(control_radius)

    def grant(self, requests: Sequence[Request]) -> frozenset[str]:
        """Grant the requests that do not overlap and gain most together."""
        return best_subset(requests)
