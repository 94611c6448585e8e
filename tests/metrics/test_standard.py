"""Our metrics as a whole."""

from collections.abc import Callable

import numpy as np
import pytest

from codriving.datatypes.outcome import Ending, Outcome
from codriving.datatypes.parts import Metric
from codriving.datatypes.trajectory import Track, Trajectory
from codriving.errors import ConfigError
from codriving.geometry.road_map import RoadMap
from codriving.metrics.standard import StandardMetrics

Drive = Callable[..., Track]

TIME = np.arange(0, 20, 0.1)


@pytest.mark.parametrize("ending", list(Ending))
def test_only_success_is_success(road: RoadMap, drive: Drive, ending: Ending) -> None:
    metrics: Metric = StandardMetrics()
    trajectory = Trajectory(0.1, (drive("a", "east", 6 * TIME, arrived=15.0),))
    score = metrics.score(trajectory, Outcome(ending, 15.0, {"a": 15.0}), road)
    assert score.success == (ending is Ending.SUCCESS)
    assert [travel.id for travel in score.travels] == ["a"]
    assert score.pets == ()


def test_it_reports_pairs_and_travels(road: RoadMap, drive: Drive) -> None:
    tracks = (drive("a", "east", 6 * TIME, arrived=15.0), drive("b", "north", 5 * TIME, arrived=18.0))
    outcome = Outcome(Ending.SUCCESS, 18.0, {"a": 15.0, "b": 18.0})
    score = StandardMetrics(free_speed=6.0).score(Trajectory(0.1, tracks), outcome, road)
    assert [(pet.first, pet.second) for pet in score.pets] == [("a", "b")]
    assert [travel.velocity for travel in score.travels] == pytest.approx([6, 5])
    assert [travel.delay for travel in score.travels] == pytest.approx([0, 3])


@pytest.mark.parametrize("speed", [0.0, -1.0, float("nan")])
def test_free_speed_must_be_positive(speed: float) -> None:
    with pytest.raises(ConfigError, match="free_speed must be > 0"):
        StandardMetrics(free_speed=speed)
