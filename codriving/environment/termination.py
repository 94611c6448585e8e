"""Which vehicles have arrived or crashed, and whether the episode is over: the exact outcome."""

from collections.abc import Iterable

from codriving.datatypes import Collision, Ending, Kind, Outcome
from codriving.environment.collisions import find_block_collisions, find_collisions
from codriving.environment.traffic.route_following import RouteFollower
from codriving.environment.traffic.traffic import Traffic


class Termination:
    """Watches one episode and takes vehicles off the road that have arrived, left or been towed away.

    Attributes:
        arrivals: Arrival time of each CAV that has arrived [s], by id. An arrival is latched: nothing takes it back.
    """

    def __init__(self, cavs: Iterable[str], time_limit: float, dt: float) -> None:
        self.arrivals: dict[str, float] = {}
        self._waiting = set(cavs)
        self._time_limit, self._dt = time_limit, dt
        self._bystanders: list[Collision] = []

    def check(self, traffic: Traffic, time: float) -> Outcome | None:
        """Look at the road after a simulation step; return the outcome if the episode is over, else None."""
        collision = self._collide(traffic, time)
        gone = []
        for vehicle in traffic.vehicles:
            if vehicle.s >= vehicle.route_path.route.goal and vehicle.id in self._waiting:
                if vehicle.id in (() if collision is None else (collision.striker, collision.struck)):
                    continue
                self.arrivals[vehicle.id] = time
                self._waiting.discard(vehicle.id)
                gone.append(vehicle)
            elif vehicle.s >= vehicle.route_path.end and traffic.corrections.remove_at_sink:
                gone.append(vehicle)
        lost = tuple(v.id for v in traffic.vehicles if v.id in self._waiting and abs(v.offset - v.shift) > v.lane.width)
        if gone:
            traffic.vehicles = [v for v in traffic.vehicles if v not in gone]
        if collision is not None:
            return self._end(Ending.COLLISION, time, collision)
        if lost:
            return self._end(Ending.OFF_ROAD, time, off_road=lost)
        if not self._waiting:
            return self._end(Ending.SUCCESS, time)
        return self._end(Ending.TIMEOUT, time) if time >= self._time_limit - 1e-9 else None

    def _collide(self, traffic: Traffic, time: float) -> Collision | None:
        """Tow away human drivers that hit each other or a block; return the first collision of a CAV."""
        exact = traffic.corrections.true_collisions
        pair = self._tow(traffic, find_collisions(traffic.vehicles, time, self._dt, exact))
        block = self._tow(traffic, find_block_collisions(traffic.vehicles, traffic.objects, time, exact))
        return pair or block

    def _tow(self, traffic: Traffic, found: list[tuple[tuple[RouteFollower, ...], Collision]]) -> Collision | None:
        first = None
        for vehicles, collision in found:
            if any(v.kind is Kind.CAV for v in vehicles):
                first = first or collision
            else:
                self._bystanders.append(collision)
                traffic.vehicles = [v for v in traffic.vehicles if v not in vehicles]
        return first

    def _end(
        self, ending: Ending, time: float, collision: Collision | None = None, off_road: tuple[str, ...] = ()
    ) -> Outcome:
        return Outcome(ending, time, dict(sorted(self.arrivals.items())), collision, tuple(self._bystanders), off_road)
