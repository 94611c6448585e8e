"""Whether a human driver has to give way, and can: the traffic rules that all drivers know (Section III-C.3)."""

from codriving.datatypes import Conflict, TrackedVehicle
from codriving.geometry import RoadMap

STANDS = 2.0  # A human driver who has been standing before the zone for this long is taken to give way [s]

COMFORT = 4.0  # Braking up to which a driver who has to give way is expected to begin to do so [m/s2]

FIRM = 5.0  # Braking up to which a driver who is seen to brake is expected to go on with it [m/s2]

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
