"""What every set of metrics can do."""

from typing import Protocol

from codriving.datatypes.outcome import Outcome
from codriving.datatypes.score import Score
from codriving.datatypes.trajectory import Trajectory
from codriving.geometry.road_map import RoadMap


class Metrics(Protocol):
    """Judges one driven episode."""

    name: str

    def score(self, trajectory: Trajectory, outcome: Outcome, road: RoadMap) -> Score:
        """Return the score of an episode."""
        ...
