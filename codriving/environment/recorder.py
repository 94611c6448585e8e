"""The simulator's state becomes data: a row a vehicle and simulation step, a world state a decision."""

from dataclasses import dataclass, field

import numpy as np

from codriving.datatypes.record import Track, Trajectory
from codriving.datatypes.road import LaneId
from codriving.datatypes.world import Intent, Kind, VehicleState, WorldState
from codriving.environment.cav import ConnectedVehicle
from codriving.environment.traffic.route_following import RouteFollower
from codriving.environment.traffic.traffic import Traffic


@dataclass(slots=True)
class _Log:
    first_step: int
    kind: Kind
    route: str
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
                log = self.logs[v.id] = _Log(step, v.kind, v.route_path.route.id)
            x, y = v.position
            log.rows.append((float(x), float(y), float(v.heading), float(v.speed), acceleration(v)))
            log.actions.append(actions.get(v.id, ""))

    def trajectory(self, step: float, arrivals: dict[str, float]) -> Trajectory:
        """Return what was recorded with a simulation step [s], and when vehicles arrived [s]."""
        tracks = []
        for name in sorted(self.logs):
            log = self.logs[name]
            x, y, heading, speed, accelerations = np.array(log.rows).T
            tracks.append(
                Track(
                    id=name,
                    kind=log.kind,
                    route=log.route,
                    first_step=log.first_step,
                    x=x,
                    y=y,
                    heading=heading,
                    speed=speed,
                    acceleration=accelerations,
                    action=tuple(log.actions),
                    arrived=arrivals.get(name),
                )
            )
        return Trajectory(step=step, tracks=tuple(tracks))


def acceleration(vehicle: RouteFollower) -> float:
    """Return the acceleration commanded in the last simulation step [m/s2]."""
    return float(vehicle.action["acceleration"])


def state_of(vehicle: RouteFollower) -> VehicleState:
    """Copy the physical state of one vehicle."""
    return VehicleState(
        id=vehicle.id,
        kind=vehicle.kind,
        x=float(vehicle.position[0]),
        y=float(vehicle.position[1]),
        heading=float(vehicle.heading),
        speed=float(vehicle.speed),
        acceleration=acceleration(vehicle),
        lane=_plain(vehicle.lane_index),
        length=vehicle.LENGTH,
        width=vehicle.WIDTH,
    )


def snapshot(traffic: Traffic, time: float, step: int) -> WorldState:
    """Copy what a method may know of the world; nothing of the simulator leaves with it."""
    vehicles = sorted(traffic.vehicles, key=lambda v: v.id)
    cavs = [v for v in vehicles if isinstance(v, ConnectedVehicle)]
    return WorldState(
        time=time,
        step=step,
        vehicles=tuple(state_of(v) for v in vehicles),
        intents={v.id: Intent(v.route_path.route.id, float(v.target_speed), _plain(v.target_lane_index)) for v in cavs},
        available={v.id: v.available() for v in cavs},
    )


def _plain(lane: LaneId) -> LaneId:
    """A lane id without numpy's integers, which highway-env leaves after a lane change."""
    return lane[0], lane[1], int(lane[2])
