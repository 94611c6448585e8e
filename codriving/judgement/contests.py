"""Of which human drivers it is open whether they let a CAV pass, and what can be told of each."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import hypot, inf

from codriving.datatypes import Conflict, Relation, Role, TrackedVehicle, Turn
from codriving.reasoning import Moment, is_behind, window

FRONT = 2.5  # Distance from the centre of a vehicle to its front [m]

SOON = 10.0  # Later meetings are not judged yet [s]

LONGEST = 10.0  # Times that are longer than this are told as this [s]

HARDEST = 10.0  # Braking that is harder than this is told as this [m/s2]

SLOWER = 1.0  # By how much a vehicle ahead must be slower to hold up who follows it [m/s]

NEAR = 25.0  # How far ahead it may be [m]

# What is told of a pair, each as a number: [s], [m], [m/s], [m/s2], and 1 or 0 for yes or no.
FEATURES: Mapping[str, str] = {
    "time_ahead": "by how much later the human is at the zone at its present speed than the CAV at its earliest [s]",
    "cav_time": "when the CAV can be at the zone at the earliest [s]",
    "cav_distance": "distance of the CAV to the zone [m]",
    "cav_speed": "speed of the CAV [m/s]",
    "cav_committed": "whether the CAV can no longer stop before the zone",
    "cav_in_junction": "whether the CAV is in the junction",
    "cav_held_up": "whether a slower vehicle drives ahead of the CAV",
    "human_time": "when the human is at the zone at its present speed [s]",
    "human_distance": "distance of the human to the zone [m]",
    "human_speed": "speed of the human [m/s]",
    "human_acceleration": "acceleration of the human, negative if it brakes [m/s2]",
    "human_braking": "braking with which the human stops before the zone [m/s2]",
    "human_standing": "how long the human has been standing [s]",
    "human_in_junction": "whether the human is in the junction",
    "human_held_up": "whether a slower vehicle drives ahead of the human",
    "human_occupies": "how long the human takes through the zone at its present speed [s]",
    "ways": "how many ways the human may take",
    "priority": "1 if the CAV has the right of way, -1 if the human has it, 0 if neither",
    "converging": "whether the ways merge and do not cross",
    "cav_turns": "whether the CAV turns",
}


@dataclass(frozen=True, slots=True)
class Contest:
    """A CAV and a human driver who both can still be first, as one who judges the driver is told of them."""

    cav: str
    human: str
    conflict: Conflict  # The most urgent one in which it is open
    numbers: Mapping[str, float]  # By the names of `FEATURES`
    rule: str  # Why the rules of the road let the CAV rely on the driver; empty if they do not
    way: str  # The way that the driver is taken to take there
    follows: str  # Whom the driver follows; empty if no vehicle near
    driver: TrackedVehicle


def contests(moment: Moment) -> list[Contest]:
    """Find the pairs that are to be judged: of each CAV and each driver it knows of at most one, by their ids.

    Left out are drivers who are in the zone already, those before whom the CAV is through in any case, those who are
    gone before the CAV can be there, and what lies more than 10 s ahead.
    """
    trusting_none = replace(moment, gives_way=lambda c, human, road_map: "")
    found: dict[tuple[str, str], Contest] = {}
    for ego in sorted(moment.scenes):
        people = {n.id: n for n in moment.scenes[ego].neighbours if n.intent is None}
        for c in moment.conflicts[ego]:
            if c.other in people and (ego, c.other) not in found and _is_open(trusting_none, c, people[c.other]):
                found[ego, c.other] = _contest(moment, c, people[c.other])
    return [found[pair] for pair in sorted(found)]


def _earliest(moment: Moment, c: Conflict) -> float:
    """Return when the CAV can be at a zone at the earliest [s]."""
    scene, forecast = moment.scenes[c.ego], moment.forecast
    return forecast.time_to(c.distances[0], forecast.reach(scene.ego.speed, True, scene.where).most)


def _is_open(moment: Moment, c: Conflict, human: TrackedVehicle) -> bool:
    """Whether both can still be first if the driver gives no way."""
    if c.distances[1] <= 0:
        return False
    begin, end = window(moment, c, human, c.places[0] + c.distances[0])
    return begin < _earliest(moment, c) < min(end, SOON)


def _contest(moment: Moment, c: Conflict, human: TrackedVehicle) -> Contest:
    scene, road_map, forecast = moment.scenes[c.ego], moment.road_map, moment.forecast
    earliest, steady = _earliest(moment, c), forecast.reach(human.speed, False, (c.routes[1], c.places[1])).steady
    there, gone = (forecast.time_to(d, steady) for d in (c.distances[1], c.exits[1]))
    entries = [road_map.routes[route].entry for route in c.routes]
    mine, theirs = (road_map.lanes[road_map.lane_at(c.routes[k], c.places[k])].priority for k in (0, 1))
    room = c.distances[1] - FRONT
    leading, ahead = scene.next_in(Role.LEADING), _ahead_of(moment, c, human)
    held_up = leading is not None and (leading.gap or 0.0) < NEAR and leading.speed < scene.ego.speed - SLOWER
    stops = float(forecast.reach(scene.ego.speed, True, scene.where).least[-1]) < c.distances[0]
    numbers: dict[str, float] = {
        "time_ahead": max(min(there - earliest, LONGEST), -LONGEST),
        "cav_time": min(earliest, LONGEST),
        "cav_distance": c.distances[0],
        "cav_speed": scene.ego.speed,
        "cav_committed": not stops,
        "cav_in_junction": c.places[0] > entries[0],
        "cav_held_up": held_up,
        "human_time": min(there, LONGEST),
        "human_distance": c.distances[1],
        "human_speed": human.speed,
        "human_acceleration": human.acceleration or 0.0,
        "human_braking": min(human.speed**2 / (2 * room), HARDEST) if room > 0 else HARDEST * (human.speed > 0.5),
        "human_standing": min(human.standing, LONGEST),
        "human_in_junction": c.places[1] > entries[1] - FRONT,
        "human_held_up": ahead is not None and ahead.speed < human.speed - SLOWER,
        "human_occupies": min(gone - there, LONGEST) if there < inf else LONGEST,
        "ways": len(human.routes),
        "priority": (mine > theirs) - (mine < theirs) if road_map.road.regulated else 0,
        "converging": c.relation is not Relation.CROSSING,
        "cav_turns": road_map.routes[c.routes[0]].turn is not Turn.STRAIGHT,
    }
    rule = moment.gives_way(c, human, road_map)
    follows = ahead.id if ahead is not None else ""
    return Contest(c.ego, c.other, c, {k: float(v) for k, v in numbers.items()}, rule, c.routes[1], follows, human)


def _ahead_of(moment: Moment, c: Conflict, human: TrackedVehicle) -> TrackedVehicle | None:
    """Return the vehicle that the CAV sees next ahead of a driver on its way."""
    place, found = c.places[1], []
    for other in moment.vehicles[c.ego].values():
        for way, there in other.routes if other.id != human.id else ():
            if any(is_behind(zone, place, there) for zone in moment.road_map.zones(c.routes[1], way)):
                found.append((hypot(other.x - human.x, other.y - human.y), other.id, other))
    return min(found)[2] if found and min(found)[0] < NEAR else None
