"""What one CAV knows of the world around it (paper Section III-C, state sharing and intent sharing)."""

from dataclasses import dataclass
from enum import StrEnum
from math import cos, hypot, sin

from codriving.datatypes.road import LaneId
from codriving.datatypes.vehicle import Intent, Kind, VehicleState


class Role(StrEnum):
    """What a neighbour is to the ego vehicle."""

    LEADING = "leading"
    REARING = "rearing"
    CONFLICT = "conflict"
    OTHER = "other"


@dataclass(frozen=True, slots=True)
class TrackedVehicle:
    """A vehicle as far as the ego vehicle knows it; what it does not know is None.

    Attributes:
        routes: Each route that it may be on, with its arc length there [m]; one entry if it shared its route.
        gap: Free distance along the ego lane for a leading or rearing vehicle [m].
    """

    id: str
    kind: Kind | None
    x: float  # [m]
    y: float  # [m]
    speed: float  # [m/s]
    heading: float | None  # [rad]
    acceleration: float | None  # [m/s2]
    lane: LaneId | None
    length: float  # [m]
    routes: tuple[tuple[str, float], ...] = ()
    intent: Intent | None = None
    standing: float = 0.0  # How long it has been standing [s]
    role: Role = Role.OTHER
    gap: float | None = None

    @property
    def is_cav(self) -> bool:
        """Whether it has shared its intent, as only a CAV can."""
        return self.intent is not None

    @property
    def target(self) -> float:
        """Target speed; its speed where that is not known [m/s]."""
        return self.speed if self.intent is None else self.intent.target_speed


@dataclass(frozen=True, slots=True)
class LaneChange:
    """A lane change that the ego vehicle's route asks for."""

    lane: LaneId
    room: float  # Distance within which it has to be begun, since the present lane ends [m]


@dataclass(frozen=True, slots=True)
class SceneDescription:
    """The surroundings of one CAV, by lane and by relation.

    Attributes:
        covers: Other routes onto whose lanes its body reaches while it changes lanes, with its arc length there [m].
    """

    ego: VehicleState
    intent: Intent
    place: float  # Its arc length along its route [m]
    adjacent_lanes: tuple[LaneId, ...]
    conflict_lanes: tuple[LaneId, ...]
    neighbours: tuple[TrackedVehicle, ...]
    covers: tuple[tuple[str, float], ...] = ()
    must_change: LaneChange | None = None  # The lane change that its route asks for next, or None

    def neighbour(self, name: str) -> TrackedVehicle | None:
        """Return a neighbour by id, or None if the ego vehicle does not know of it."""
        return next((n for n in self.neighbours if n.id == name), None)

    def distance(self, n: TrackedVehicle) -> float:
        """Return the distance of the centres [m]."""
        return hypot(n.x - self.ego.x, n.y - self.ego.y)

    def by_distance(self) -> list[TrackedVehicle]:
        """Return the neighbours, nearest first."""
        return sorted(self.neighbours, key=lambda n: (self.distance(n), n.id))

    def offset(self, n: TrackedVehicle) -> tuple[float, float]:
        """Return how far ahead and how far to the right of the ego vehicle a vehicle is [m]."""
        dx, dy, along, across = n.x - self.ego.x, n.y - self.ego.y, cos(self.ego.heading), sin(self.ego.heading)
        return along * dx + across * dy, along * dy - across * dx

    def next_in(self, role: Role) -> TrackedVehicle | None:
        """Return the vehicle that drives next ahead (leading) or behind (rearing) on the lane, or None."""
        return next((n for n in self.neighbours if n.role is role), None)

    def vehicles(self) -> dict[str, TrackedVehicle]:
        """Return the ego vehicle and its neighbours, by id and in the order of the ids."""
        v = self.ego
        routes = ((self.intent.route, self.place), *self.covers)
        ego = TrackedVehicle(
            v.id, v.kind, v.x, v.y, v.speed, v.heading, v.acceleration, v.lane, v.length, routes, self.intent
        )
        return {v.id: v for v in sorted((ego, *self.neighbours), key=lambda v: v.id)}
