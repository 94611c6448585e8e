"""The others as a vehicle on its own meets them: leaders, zones where ways meet, and who is expected there first."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import cos, pi, sin
from typing import ClassVar

from codriving.datatypes import Conflict, Precedence, Relation, Role, SceneDescription, TrackedVehicle
from codriving.errors import require_range
from codriving.geometry import ConflictZone, Footprint, RoadMap
from codriving.methods.single_vehicle.lane_choice import LaneChoice
from codriving.methods.single_vehicle.method import Driver
from codriving.reasoning import STANDING, Moment, is_behind

FRONT = 2.5  # Distance from the centre of a vehicle to its front [m]

# Size of vehicles that pass by one that stands, at a walking pace and with a small margin [m].
CLOSE = Footprint(5.6, 2.4)

TURN = 1.0  # Time by which those who wait start one after another [s]

SAME = 0.25  # Difference of the times for which two have been standing that does not count [s]

OWN, OTHER = True, False


@dataclass(frozen=True, slots=True)
class Leader:
    """A vehicle, or the end of a lane, that a vehicle must not run into."""

    id: str
    gap: float  # Free distance [m]
    speed: float  # Its speed along the way [m/s]


def leaders(scene: SceneDescription, road_map: RoadMap) -> tuple[Leader, ...]:
    """Return all vehicles ahead, at the smallest gap on any of the ways, in order of id.

    The end of a lane that has to be left stands still.
    """
    ways = ((scene.intent.route, scene.place), *scene.covers)
    found = []
    for n in scene.neighbours:
        bodies = (n.length + scene.ego.length) / 2
        gaps = [ahead - bodies for route, place in n.routes for ahead in _ahead(ways, route, place, road_map)]
        if n.role is Role.LEADING and n.gap is not None:
            gaps.append(n.gap)
        if gaps:
            found.append(Leader(n.id, min(gaps), n.speed))
    if scene.must_change is not None:
        found.append(Leader("the end of the lane", scene.must_change.room - scene.ego.length / 2, 0.0))
    return tuple(found)


def _ahead(ways: tuple[tuple[str, float], ...], route: str, place: float, road_map: RoadMap) -> Iterator[float]:
    """Distances of the centres by which a vehicle on a route is ahead, where it is [m]."""
    for own, here in ways:
        for zone in road_map.zones(own, route):
            if is_behind(zone, here, place):
                yield lead(zone, here, place)


def lead(zone: ConflictZone, place: float, other: float) -> float:
    """Return by how much another vehicle is ahead on a stretch that two routes share [m]; negative if it is behind."""
    if zone.relation in (Relation.FOLLOWING, Relation.DIVERGING) or zone.merge_i is None or zone.merge_j is None:
        return (other - zone.entry_j) - (place - zone.entry_i)
    return (other - zone.merge_j) - (place - zone.merge_i)


@dataclass(frozen=True, slots=True)
class Encounter:
    """A zone ahead of which it is open who goes first, with one of the ways that the other one may take."""

    conflict: Conflict
    other: TrackedVehicle
    zone: ConflictZone
    stops: float  # Distance in which the ego vehicle can stop [m]
    firm: float  # Braking beyond which no vehicle is expected to wait any more [m/s2]

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


def encounters(moment: Moment, ego: str, firm: float) -> tuple[Encounter, ...]:
    """Return everything that is open, most urgent first."""
    scene = moment.scenes[ego]
    stops = float(moment.forecast.reach(scene.ego.speed, True, scene.where).least[-1])
    others = {n.id: n for n in moment.scenes[ego].neighbours}
    zones = moment.road_map.zones
    return tuple(Encounter(c, others[c.other], zones(*c.routes)[c.zone], stops, firm) for c in moment.conflicts[ego])


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
    return None if abs(across) < 0.5 or cos(its - own) > 0.9 else across < 0


def passes_by(e: Encounter, road_map: RoadMap) -> bool:
    """Whether a vehicle passes by the other one where that one stands."""
    place, there = e.conflict.places
    return all(float(zone.front(there)) < place for zone in road_map.zones(*e.conflict.routes, CLOSE))


def goes_first(e: Encounter, road_map: RoadMap, tie: float) -> tuple[bool, str]:
    """Say whether a vehicle goes before another one, and why.

    A vehicle in the zone goes first; then one that can no longer wait while the other one can; then the one that is
    there earlier by more than a tie. A tie is broken by right before left, and by the names of the two.
    """
    c = e.conflict
    if e.inside != e.other_inside:
        return (OWN, "it is there already") if e.inside else (OTHER, f"{c.other} is there already")
    if e.inside:
        ahead = (e.zone.point_i - c.places[0], c.ego) <= (e.zone.point_j - c.places[1], c.other)
        return ahead, "both are there, and " + ("it is ahead" if ahead else f"{c.other} is ahead")
    if e.bound and not e.other_bound:
        return OWN, "it cannot stop before it any more"
    if e.other_bound and not e.bound:
        return OTHER, f"{c.other} cannot be expected to stop"
    earlier = c.ttcp[1] - c.ttcp[0]
    if earlier > tie:
        return OWN, f"it is there {earlier:.1f} s before {c.other}"
    if -earlier > tie:
        return OTHER, f"{c.other} is there {-earlier:.1f} s before"
    right = comes_from_the_right(c, road_map)
    if right is not None:
        return (OTHER, f"{c.other} comes from the right") if right else (OWN, f"{c.other} comes from the left")
    return (c.ego < c.other), "both are there at once, and names decide"


def _lets_start(e: Encounter, moment: Moment, ego: str, clear: float) -> bool:
    if e.other.standing > 0:
        return passes_by(e, moment.road_map)
    if e.other_inside:
        return False
    scene = moment.scenes[ego]
    go = moment.forecast.reach(scene.ego.speed, True, scene.where).most
    return e.conflict.ttcp[1] > moment.forecast.time_to(e.conflict.exits[0], go) + clear


def _stood_longer(standing: float, other: str, waited: float, ego: str) -> bool:
    """Whether a vehicle that stands is to start before a vehicle that has waited for some time as well."""
    return standing > 0 and (standing > waited + SAME or (standing >= waited - SAME and other < ego))


class Patience:
    """Remembers since when each CAV stands."""

    def __init__(self) -> None:
        self._since: dict[str, float] = {}

    def waited(self, name: str, speed: float, time: float) -> float:
        """Return how long a CAV has been standing, now that its speed is known [s]."""
        if speed >= STANDING:
            self._since.pop(name, None)
            return 0.0
        return time - self._since.setdefault(name, time)


@dataclass(kw_only=True, eq=False, repr=False)
class WaitingDriver(Driver):
    """A driver who lets those pass who are first, and starts into an empty zone once it has waited long enough."""

    ranges: ClassVar[Mapping[str, tuple[float, float]]]  # Least and largest value of each setting
    tie: float
    firm: float
    patience: float
    clear: float
    lanes: LaneChoice

    def __post_init__(self) -> None:
        for key, (low, high) in self.ranges.items():
            require_range(key, getattr(self, key), low, high)
        self._patience = Patience()

    def reset(self) -> None:
        """Begin an episode; nothing is remembered from the one before."""
        self._patience = Patience()
        self.lanes.reset()

    def met(self, moment: Moment, ego: str) -> tuple[Encounter, ...]:
        """Return where it is open who goes first, most urgent first."""
        return encounters(moment, ego, self.firm)

    def may_start(self, moment: Moment, ego: str, met: Sequence[Encounter], waited: float) -> bool:
        """Whether the CAV has waited long enough, and the zones ahead are and stay empty until it is through."""
        if not met or waited < self.patience or not all(_lets_start(e, moment, ego, self.clear) for e in met):
            return False
        # Of those who stand, the one that has waited longest starts first; its start is seen before the next one's.
        before = {e.other.id for e in met if _stood_longer(e.other.standing, e.other.id, waited, ego)}
        return waited >= self.patience + TURN * len(before)

    def yields_to(
        self, moment: Moment, ego: str, met: Sequence[Encounter], starts: str = ""
    ) -> tuple[list[tuple[Encounter, str]], tuple[Precedence, ...]]:
        """Return the encounters in which the other one may be there first, each with why, and the order by that."""
        before: list[tuple[Encounter, str]] = []
        precedences: dict[str, Precedence] = {}
        for e in met:
            first, why = goes_first(e, moment.road_map, self.tie)
            other = e.conflict.other
            if first or starts:
                precedences.setdefault(other, Precedence(ego, other, why if first else starts))
                continue
            before.append((e, why))
            if other not in precedences or precedences[other].first == ego:
                precedences[other] = Precedence(other, ego, why)
        return before, tuple(precedences.values())
