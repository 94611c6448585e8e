"""The leader and the conflicts of one CAV as features, the most urgent first."""

from collections.abc import Collection, Iterable, Iterator, Sequence
from math import cos, hypot

import numpy as np

from codriving.datatypes import Action, Intent, LaneId, Relation, Straight, TrackedVehicle, VehicleState
from codriving.geometry import TRUE, Path, RoadMap, lane_path
from codriving.methods.learned.layout import FAR, NEAR, SIDE, SLOT, SLOTS
from codriving.reasoning import ALIGNED, SAME_LANE, is_open, ttcp

FORESIGHT = 1.0  # A human driver is expected to go on accelerating or braking for this long [s]

LEANS = 0.6  # A body that comes this near to a lane counts as being on it [m]; drivers who change lanes are seen early

# A gap beside is free if it is longer than this [m], and this much longer for each m/s of closing speed [s].
STANDSTILL, HEADWAY = 3.0, 0.5

Ahead = tuple[float, TrackedVehicle] | None


class Beside:
    """Looks at the own lane and at the lanes beside it, in coordinates of the lane that is steered for."""

    def __init__(self, road_map: RoadMap, top: float) -> None:
        self._road_map, self._top = road_map, top
        self._paths: dict[LaneId, Path] = {}

    def look(
        self,
        ego: VehicleState,
        intent: Intent,
        place: float,
        others: Sequence[TrackedVehicle],
        available: Collection[Action],
    ) -> tuple[Ahead, list[float]]:
        """Return who is next ahead with the gap [m], and the numbers of ``SIDES`` and ``LANE_CHANGE``."""
        lane = intent.target_lane
        (own, offset), *places = self._along(lane, [(ego.x, ego.y), *((o.x, o.y) for o in others)])
        width = self._road_map.lanes[lane].width
        reach = width / 2 + TRUE.width / 2 + LEANS
        found: dict[tuple[int, bool], tuple[float, TrackedVehicle]] = {}
        for other, (s, side) in zip(others, places, strict=True):
            ahead = s > own
            gap = abs(s - own) - (other.length + ego.length) / 2
            # On the lane that is steered for, or in the way of a body that has not left its own yet.
            sides = [k for k in (-1, 0, 1) if abs(side - k * width) < reach]
            if 0 not in sides and abs(side - offset) < TRUE.width + LEANS:
                sides.append(0)
            for k in sides:
                if (k, ahead) not in found or gap < found[k, ahead][0]:
                    found[k, ahead] = gap, other
        numbers: list[float] = []
        for k in (-1, 1):
            exists = (lane[0], lane[1], lane[2] + k) in self._road_map.lanes
            for ahead in (True, False):
                numbers += self._side(ego, found.get((k, ahead)) if exists else None)
        allowed = [Action.LANE_LEFT in available, Action.LANE_RIGHT in available]
        free = [a and _free(ego, found, k) for k, a in zip((-1, 1), allowed, strict=True)]
        numbers += [float(value) for value in (*allowed, *free)]
        behind = found.get((0, False))
        rear = 1.0 if behind is None else behind[0] / (NEAR * self._top)
        numbers += [*self._must(intent, place, lane), offset / width, rear]
        return found.get((0, True)), numbers

    def _along(self, lane: LaneId, places: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
        """Return arc length and lateral offset of places on a lane, which goes straight on beyond its ends [m]."""
        shape = self._road_map.lanes[lane].shape
        if isinstance(shape, Straight):
            # Most lanes are, and this is read for every vehicle in every step.
            (x0, y0), (x1, y1) = shape.start, shape.end
            length = hypot(x1 - x0, y1 - y0)
            cos, sin = (x1 - x0) / length, (y1 - y0) / length
            return [((x - x0) * cos + (y - y0) * sin, (y - y0) * cos - (x - x0) * sin) for x, y in places]
        if lane not in self._paths:
            self._paths[lane] = lane_path(self._road_map.lanes[lane])
        return self._paths[lane].project_all(*np.array(places).T)

    def _side(self, ego: VehicleState, found: tuple[float, TrackedVehicle] | None) -> list[float]:
        if found is None:
            return [0.0] * len(SIDE)
        gap, other = found
        return [gap / (NEAR * self._top), (other.speed - ego.speed) / self._top, 1.0]

    def _must(self, intent: Intent, place: float, lane: LaneId) -> list[float]:
        """Return the side to which the route asks to change, and the way left for it; zeros if it does not."""
        change = self._road_map.changes.ahead(intent.route, place)
        if change is None or change[0] == lane:
            return [0.0, 0.0]
        target, _, ends = change
        ending = next(k for k in self._road_map.routes[intent.route].lanes if k[:2] == target[:2])
        return [float(target[2] - ending[2]), (ends - place) / (FAR * self._top)]


def _free(ego: VehicleState, found: dict[tuple[int, bool], tuple[float, TrackedVehicle]], side: int) -> bool:
    """Whether there is room on the lane beside, ahead and behind."""
    for ahead in (True, False):
        if (side, ahead) in found:
            gap, other = found[side, ahead]
            closing = ego.speed - other.speed if ahead else other.speed - ego.speed
            if gap < STANDSTILL + HEADWAY * max(closing, 0.0):
                return False
    return True


LEADER_URGENCY = 10.0  # Gap to a leader that counts as one unit of urgency [m]

# The first number of a slot: whether the CAV goes first by the rules of the road; 1 where there are none.
GOES_FIRST, EQUAL, GIVES_WAY = 1.0, 0.6, 0.2

Slot = tuple[float, tuple[float, ...]]  # Urgency, the smaller the more urgent, and the numbers


def leader_ahead(
    ego: VehicleState, route: str, place: float, others: Iterable[TrackedVehicle], road_map: RoadMap
) -> Ahead:
    """Return who drives next ahead on the own route, and the gap from bumper to bumper [m]."""
    path = road_map.paths[route]
    nearest: Ahead = None
    for other in others:
        s, side = road_map.project(route, other.x, other.y)
        if other.heading is None or s <= place or abs(side) > SAME_LANE:
            continue
        if cos(other.heading - path.place(s)[2]) <= ALIGNED:
            continue
        gap = s - place - (other.length + ego.length) / 2
        if nearest is None or gap < nearest[0]:
            nearest = gap, other
    return nearest


def leader_slot(gap: float, other: TrackedVehicle, top: float) -> Slot:
    """Return a leader as a slot."""
    x = gap / (NEAR * top)
    speeds = other.speed / top, target_of(other) / top
    return gap / LEADER_URGENCY, (1.0, float(other.is_cav), 1.0, 0.0, x, x, 0.0, *speeds)


def target_of(other: TrackedVehicle) -> float:
    """Return the speed that a vehicle is bound for [m/s]; 0 where nothing is known of it."""
    if other.intent is not None:
        return other.intent.target_speed
    return 0.0 if other.acceleration is None else max(other.speed + FORESIGHT * other.acceleration, 0.0)


def precedence(own: int | None, other: int | None) -> float:
    """Say whether a CAV goes before another vehicle by the rules of the road; human drivers keep to them."""
    if own is None or other is None or own > other:
        return GOES_FIRST
    return EQUAL if own == other else GIVES_WAY


def conflict_slots(
    ego: VehicleState,
    route: str,
    place: float,
    others: Iterable[TrackedVehicle],
    road_map: RoadMap,
    top: float,
    priority: int | None = None,
) -> Iterator[Slot]:
    """Yield the most urgent open conflict with each of the others, as a slot.

    Of a vehicle that may take several routes the most urgent zone counts.
    """
    near, far = NEAR * top, FAR * top
    for other in others:
        best: Slot | None = None
        for theirs, at in other.routes:
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
                    # The rank of the lane on which it would be: its true lane tells a turn that is not seen yet.
                    rank = precedence(priority, road_map.lanes[road_map.lane_at(theirs, at)].priority)
                    speeds = other.speed / top, target_of(other) / top
                    best = urgency, (rank, float(other.is_cav), 0.0, crossing, *ways, *speeds)
        if best is not None:
            yield best


def filled(slots: Iterable[Slot]) -> list[float]:
    """Return the numbers of the most urgent slots; zeros where there are fewer."""
    chosen = sorted(slots, key=lambda slot: slot[0])[:SLOTS]
    numbers = [number for _, values in chosen for number in values]
    return numbers + [0.0] * (SLOTS * len(SLOT) - len(numbers))
