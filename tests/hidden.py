"""Worlds that look the same to a vehicle on its own, and differ in all that it cannot see."""

from dataclasses import replace

import numpy as np

from codriving.datatypes.world import Intent, Kind, WorldState
from codriving.geometry.road_map import RoadMap


def scrambled(world: WorldState, ego: str, road_map: RoadMap, rng: np.random.Generator) -> WorldState:
    """The same world as one vehicle sees it, with kinds, routes, targets, lanes and pedals of all others drawn anew."""
    routes, lanes = sorted(road_map.routes), sorted(road_map.lanes)
    vehicles, intents, available = [], {ego: world.intents[ego]}, {ego: world.available[ego]}
    for v in world.vehicles:
        if v.id == ego:
            vehicles.append(v)
            continue
        kind = Kind.CAV if rng.random() < 0.5 else Kind.HDV
        lane = lanes[rng.integers(len(lanes))]
        vehicles.append(replace(v, kind=kind, lane=lane, acceleration=float(rng.uniform(-5.0, 3.0))))
        if kind is Kind.CAV:
            intents[v.id] = Intent(routes[rng.integers(len(routes))], float(rng.uniform(0.0, 9.0)), lane)
            available[v.id] = world.available[ego]
    return replace(world, vehicles=tuple(vehicles), intents=intents, available=available)
