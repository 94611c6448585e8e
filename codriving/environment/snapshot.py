"""The simulator's state becomes a world state; nothing of the simulator leaves with it."""

from codriving.datatypes.road import LaneId
from codriving.datatypes.vehicle import Intent, Kind, VehicleState
from codriving.datatypes.world import WorldState
from codriving.environment.cav import ConnectedVehicle
from codriving.environment.recorder import acceleration
from codriving.environment.traffic.on_way import OnWay
from codriving.environment.traffic.traffic import Traffic


def state_of(vehicle: OnWay) -> VehicleState:
    """Copy the physical state of one vehicle."""
    return VehicleState(
        id=vehicle.id,
        kind=Kind.CAV if isinstance(vehicle, ConnectedVehicle) else Kind.HDV,
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
    """Copy what a method may know of the world.

    Args:
        time: Simulated time [s].
    """
    vehicles = sorted(traffic.vehicles, key=lambda v: v.id)
    cavs = [v for v in vehicles if isinstance(v, ConnectedVehicle)]
    return WorldState(
        time=time,
        step=step,
        vehicles=tuple(state_of(v) for v in vehicles),
        intents={v.id: Intent(v.way.route.id, float(v.target_speed), _plain(v.target_lane_index)) for v in cavs},
        available={v.id: v.available() for v in cavs},
    )


def _plain(lane: LaneId) -> LaneId:
    """A lane id without numpy's integers, which highway-env leaves after a lane change."""
    return lane[0], lane[1], int(lane[2])
