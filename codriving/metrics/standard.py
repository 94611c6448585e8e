"""Our own metrics: every quantity by its definition, undefined where it does not apply."""

import numpy as np

from codriving.datatypes.parts import Metric
from codriving.datatypes.record import Ending, Outcome, Score, Trajectory, TravelScore
from codriving.datatypes.world import Kind
from codriving.errors import ConfigError
from codriving.geometry.road_map import RoadMap
from codriving.metrics.pet import post_encroachment_times


class StandardMetrics(Metric):
    """Success, post-encroachment time of the true footprints, and travel velocity of the CAVs (paper Section IV-A).

    Args:
        free_speed: Speed of free flow that delays are counted against [m/s]; None takes the highest speed limit on
            the route of each CAV.

    Raises:
        ConfigError: If the free speed is not positive.
    """

    name = "standard"

    def __init__(self, free_speed: float | None = None) -> None:
        if free_speed is not None and not free_speed > 0:
            raise ConfigError(
                f"metrics.free_speed must be > 0 m/s, got {free_speed:g}; leave it null for the speed limits"
            )
        self.free_speed = free_speed

    def score(self, trajectory: Trajectory, outcome: Outcome, road: RoadMap) -> Score:
        """Return the score of an episode."""
        return Score(
            success=outcome.ending is Ending.SUCCESS,
            pets=post_encroachment_times(trajectory, road),
            travels=travels(trajectory, road, self.free_speed),
        )


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
