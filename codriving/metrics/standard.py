"""Our own metrics: every quantity by its definition, undefined where it does not apply."""

from codriving.datatypes.outcome import Ending, Outcome
from codriving.datatypes.parts import Metric
from codriving.datatypes.score import Score
from codriving.datatypes.trajectory import Trajectory
from codriving.errors import ConfigError
from codriving.geometry.road_map import RoadMap
from codriving.metrics.pet import post_encroachment_times
from codriving.metrics.velocity import travels


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
