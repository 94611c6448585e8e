"""Where the way of a vehicle meets those of others, and who is expected there first, as it sees it alone."""

from dataclasses import dataclass
from math import cos, pi, sin

from codriving.datatypes.conflict import Conflict
from codriving.datatypes.scene_description import TrackedVehicle
from codriving.geometry.box import Footprint
from codriving.geometry.road_map import RoadMap
from codriving.geometry.zone import ConflictZone
from codriving.methods.single_vehicle.protocol import View

FRONT = 2.5
"""Distance from the centre of a vehicle to its front [m]."""


CLOSE = Footprint(5.6, 2.4)
"""Size of vehicles that pass by somebody who stands, at a walking pace and with a small margin [m]."""


@dataclass(frozen=True, slots=True)
class Encounter:
    """A zone ahead of which it is open who goes first, with one of the ways that the other one may take.

    Attributes:
        stops: Distance in which the ego vehicle can stop [m].
        firm: Braking beyond which nobody is expected to wait any more [m/s2].
    """

    conflict: Conflict
    other: TrackedVehicle
    zone: ConflictZone
    stops: float
    firm: float

    @property
    def own_way(self) -> float:
        """Distance to the zone [m]; negative inside it."""
        return self.zone.entry_i - self.conflict.places[0]

    @property
    def its_way(self) -> float:
        """Distance of the other one to the zone [m]; negative inside it."""
        return self.zone.entry_j - self.conflict.places[1]

    @property
    def inside(self) -> bool:
        """Whether the ego vehicle is in the zone."""
        return self.own_way <= 0

    @property
    def other_inside(self) -> bool:
        """Whether the other one is in the zone."""
        return self.its_way <= 0

    @property
    def bound(self) -> bool:
        """Whether the ego vehicle can no longer stop before the zone."""
        return self.own_way <= self.stops

    @property
    def other_bound(self) -> bool:
        """Whether the other one can no longer be expected to stop before the zone."""
        return self.its_way <= self.other.speed**2 / (2 * self.firm)

    def merges(self) -> bool:
        """Whether both go on together behind the point where they meet."""
        return self.zone.merge_i is not None


def encounters(view: View, stops: float, firm: float) -> tuple[Encounter, ...]:
    """Return everything that is open, most urgent first.

    Args:
        stops: Distance in which it can stop [m].
        firm: Braking beyond which nobody is expected to wait any more [m/s2].
    """
    others = {n.id: n for n in view.scene.neighbours}
    return tuple(
        Encounter(c, others[c.other], view.road_map.zones(*c.routes)[c.zone], stops, firm) for c in view.conflicts
    )


def crossing_angle(c: Conflict, zone: ConflictZone, road_map: RoadMap) -> float:
    """Return by how much the other's direction is turned from one's own where the ways meet, -pi to pi [rad]."""
    own = road_map.paths[c.routes[0]].place(zone.point_i)[2]
    its = road_map.paths[c.routes[1]].place(zone.point_j)[2]
    return (its - own + pi) % (2 * pi) - pi


def comes_from_the_right(c: Conflict, road_map: RoadMap) -> bool | None:
    """Whether the other one comes from the right; None if neither has the other one on its right."""
    own = road_map.paths[c.routes[0]].place(road_map.routes[c.routes[0]].entry)[2]
    its = road_map.paths[c.routes[1]].place(road_map.routes[c.routes[1]].entry)[2]
    # The y axis points to the right of the x axis, so that who drives towards negative angles comes from the right.
    across = sin(its - own)
    if abs(across) < 0.5 or cos(its - own) > 0.9:
        return None
    return across < 0


def passes_by(e: Encounter, road_map: RoadMap) -> bool:
    """Whether a vehicle passes by the other one where that one stands."""
    place, there = e.conflict.places
    return all(float(zone.front(there)) < place for zone in road_map.zones(*e.conflict.routes, CLOSE))
