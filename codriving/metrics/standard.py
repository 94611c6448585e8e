"""Our own metrics: every quantity by its definition, undefined where it does not apply."""

import numpy as np

from codriving.datatypes import Ending, Kind, Metric, Outcome, Score, Trajectory, TravelScore
from codriving.errors import ConfigError
from codriving.geometry import RoadMap
from codriving.metrics.pet import post_encroachment_times


class StandardMetrics(Metric):
    """Success, post-encroachment time of the true footprints, and travel velocity of the CAVs (paper Section IV-A)."""

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
    """Return how each CAV travelled; one that did not arrive is absent."""
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
