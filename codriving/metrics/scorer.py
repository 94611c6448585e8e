"""A metric with the settings that it was built with, which its scores hold."""

from dataclasses import replace
from typing import NamedTuple

from codriving.datatypes import Metric, Outcome, Road, Score, Trajectory
from codriving.geometry import RoadMap, road_map


class Scorer(NamedTuple):
    """A metric and its settings, as JSON by key."""

    metric: Metric
    settings: dict[str, str]

    def score(self, trajectory: Trajectory, outcome: Outcome, road: RoadMap) -> Score:
        """Return the score of an episode, and with what settings it was measured."""
        return replace(self.metric.score(trajectory, outcome, road), settings=self.settings)

    def score_stored(self, trajectory: Trajectory, outcome: Outcome, road: Road) -> Score:
        """Return the score of an episode that was driven on a road, without its environment."""
        return self.score(trajectory, outcome, road_map(road))
