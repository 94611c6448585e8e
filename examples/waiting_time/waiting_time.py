"""A metric of one's own: how long the CAVs stood, and how close two vehicles came to one another."""

from itertools import combinations

import numpy as np

from codriving.datatypes.parts import Metric
from codriving.datatypes.record import Ending, NamedNumber, Outcome, Score, Trajectory
from codriving.datatypes.world import Kind
from codriving.geometry.road_map import RoadMap


class WaitingTime(Metric):
    """Total time that CAVs stood, and the smallest distance between the centres of two vehicles.

    Args:
        standing: Below this speed a CAV stands [m/s].
    """

    name = "waiting_time"

    def __init__(self, standing: float) -> None:
        self.standing = standing

    def score(self, trajectory: Trajectory, outcome: Outcome, road: RoadMap) -> Score:
        """Return the score of an episode."""
        cavs = [track for track in trajectory.tracks if track.kind is Kind.CAV]
        waited = sum(int((track.speed < self.standing).sum()) for track in cavs) * trajectory.step
        return Score(
            success=outcome.ending is Ending.SUCCESS,
            numbers=(
                NamedNumber("waiting_time", waited, "s", better="lower", shown=True),
                # Undefined is not zero: of fewer than two vehicles there is none.
                NamedNumber("smallest_distance", _smallest_distance(trajectory), "m", better="higher"),
            ),
        )


def _smallest_distance(trajectory: Trajectory) -> float | None:
    found = []
    for one, other in combinations(trajectory.tracks, 2):
        first = max(one.first_step, other.first_step)
        last = min(one.first_step + len(one.x), other.first_step + len(other.x))
        if first < last:
            a, b = (slice(first - track.first_step, last - track.first_step) for track in (one, other))
            found.append(float(np.hypot(one.x[a] - other.x[b], one.y[a] - other.y[b]).min()))
    return min(found, default=None)
