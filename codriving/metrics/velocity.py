"""Travel velocity, travel time and delay of the CAVs that arrived."""

import numpy as np

from codriving.datatypes.score import TravelScore
from codriving.datatypes.trajectory import Trajectory
from codriving.datatypes.vehicle import Kind
from codriving.geometry.road_map import RoadMap


def travels(trajectory: Trajectory, road: RoadMap, free_speed: float | None = None) -> tuple[TravelScore, ...]:
    """Return how each CAV travelled; one that did not arrive is absent.

    Args:
        free_speed: Speed of free flow that delays are counted against [m/s]; None takes the highest speed limit on
            the route of each CAV.
    """
    scores = []
    for track in trajectory.tracks:
        start = track.first_step * trajectory.step
        if track.kind is not Kind.CAV or track.arrived is None or track.arrived <= start:
            continue
        times = start + trajectory.step * np.arange(len(track.x))
        driven = np.concatenate(([0.0], np.cumsum(np.hypot(np.diff(track.x), np.diff(track.y)))))
        # Up to the arrival only: some vehicles stay on the road for a while after it.
        distance, time = float(np.interp(track.arrived, times, driven)), track.arrived - start
        speed = free_speed or max(road.lanes[lane].speed_limit for lane in road.routes[track.route].lanes)
        scores.append(TravelScore(track.id, distance / time, time, time - distance / speed))
    return tuple(scores)
