"""Delay against driving alone, and fairness, worked out by hand."""

from collections.abc import Callable

import numpy as np
import pytest

from codriving.datatypes.record import Track, Trajectory
from codriving.datatypes.world import Kind
from codriving.geometry.road_map import RoadMap
from codriving.metrics.delay import TimedDrive, drives, jain

Drive = Callable[..., Track]

TIME = np.arange(0, 25, 0.1)


def test_delay_is_the_time_beyond_that_of_driving_alone(road: RoadMap, drive: Drive) -> None:
    """To the goal at 110 m: 5 m/s takes 22 s, alone at 10 m/s 11 s; the delay is 11 s and the whole time 22 s."""
    (found,) = drives(Trajectory(0.1, (drive("a", "east", 5 * TIME),), {"a": 10 * TIME}), road)
    assert found == TimedDrive(Kind.CAV, *(pytest.approx(v, abs=0.05) for v in (22, 11, 11)))
    assert found.delay == pytest.approx(11, abs=0.05)
    assert found.whole == pytest.approx(22, abs=0.05)


def test_a_human_driver_counts_to_the_goal_and_not_to_the_end_of_its_road(road: RoadMap, drive: Drive) -> None:
    """The goal at 110 m after 11 s at 10 m/s; it drives on to 120 m, where it stands until 25 s."""
    track = drive("a", "east", np.minimum(10 * TIME, 120), kind=Kind.HDV)
    (found,) = drives(Trajectory(0.1, (track,), {"a": 10 * TIME}), road)
    assert (found.time, found.delay) == pytest.approx((11, 0), abs=0.05)


def test_one_that_has_not_arrived_counts_as_far_as_it_got(road: RoadMap, drive: Drive) -> None:
    """10 s at 5 m/s are 50 m, alone 5 s: 5 s late. The 60 m left take alone 6 s, so the whole time is 16 s."""
    track = drive("a", "east", 5 * TIME[:101], kind=Kind.HDV)
    (found,) = drives(Trajectory(0.1, (track,), {"a": 10 * TIME}), road)
    assert (found.time, found.delay, found.whole) == pytest.approx((10, 5, 16), abs=0.05)


def test_one_that_stands_all_the_time_is_late_by_all_of_it(road: RoadMap, drive: Drive) -> None:
    track = drive("a", "east", 20 + 0 * TIME[:101], kind=Kind.HDV)
    (found,) = drives(Trajectory(0.1, (track,), {"a": 20 + 10 * TIME}), road)
    assert (found.time, found.alone, found.delay) == pytest.approx((10, 0, 10), abs=0.05)


def test_undefined_without_a_drive_alone_to_the_goal(road: RoadMap, drive: Drive) -> None:
    track = drive("a", "east", 5 * TIME)
    assert drives(Trajectory(0.1, (track,)), road) == ()
    assert drives(Trajectory(0.1, (track,), {"a": 4 * TIME}), road) == ()


@pytest.mark.parametrize(
    ("shares", "index"),
    [([1, 1, 1], 1), ([1, 0], 0.5), ([0, 0], 1), ([0.5], 1), ([1, 0.5], 0.9), ([1, 1, 0, 0], 0.5)],
)
def test_jains_index(shares: list[float], index: float) -> None:
    """(1 + 0.5)^2 / (2 x (1 + 0.25)) = 0.9; if k of n share alike and the others get nothing it is k / n."""
    assert jain(shares) == pytest.approx(index)


def test_without_vehicles_there_is_no_fairness() -> None:
    assert jain([]) is None
