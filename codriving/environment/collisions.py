"""Collisions by the true footprints, and who struck whom."""

from itertools import combinations

from highway_env.vehicle.objects import RoadObject

from codriving.datatypes.outcome import Collision
from codriving.environment.cav import ConnectedVehicle
from codriving.environment.striker import who_struck
from codriving.environment.traffic.on_way import OnWay
from codriving.geometry.box import corners, overlap

PUSHED = 3.0
"""How far highway-env pushes two crashed cars apart at most [m]."""


def kind(vehicle: OnWay) -> str:
    """Return ``CAV`` or ``HDV``."""
    return "CAV" if isinstance(vehicle, ConnectedVehicle) else "HDV"


def find_collisions(
    vehicles: list[OnWay], time: float, dt: float, by_footprint: bool
) -> list[tuple[OnWay, OnWay, Collision]]:
    """Find every pair of vehicles that have collided.

    Args:
        time: Present time, for the record [s].
        dt: Time since this was last asked [s].
    """
    found = []
    pushed = 0.0 if by_footprint else PUSHED
    placed = [(vehicle, *vehicle.position.tolist(), float(vehicle.diagonal) / 2) for vehicle in vehicles]
    for (one, x, y, half), (other, x2, y2, half2) in combinations(placed, 2):
        dx, dy, reach = x - x2, y - y2, half + half2 + pushed
        if dx * dx + dy * dy > reach * reach:
            continue
        if _overlap(one, other) if by_footprint else one.crashed and other.crashed:
            striker, struck = who_struck(one, other, dt)
            pair = "-".join(sorted((kind(one), kind(other))))
            found.append((striker, struck, Collision(time, striker.id, struck.id, pair)))
    return found


def find_block_collisions(
    vehicles: list[OnWay], obstacles: list[RoadObject], time: float, by_footprint: bool
) -> list[tuple[OnWay, Collision]]:
    """Find every vehicle that has run into something solid that stands on the road.

    Args:
        time: Present time, for the record [s].
    """
    found = []
    for k, obstacle in enumerate(obstacles, start=1):
        for vehicle in vehicles:
            if abs(vehicle.position[0] - obstacle.position[0]) > vehicle.diagonal + obstacle.diagonal:
                continue
            if _overlap(vehicle, obstacle) if by_footprint else vehicle.crashed and obstacle.crashed:
                record = Collision(time, vehicle.id, f"block{k}", f"{kind(vehicle)}-block")
                found.append((vehicle, record))
    return found


def _overlap(one: RoadObject, other: RoadObject) -> bool:
    boxes = [corners(v.position[0], v.position[1], v.heading, v.LENGTH, v.WIDTH) for v in (one, other)]
    return overlap(*boxes)
