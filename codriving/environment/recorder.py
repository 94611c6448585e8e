"""Writes down where everybody is after every simulation step."""

from dataclasses import dataclass, field

import numpy as np

from codriving.datatypes.trajectory import Track, Trajectory
from codriving.datatypes.vehicle import Kind
from codriving.environment.cav import ConnectedVehicle
from codriving.environment.traffic.on_way import OnWay


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

    def record(self, step: int, vehicles: list[OnWay], actions: dict[str, str]) -> None:
        """Add one row a vehicle."""
        for v in vehicles:
            log = self.logs.get(v.id)
            if log is None:
                kind = Kind.CAV if isinstance(v, ConnectedVehicle) else Kind.HDV
                log = self.logs[v.id] = _Log(step, kind, v.way.route.id)
            log.rows.append(
                (float(v.position[0]), float(v.position[1]), float(v.heading), float(v.speed), acceleration(v))
            )
            log.actions.append(actions.get(v.id, ""))

    def trajectory(self, step: float, arrivals: dict[str, float]) -> Trajectory:
        """Return what was recorded.

        Args:
            step: Simulation step [s].
            arrivals: Arrival time of each vehicle that arrived [s].
        """
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


def acceleration(vehicle: OnWay) -> float:
    """Return the acceleration commanded in the last simulation step.

    Returns:
        Acceleration [m/s2].
    """
    return float(vehicle.action["acceleration"])
