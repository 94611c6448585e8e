"""What a driver with a style sees of the others, how late, and at which line it waits for them."""

from bisect import bisect_right
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from codriving.environment.drivers.body import Body, body
from codriving.environment.drivers.style import DriverTraits
from codriving.environment.traffic.hidden import Hidden
from codriving.environment.traffic.right_of_way import (
    OVERSHOOT,
    Ahead,
    Spot,
    can_wait,
    meet,
    occupied_by,
    stops_before_junction,
)
from codriving.environment.traffic.route_following import RouteFollower
from codriving.geometry import RoadMap

STANDS = 0.5  # Slower vehicles stand, in the eyes of others and by their own watch [m/s]

# A vehicle is taken to be on a route if it is no farther beside it [m] and no more turned against it [rad].
BESIDE, TURNED = 1.5, 0.35

TIMES = np.arange(0.25, 6.01, 0.25)  # Times at which a driver looks whether it would meet another vehicle [s]

LONGEST = 3.0  # Reactions take no longer [s]


# Where a vehicle was [m, m], its heading [rad] with cosine and sine, and its speed [m/s].
_Place = tuple[float, float, float, float, float, float]


class Past:
    """Where all vehicles were in the last seconds."""

    def __init__(self) -> None:
        self._steps: deque[tuple[dict[RouteFollower, _Place], Hidden]] = deque()
        self._dt = 1.0

    def note(self, vehicles: Sequence[RouteFollower], dt: float, hidden: Hidden) -> None:
        """Remember where they are and who sees whom, before a simulation step [s]."""
        self._dt = dt
        places = {v: (*v.position.tolist(), float(v.heading), *v.facing(), float(v.speed)) for v in vehicles}
        self._steps.append((places, hidden))
        while len(self._steps) * dt > LONGEST:
            self._steps.popleft()

    def seen(
        self, driver: RouteFollower, vehicles: Sequence[RouteFollower], reaction: float, hidden: Hidden
    ) -> list[Body]:
        """Return the others as a driver sees them, whose reaction takes some time [s]; `hidden` is as it is now.

        Each is where it would be if it had gone straight on at its speed since.
        """
        ago = min(round(reaction / self._dt), len(self._steps))
        then, hidden = self._steps[-ago] if ago else ({}, hidden)
        unseen, age = hidden.get(driver, frozenset()), ago * self._dt
        found: list[Body] = []
        for vehicle in vehicles:
            if vehicle is driver or vehicle in unseen:
                continue
            place = then.get(vehicle)
            if place is None:
                found.append(body(vehicle))
                continue
            x, y, heading, cos, sin, speed = place
            way = speed * age
            found.append((vehicle, x + way * cos, y + way * sin, heading, speed))
        return found


@dataclass(frozen=True, slots=True)
class Look:
    """What a driver makes of what it sees: where it ought to wait."""

    for_others: bool  # Before the junction, for those who cross its way
    occupied: float | None  # Before an occupied conflict zone, at this arc length [m]


class DriverJudgement:
    """The right of way as one driver sees it, a reaction time late."""

    def __init__(self, traits: DriverTraits) -> None:
        self.traits = traits
        self.stood = 0.0  # How long it has stood and waited [s]
        self._looks: deque[Look] = deque()
        # Whether it still waits although it may go first; and for those who stand.
        self.hesitates, self._waits_on = traits.hesitation > 0, True

    def watch(self, driver: RouteFollower, dt: float) -> None:
        """Note how long the driver has stood at a line."""
        if driver.waits_at is None or driver.speed >= STANDS:
            self.stood = 0.0
            return
        self.stood += dt
        # Once it has gone on for this reason it does not stop again for the same.
        self.hesitates = self.hesitates and self.stood < self.traits.hesitation
        self._waits_on = self._waits_on and self.stood < self.traits.patience

    def line(self, driver: RouteFollower, others: Sequence[Ahead], road_map: RoadMap, every: float) -> float | None:
        """Look, as it does from time to time [s], and return the arc length at which it waits for what it saw [m]."""
        around = [other for other in others if other.vehicle is not driver]
        if not self._waits_on:
            around = [other for other in around if other.vehicle.speed >= STANDS]
        occupied = occupied_by(road_map, driver, ((other.route, other.s) for other in around))
        self._looks.append(Look(self._waits(driver, around, road_map), occupied))
        late = round((self.traits.reaction + self.traits.distraction) / every)
        while len(self._looks) > late + 1:
            self._looks.popleft()
        crossing = self._looks[0]
        occupied = self._looks[-1 - min(round(self.traits.reaction / every), len(self._looks) - 1)].occupied
        if crossing.for_others and can_wait(driver):
            entry: float = driver.route_path.route.entry
            return entry
        stop = driver.s + driver.speed**2 / (2 * driver.ACC_MAX)
        if occupied is not None and stop < occupied + OVERSHOOT:
            return occupied + float(driver.DISTANCE_WANTED) - float(driver.LENGTH) / 2
        return None

    def _waits(self, driver: RouteFollower, others: Sequence[Ahead], road_map: RoadMap) -> bool:
        if self.traits.gives_way == "never" or not driver.s < driver.route_path.route.entry:
            return False
        count, own = bisect_right(TIMES, self.traits.horizon), Ahead(driver, TIMES)
        return any(
            meet(road_map, own, other, count)
            and self._gives_way(driver, other.vehicle, (other.route, other.s), road_map)
            for other in others
        )

    def _gives_way(self, driver: RouteFollower, other: RouteFollower, spot: Spot, road_map: RoadMap) -> bool:
        """Whether the driver waits for a vehicle that it would meet."""
        rank = road_map.lanes[road_map.lane_at(*spot)].priority - driver.lane.priority
        farther = driver.front_distance_to(other) > other.front_distance_to(driver)
        if rank > 0 or (rank == 0 and farther and self.traits.gives_way == "by_rule"):
            return True
        # It goes first, but the other one is in the junction, or cannot stop before it any more.
        if not stops_before_junction(other, driver.ACC_MAX):
            return True
        return self.hesitates and other.speed >= STANDS


def believed(road_map: RoadMap, vehicle: RouteFollower) -> Spot:
    """Return the route on which others take a vehicle to be, by its place, its heading and its turn signal.

    Without a signal it is taken to go straight on until it is seen to turn, and where several routes do, to stay long.
    """
    x, y = vehicle.position.tolist()
    near = road_map.nearby.routes(x, y, float(vehicle.heading), BESIDE, TURNED)
    told = road_map.signals.agreeing(near, vehicle.signal) or near
    return max(
        told,
        key=lambda spot: (road_map.paths[spot[0]].length - spot[1], spot[0]),
        default=(vehicle.route_path.route.id, vehicle.s),
    )


def look_round(road_map: RoadMap, vehicles: Sequence[RouteFollower], every: float, hidden: Hidden) -> None:
    """Let every driver with a style look round, as they do from time to time [s], and decide where it waits."""
    around = []
    for vehicle in vehicles:
        around.append(Ahead(vehicle, TIMES, believed(road_map, vehicle)))
    for vehicle in vehicles:
        judgement: DriverJudgement | None = getattr(vehicle, "judgement", None)
        if judgement is None:
            continue
        waited = vehicle.waits_at is not None
        unseen = hidden.get(vehicle, frozenset())
        seen = [other for other in around if other.vehicle not in unseen] if unseen else around
        vehicle.waits_at = judgement.line(vehicle, seen, road_map, every)
        if waited and vehicle.waits_at is None:
            vehicle.target_speed = vehicle.lane.speed_limit * judgement.traits.speed
