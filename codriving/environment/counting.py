"""A flow under way: who leaves, who collides, and when the window is over."""

from collections.abc import Iterable

from codriving.datatypes import Collision, Ending, Flow, FlowArrival, FlowLog, Outcome
from codriving.environment.arrivals import Newcomer
from codriving.environment.collisions import find_block_collisions, find_collisions
from codriving.environment.traffic.traffic import Traffic


class Counting:
    """Watches a flow and takes vehicles off the road: those at the goal of their route, beside the road, or hit.

    Both vehicles of a collision are removed at once, so that the flow goes on; so does SUMO with
    ``--collision.action remove``. What a wreck in the way would cost is not simulated.

    Attributes:
        arrivals: When each vehicle that has left came to the goal of its route [s], by id.
    """

    def __init__(self, flow: Flow, newcomers: Iterable[Newcomer], dt: float) -> None:
        self.arrivals: dict[str, float] = {}
        self._flow, self._dt = flow, dt
        self._wanted = tuple(FlowArrival(n.start.id, n.start.kind, n.time) for n in newcomers)
        self._collisions: list[Collision] = []
        self._lost: list[str] = []

    def check(self, traffic: Traffic, time: float) -> Outcome | None:
        """Look at the road after a simulation step; return the outcome once the window is over, else None."""
        exact = traffic.corrections.true_collisions
        found = find_collisions(traffic.vehicles, time, self._dt, exact)
        found += find_block_collisions(traffic.vehicles, traffic.objects, time, exact)
        self._collisions += [collision for _, collision in found]
        gone = {vehicle.id for vehicles, _ in found for vehicle in vehicles}
        for vehicle in traffic.vehicles:
            if vehicle.id in gone:
                continue
            if vehicle.s >= vehicle.route_path.route.goal:
                self.arrivals[vehicle.id] = time
                gone.add(vehicle.id)
            elif abs(vehicle.offset - vehicle.shift) > vehicle.lane.width:
                self._lost.append(vehicle.id)
                gone.add(vehicle.id)
        if gone:
            traffic.vehicles = [vehicle for vehicle in traffic.vehicles if vehicle.id not in gone]
        if time < self._flow.ends - 1e-9:
            return None
        log = FlowLog(self._flow.warm_up, self._dt, self._wanted, tuple(self._collisions))
        left = dict(sorted(self.arrivals.items()))
        return Outcome(Ending.COUNTED, time, left, off_road=tuple(self._lost), flow=log)
