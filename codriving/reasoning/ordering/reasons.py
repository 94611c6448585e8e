"""Why one vehicle goes before another one, in one short sentence for each pair in conflict."""

from collections.abc import Callable, Mapping, Sequence
from itertools import combinations

from codriving.datatypes.ordering_problem import Instance, Pair
from codriving.reasoning.ordering.schedule import Times
from codriving.reasoning.ordering.tickets import Ticket


def reasons(instance: Instance, order: Sequence[str], chosen: Callable[[str, str], str]) -> dict[Pair, str]:
    """Give a reason for each pair of an order that is in conflict."""
    return {
        (one, other): fixed(instance, one, other) if (one, other) in instance.before else chosen(one, other)
        for one, other in combinations(order, 2)
        if instance.conflict(one, other)
    }


def fixed(instance: Instance, one: str, other: str) -> str:
    """Say why it is physically fixed that one vehicle goes before another one."""
    first, second = instance.entrants[one], instance.entrants[other]
    if second.leader == one:
        return f"{one} drives ahead of {other}"
    if first.committed and not second.committed:
        return f"{one} can no longer stop, {other} can"
    return f"{one} has to go before {other} as they drive"


def by_ticket(one: str, other: str, held: Mapping[str, Ticket]) -> str:
    """Say what the tickets of two vehicles have to do with their order."""
    if one in held and other in held:
        times = f"({held[one].time:.1f} s against {held[other].time:.1f} s)"
        if held[one] <= held[other]:
            return f"{one} holds the earlier ticket {times}"
        return f"{one} goes in spite of its later ticket {times}: {other} has to wait for somebody behind it"
    if one in held:
        return f"{one} holds a ticket, {other} is still too far away"
    if other in held:
        return f"{one} goes without a ticket: {other} has to wait for somebody behind it"
    return f"{one} can arrive before {other}; both are still too far away for a ticket"


def by_slot(one: str, other: str, held: Mapping[str, Ticket], times: Times) -> str:
    """Say why the slot of one vehicle comes before that of another one.

    Args:
        times: Slots [s].
    """
    if other in held and (one not in held or held[one] > held[other]):
        return f"{one} fits in before {other} ({times[one]:.1f} s before {times[other]:.1f} s)"
    return by_ticket(one, other, held)
