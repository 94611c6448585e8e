"""The simulator's state becomes data: a row a vehicle and simulation step, a world state a decision."""

from dataclasses import dataclass, field

import numpy as np

from codriving.datatypes import Intent, Kind, Track, Trajectory, VehicleState, WorldState
from codriving.environment.traffic.route_following import RouteFollower, plain
from codriving.environment.traffic.traffic import Traffic


@dataclass(slots=True)
class _Log:
    first_step: int
    kind: Kind
    route: str
    style: str
    rows: list[tuple[float, float, float, float, float]] = field(default_factory=list)
    actions: list[str] = field(default_factory=list)


class Recorder:
    """Collects rows during an episode and turns them into a trajectory at its end."""

    def __init__(self) -> None:
        self.logs: dict[str, _Log] = {}

    def record(self, step: int, vehicles: list[RouteFollower], actions: dict[str, str]) -> None:
        """Add one row a vehicle."""
        for v in vehicles:
            log = self.logs.get(v.id)
            if log is None:
                log = self.logs[v.id] = _Log(step, v.kind, v.route_path.route.id, v.style)
            log.rows.append((*v.position.tolist(), float(v.heading), float(v.speed), acceleration(v)))
            log.actions.append(actions.get(v.id, ""))

    def trajectory(self, step: float, arrivals: dict[str, float]) -> Trajectory:
        """Return what was recorded with a simulation step [s], and when vehicles arrived [s]."""
        tracks = []
        for name, log in sorted(self.logs.items()):
            x, y, heading, speed, accelerations = np.array(log.rows).T
            motion = (x, y, heading, speed, accelerations, tuple(log.actions))
            arrived = arrivals.get(name)
            tracks.append(Track(name, log.kind, log.route, log.first_step, *motion, arrived, style=log.style))
        return Trajectory(step, tuple(tracks))


def acceleration(vehicle: RouteFollower) -> float:
    """Return the acceleration commanded in the last simulation step [m/s2]."""
    return float(vehicle.action["acceleration"])


def state_of(vehicle: RouteFollower) -> VehicleState:
    """Copy the physical state of one vehicle."""
    x, y = vehicle.position.tolist()
    heading, speed = float(vehicle.heading), float(vehicle.speed)
    lane, size = plain(vehicle.lane_index), (vehicle.LENGTH, vehicle.WIDTH)
    return VehicleState(vehicle.id, vehicle.kind, x, y, heading, speed, acceleration(vehicle), lane, *size)


def snapshot(traffic: Traffic, time: float, step: int) -> WorldState:
    """Copy what a method may know of the world; nothing of the simulator leaves with it."""
    vehicles = sorted(traffic.vehicles, key=lambda v: v.id)
    cavs = [v for v in vehicles if v.kind is Kind.CAV]
    intents = {v.id: Intent(v.route_path.route.id, float(v.target_speed), plain(v.target_lane_index)) for v in cavs}
    states, available = tuple(state_of(v) for v in vehicles), {v.id: v.available() for v in cavs}
    signals = {v.id: v.signal for v in vehicles if v.signal} if traffic.past is not None else {}
    pairs = ((v.id, w.id) for v, unseen in traffic.hidden.items() for w in unseen if v.id < w.id)
    return WorldState(time, step, states, intents, available, signals, tuple(sorted(pairs)))


def human_routes(traffic: Traffic) -> dict[str, str]:
    """Return the route of each human driver, of which none but those who observe the world for them may know."""
    return {v.id: v.route_path.route.id for v in traffic.vehicles if v.kind is Kind.HDV}
