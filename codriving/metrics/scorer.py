"""A metric with the settings that it was built with, which its scores hold."""

from collections.abc import Iterable
from dataclasses import replace
from typing import NamedTuple

from codriving.datatypes import Metric, Outcome, Road, Score, Simulator, Trajectory
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


def with_alone(trajectory: Trajectory, simulator: Simulator, seed: int, scorers: Iterable[Scorer]) -> Trajectory:
    """Add to a trajectory how each vehicle drives alone, if a metric asks for it."""
    if not any(scorer.metric.against_alone for scorer in scorers):
        return trajectory
    return replace(trajectory, alone=simulator.alone(seed))
