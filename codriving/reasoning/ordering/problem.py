"""From a moment to its ordering problem, which every method that orders is handed."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from math import inf

import numpy as np

from codriving.datatypes import (
    Approach,
    ApproachingVehicle,
    Conflict,
    Instance,
    Pair,
    Relation,
    Role,
    TrackedVehicle,
    Turn,
)
from codriving.geometry import TRUE, ConflictZone, Footprint, RoadMap
from codriving.reasoning.exits import full_exit, gets_out
from codriving.reasoning.perception import Moment

GAP = 1.0  # Time between one vehicle's leaving a zone and the next one's entering it [s]

# Time between a CAV's leaving a zone and the earliest moment at which a human driver can be there [s].
CERTAIN_GAP = 0.4

FOLLOWS = (7.0, 0.5)  # Distance [m] at top speed and time [s] between two vehicles of one lane, one behind the other

# Size of a vehicle that has stopped in time [m]: the body, and the room that others need to cut a corner beside it.
COMMITTED = Footprint(5.6, 2.8)

FOREVER = 1e3  # Beyond every time that matters [s]

Window = tuple[float, float]  # Begin and end of a time that a human driver blocks [s]


@dataclass(frozen=True, slots=True)
class Problem:
    """An ordering problem and what is known of the human drivers in it."""

    instance: Instance
    # When each human driver may be in the way of each CAV, by CAV and driver [s].
    passages: Mapping[str, Mapping[str, Window]]


def pose(moment: Moment, gap: float = GAP) -> Problem:
    """Return the ordering problem of a moment: every CAV that still has a conflict ahead is to be ordered.

    Args:
        gap: Time between one vehicle's leaving a zone and the next one's entering it [s].
    """
    vehicles = {ego: _approaching(moment, ego) for ego in sorted(moment.scenes) if moment.conflicts[ego]}
    separation, each = _separations(moment, vehicles, gap)
    _add_leaders(moment, vehicles, separation)
    passages = {ego: _add_windows(moment, vehicle) for ego, vehicle in vehicles.items()}
    before, approaches = frozenset(_fixed(moment, vehicles)), _approaches(moment, vehicles)
    bound = {pair for one, other in before for pair in ((one, other), (other, one))}
    zones = {pair: spans for pair, spans in each.items() if pair not in bound} if moment.by_zone else {}
    return Problem(Instance(moment.time, vehicles, separation, before, approaches, zones), passages)


def _approaching(moment: Moment, ego: str) -> ApproachingVehicle:
    scene, conflicts, road_map = moment.scenes[ego], moment.conflicts[ego], moment.road_map
    route = road_map.routes[scene.intent.route]
    zones = [road_map.zones(*c.routes)[c.zone] for c in conflicts]
    reference = min(zone.entry_i for zone in zones)
    first = _approach(moment, ego, reference)
    lane = road_map.lane_at(route.id, scene.place)
    # Turning matters where ways cross; on a ring or a ramp no vehicle goes straight on.
    return ApproachingVehicle(
        id=ego,
        reference=reference,
        eta=first.earliest,
        committed=not first.can_stop,
        turning=route.turn is not Turn.STRAIGHT and any(c.relation is Relation.CROSSING for c in conflicts),
        lane="/".join(map(str, lane)),
        stream="/".join((*map(str, lane), str(route.turn))),
        distance=first.distance,
        crossing=moment.forecast.duration((route.id, reference), max(zone.exit_i for zone in zones) - reference),
        remaining=max(route.goal - scene.place, 0.0),
        speed=scene.ego.speed,
        priority=road_map.lanes[lane].priority,
    )


def _approach(moment: Moment, ego: str, entry: float) -> Approach:
    """Return how a CAV comes to the entry of a zone, at an arc length of its route [m]."""
    scene, forecast = moment.scenes[ego], moment.forecast
    ahead, go = entry - scene.place, forecast.reach(scene.ego.speed, True, scene.where)
    earliest = forecast.time_to(ahead, go.most) if ahead > 0 else ahead / forecast.model.top_speed
    return Approach(max(ahead, 0.0), earliest, bool(go.least[-1] < ahead))


def _approaches(moment: Moment, vehicles: Mapping[str, ApproachingVehicle]) -> dict[Pair, Approach]:
    """Return how each vehicle comes to the zones that it shares with others: to those, not to its own first one."""
    found: dict[Pair, Approach] = {}
    for ego in vehicles:
        for c in (c for c in moment.conflicts[ego] if c.other in vehicles and (ego, c.other) not in found):
            found[ego, c.other] = _approach(moment, ego, moment.road_map.zones(*c.routes)[c.zone].entry_i)
    return found


def _separations(
    moment: Moment, vehicles: Mapping[str, ApproachingVehicle], gap: float
) -> tuple[dict[Pair, float], dict[Pair, tuple[tuple[float, float], ...]]]:
    """Return the times between the vehicles of each pair: the longest of all zones, and those of each zone [s]."""
    found: dict[Pair, float] = {}
    each: dict[Pair, tuple[tuple[float, float], ...]] = {}
    for ego in vehicles:
        for c in moment.conflicts[ego]:
            if c.other not in vehicles:
                continue
            zone = moment.road_map.zones(*c.routes)[c.zone]
            both = []
            for pair, first in (((ego, c.other), True), ((c.other, ego), False)):
                shift = vehicles[pair[1]].reference - vehicles[pair[0]].reference
                way = (c.routes[0], zone.entry_i) if first else (c.routes[1], zone.entry_j)
                needed = moment.forecast.duration(way, lag_length(zone, first) + shift) + gap
                found[pair] = max(needed, found.get(pair, needed))
                both.append(needed)
            after, before = both
            each[ego, c.other] = (*each.get((ego, c.other), ()), (before, after))
    return found, each


@lru_cache(maxsize=4096)
def lag_length(zone: ConflictZone, seen_from_i: bool = True) -> float:
    """Return how much farther along the first vehicle must be than the second, at most, through a zone."""
    begin, end = (zone.entry_j, zone.exit_j) if seen_from_i else (zone.entry_i, zone.exit_i)
    s = np.arange(begin, end + 0.25, 0.5)
    front = np.asarray((zone.over_j if seen_from_i else zone.over_i).highest(s))
    inside = np.isfinite(front)
    return float(np.max(front[inside] - s[inside])) if inside.any() else 0.0


def _add_leaders(moment: Moment, vehicles: dict[str, ApproachingVehicle], separation: dict[Pair, float]) -> None:
    distance, time = FOLLOWS
    for ego, vehicle in vehicles.items():
        for n in moment.scenes[ego].neighbours:
            if n.role is Role.LEADING and n.id in vehicles:
                vehicle.leader = n.id
                needed = distance / moment.forecast.model.top_speed + time
                separation[n.id, ego] = max(separation.get((n.id, ego), 0.0), needed)


def _fixed(moment: Moment, vehicles: Mapping[str, ApproachingVehicle]) -> set[Pair]:
    """Return the pairs whose order is physical: a leader, or one who cannot stop before the zone any more."""
    found = {(vehicle.leader, ego) for ego, vehicle in vehicles.items() if vehicle.leader is not None}
    for ego in vehicles:
        for c in (c for c in moment.conflicts[ego] if c.other in vehicles):
            zones = moment.road_map.zones(*c.routes, COMMITTED)
            mine, theirs = (_stops_at(moment, name, c.places[k]) for k, name in enumerate((ego, c.other)))
            stuck = any(z.entry_i <= mine and c.places[0] < z.exit_i for z in zones)
            other_stuck = any(z.entry_j <= theirs and c.places[1] < z.exit_j for z in zones)
            if stuck and (not other_stuck or _is_ahead(c, moment.road_map)):
                found.add((ego, c.other))
    return found


def _stops_at(moment: Moment, name: str, place: float) -> float:
    """Return where a CAV comes to a stop if it brakes now [m]."""
    return place + float(
        moment.forecast.reach(moment.scenes[name].ego.speed, True, moment.scenes[name].where).least[-1]
    )


def _is_ahead(c: Conflict, road_map: RoadMap) -> bool:
    """Whether the CAV is already past the place at which the other one would be in its way."""
    zones = road_map.zones(*c.routes, TRUE)
    return any(z.entry_j < c.places[1] and c.places[0] > float(z.front(c.places[1])) > 0 for z in zones)


def _add_windows(moment: Moment, vehicle: ApproachingVehicle) -> dict[str, Window]:
    """Block the times at which human drivers may pass; return the blocked interval of each of them."""
    found: dict[str, Window] = {}
    known = moment.vehicles[vehicle.id]
    if full_exit(moment, known, known[vehicle.id]) is not None:
        vehicle.windows.append((-FOREVER, FOREVER))
    for c in moment.conflicts[vehicle.id]:
        n = moment.scenes[vehicle.id].neighbour(c.other)
        if n is None or n.intent is not None:
            continue
        begin, end = window(moment, c, n, vehicle.reference)
        if gets_out(moment, known[vehicle.id], n, False):
            begin, end = inf, inf
        elif n.standing > 0 and is_blocked(c, moment.road_map):
            begin, end = -FOREVER, FOREVER
        vehicle.windows.append((begin, end))
        before = found.get(c.other, (begin, end))
        found[c.other] = (min(begin, before[0]), max(end, before[1]))
    return found


def window(moment: Moment, c: Conflict, human: TrackedVehicle, reference: float) -> Window:
    """Return the times at which a CAV must not pass its reference point because of a human driver."""
    forecast = moment.forecast
    if moment.gives_way(c, human, moment.road_map):
        return inf, inf
    zone = moment.road_map.zones(*c.routes)[c.zone]
    slow, fast = forecast.likely_of(human, (c.routes[1], c.places[1]))
    leaves = forecast.time_to(zone.entry_i + lag_length(zone, False) - c.places[1], slow)
    way = (c.routes[0], reference)
    passed = forecast.duration(way, zone.entry_j + lag_length(zone) - reference)
    begin = forecast.time_to(c.distances[1], fast) - passed - CERTAIN_GAP
    return begin, leaves + GAP - forecast.duration(way, zone.entry_i - reference)


def passes_first(moment: Moment, ego: str, human: TrackedVehicle, conflicts: Iterable[Conflict]) -> bool:
    """Whether a CAV that accelerates is through all its conflicts with a human driver before that one can be there."""
    scene, forecast = moment.scenes[ego], moment.forecast
    travel = forecast.reach(scene.ego.speed, True, scene.where).most
    return all(
        forecast.time_to(c.distances[0], travel) <= window(moment, c, human, scene.place + c.distances[0])[0]
        for c in conflicts
    )


def is_blocked(c: Conflict, road_map: RoadMap) -> bool:
    """Whether the other vehicle stands bodily in the way of the CAV."""
    zones = road_map.zones(*c.routes, TRUE)
    return any(z.entry_j < c.places[1] < z.exit_j and c.places[0] <= float(z.front(c.places[1])) for z in zones)
