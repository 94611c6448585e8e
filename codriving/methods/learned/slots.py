"""The leader and the conflicts of one CAV as features, the most urgent first."""

from collections.abc import Iterable, Iterator
from math import cos

from codriving.datatypes.conflict import Relation
from codriving.datatypes.vehicle import VehicleState
from codriving.geometry.road_map import RoadMap
from codriving.methods.learned.known import Other
from codriving.methods.learned.layout import FAR, NEAR, SLOT, SLOTS
from codriving.reasoning.conflicts import is_open
from codriving.reasoning.severity import ttcp
from codriving.reasoning.sharing.scenes import ALIGNED, SAME_LANE

LEADER_URGENCY = 10.0
"""Gap to a leader that counts as one unit of urgency [m]."""

GOES_FIRST, EQUAL, GIVES_WAY = 1.0, 0.6, 0.2
"""The first number of a slot: whether the CAV goes first by the rules of the road; 1 where there are none."""

Slot = tuple[float, tuple[float, ...]]
"""Urgency, the smaller the more urgent, and the numbers."""


def leader_ahead(
    ego: VehicleState, route: str, place: float, others: Iterable[Other], road_map: RoadMap
) -> tuple[Other, float] | None:
    """Return who drives next ahead on the own route, and the gap from bumper to bumper [m].

    Args:
        place: Its arc length there [m].
    """
    path = road_map.paths[route]
    nearest: tuple[float, Other] | None = None
    for other in others:
        s, side = road_map.project(route, other.x, other.y)
        if s <= place or abs(side) > SAME_LANE or cos(other.heading - path.place(s)[2]) <= ALIGNED:
            continue
        gap = s - place - (other.length + ego.length) / 2
        if nearest is None or gap < nearest[0]:
            nearest = gap, other
    return None if nearest is None else (nearest[1], nearest[0])


def leader_slot(other: Other, gap: float, top: float) -> Slot:
    """Return a leader as a slot.

    Args:
        gap: Gap to it [m].
        top: Highest target speed [m/s].
    """
    x = gap / (NEAR * top)
    return gap / LEADER_URGENCY, (1.0, float(other.is_cav), 1.0, 0.0, x, x, 0.0, other.speed / top, other.target / top)


def precedence(own: int | None, other: int | None) -> float:
    """Say whether a CAV goes before another vehicle by the rules of the road; human drivers keep to them."""
    if own is None or other is None or own > other:
        return GOES_FIRST
    return EQUAL if own == other else GIVES_WAY


def conflict_slots(
    ego: VehicleState,
    route: str,
    place: float,
    others: Iterable[Other],
    road_map: RoadMap,
    top: float,
    priority: int | None = None,
) -> Iterator[Slot]:
    """Yield the most urgent open conflict with each of the others, as a slot.

    Of a vehicle that may take several routes the most urgent zone counts.

    Args:
        place: Its arc length there [m].
        top: Highest target speed [m/s].
        priority: Rank of its lane by the rules of the road; None where these do not count.
    """
    near, far = NEAR * top, FAR * top
    for other in others:
        best: Slot | None = None
        for theirs, at in other.places:
            if theirs == route:
                continue
            for zone in road_map.zones(route, theirs):
                own, away = zone.entry_i - place, zone.entry_j - at
                if own > far or away > far or not is_open(zone, place, at):
                    continue
                times = ttcp(own, ego.speed), ttcp(away, other.speed)
                urgency = abs(times[0] - times[1]) + 0.2 * min(times)
                if best is None or urgency < best[0]:
                    crossing = float(zone.relation is Relation.CROSSING)
                    ways = (own / near, away / near, (zone.exit_j - at) / near)
                    rank = precedence(priority, other.priority)
                    speeds = other.speed / top, other.target / top
                    best = urgency, (rank, float(other.is_cav), 0.0, crossing, *ways, *speeds)
        if best is not None:
            yield best


def filled(slots: Iterable[Slot]) -> list[float]:
    """Return the numbers of the most urgent slots; zeros where there are fewer."""
    chosen = sorted(slots, key=lambda slot: slot[0])[:SLOTS]
    numbers = [number for _, values in chosen for number in values]
    return numbers + [0.0] * (SLOTS * len(SLOT) - len(numbers))
