"""Whether a human driver has to give way, and can: the traffic rules that all drivers know (Section III-C.3)."""

import math
from collections.abc import Callable

from codriving.datatypes import Conflict, Manner, TrackedVehicle
from codriving.geometry import RoadMap

STANDS = 2.0  # A human driver who has been standing before the zone for this long is taken to give way [s]

SLOW = 0.5  # Below this speed it stands [m/s]

COMFORT = 4.0  # Braking up to which a driver who has to give way is expected to begin to do so [m/s2]

FIRM = 5.0  # Braking up to which a driver who is seen to brake is expected to go on with it [m/s2]

GivesWay = Callable[[Conflict, TrackedVehicle, RoadMap], str]

STEADY = -0.5  # Above this acceleration a driver is not yet seen to brake [m/s2]

FRONT = 2.5  # Distance from the centre of a vehicle to its front [m]


def gives_way(c: Conflict, human: TrackedVehicle, road_map: RoadMap) -> str:
    """Say why a human driver is expected to let the CAV pass first.

    A driver who stands does, and one who can still stop before a zone that the CAV is in. So does one who can still
    stop comfortably before the junction, or is seen to brake for it, if it has the lower lane priority or finds the
    CAV in the junction already. No other driver is relied on.

    On unregulated roads, too, a driver who has to leave a lane that ends gives way to those on the lane beside.
    """
    if human.standing >= STANDS:
        return "the human driver has been standing and gives way"
    change = road_map.changes.ahead(c.routes[1], c.places[1])
    if change is not None and road_map.changes.ahead(c.routes[0], c.places[0]) is None:
        before = change[2] - c.places[1] - FRONT
        if before > 0 and human.speed**2 / (2 * before) <= FIRM:
            return "the human driver has to change onto the CAV's lane, and can still wait before its own lane ends"
    if c.distances[1] <= 0:
        return ""
    if c.distances[0] <= 0 and human.speed**2 / (2 * c.distances[1]) <= COMFORT:
        return "the CAV is in the conflict zone already, and the human driver can still stop before it"
    room = road_map.routes[c.routes[1]].entry - c.places[1] - FRONT
    if not road_map.road.regulated or room <= 0:
        return ""
    needed = human.speed**2 / (2 * room)
    if needed > (FIRM if human.acceleration is not None and human.acceleration < -0.5 * needed else COMFORT):
        return ""
    if c.places[0] > road_map.routes[c.routes[0]].entry:
        return "the CAV is in the junction already, and the human driver can still wait before it"
    mine = road_map.lanes[road_map.lane_at(c.routes[0], c.places[0])].priority
    if mine > road_map.lanes[road_map.lane_at(c.routes[1], c.places[1])].priority:
        return "the CAV has the right of way, and the human driver can still wait before the junction"
    return ""


def known_to_give_way(c: Conflict, human: TrackedVehicle, road_map: RoadMap, manner: Manner) -> str:
    """Say why a human driver lets the CAV pass first, of whom it is known how it treats the right of way.

    The same as ``gives_way`` but for drivers at a junction: those who stand may go at any time; one who hesitates gives
    way to all that move; one who never gives way minds bodies alone. Who does not brake yet begins to do so a reaction
    time later.
    """
    room = road_map.routes[c.routes[1]].entry - c.places[1] - FRONT
    if not road_map.road.regulated or c.distances[1] <= 0:
        return gives_way(c, human, road_map)
    brakes = human.acceleration is not None and human.acceleration < STEADY
    late = 0.0 if brakes or human.speed < SLOW else manner.reaction
    if c.distances[0] <= 0 and _needed(human.speed, c.distances[1], late) <= COMFORT:
        return "the CAV is in the conflict zone already, and the human driver can still stop before it"
    late += manner.distraction if late else 0.0
    if manner.gives_way == "never" or _needed(human.speed, room, late) > (FIRM if brakes else COMFORT):
        return ""
    entry = road_map.routes[c.routes[0]].entry
    if c.places[0] > entry:
        return "the CAV is in the junction already, and the human driver can still wait before it"
    mine, theirs = (road_map.lanes[road_map.lane_at(c.routes[k], c.places[k])].priority for k in (0, 1))
    if mine > theirs:
        return "the CAV has the right of way, and the human driver gives way to it"
    return "the human driver hesitates" if manner.hesitates else ""


def _needed(speed: float, room: float, late: float) -> float:
    """Return the braking with which a driver stops within some room that begins to brake late [m/s2]."""
    left = room - speed * late
    if speed < SLOW:
        return 0.0 if room > 0 else math.inf
    return speed**2 / (2 * left) if left > 0 else math.inf
