"""What one CAV knows of the world around it (paper Section III-C, state sharing and intent sharing)."""

from dataclasses import dataclass
from enum import StrEnum

from codriving.datatypes.road import LaneId
from codriving.datatypes.vehicle import Intent, VehicleState


class Role(StrEnum):
    """What a neighbour is to the ego vehicle."""

    LEADING = "leading"
    REARING = "rearing"
    CONFLICT = "conflict"
    OTHER = "other"


@dataclass(frozen=True, slots=True)
class Neighbour:
    """Another vehicle as far as the ego vehicle knows it; what it does not know is None.

    Attributes:
        kind: ``CAV``, ``HDV``, or None if it cannot tell.
        x: Position [m].
        y: Position [m].
        speed: Speed [m/s].
        heading: Heading [rad].
        acceleration: Acceleration [m/s2].
        length: Vehicle length [m].
        routes: Each route that it may be on, with its arc length there [m]; one entry if it shared its route.
        standing: How long it has been standing [s].
        gap: Free distance along the ego lane for a leading or rearing vehicle [m].
    """

    id: str
    kind: str | None
    x: float
    y: float
    speed: float
    heading: float | None
    acceleration: float | None
    lane: LaneId | None
    length: float
    routes: tuple[tuple[str, float], ...]
    intent: Intent | None
    standing: float
    role: Role
    gap: float | None


@dataclass(frozen=True, slots=True)
class LaneChange:
    """A lane change that the ego vehicle's route asks for.

    Attributes:
        room: Distance within which it has to be begun, since the present lane ends [m].
    """

    lane: LaneId
    room: float


@dataclass(frozen=True, slots=True)
class SceneDescription:
    """The surroundings of one CAV, by lane and by relation.

    Attributes:
        place: Its arc length along its route [m].
        covers: Other routes onto whose lanes its body reaches while it changes lanes, with its arc length there [m].
        must_change: The lane change that its route asks for next, or None.
    """

    ego: VehicleState
    intent: Intent
    place: float
    adjacent_lanes: tuple[LaneId, ...]
    conflict_lanes: tuple[LaneId, ...]
    neighbours: tuple[Neighbour, ...]
    covers: tuple[tuple[str, float], ...] = ()
    must_change: LaneChange | None = None

    def neighbour(self, name: str) -> Neighbour | None:
        """Return a neighbour by id, or None if the ego vehicle does not know of it."""
        return next((n for n in self.neighbours if n.id == name), None)
