"""Travel velocity, time and delay."""

from collections.abc import Callable

import numpy as np
import pytest

from codriving.datatypes.trajectory import Track, Trajectory
from codriving.datatypes.vehicle import Kind
from codriving.geometry.road_map import RoadMap
from codriving.metrics.velocity import travels

Drive = Callable[..., Track]

STEP = 0.1
TIME = np.arange(0, 20, STEP)


def test_velocity_is_path_length_over_time_until_arrival(road: RoadMap, drive: Drive) -> None:
    # 4 m/s for 5 s, then 8 m/s; arrived at 10 s after 60 m, and still on the road afterwards.
    s = np.where(TIME < 5, 4 * TIME, 20 + 8 * (TIME - 5))
    (score,) = travels(Trajectory(STEP, (drive("a", "east", s, arrived=10.0),)), road)
    assert (score.id, score.time) == ("a", 10.0)
    assert score.velocity == pytest.approx(6.0)
    assert score.delay == pytest.approx(10 - 60 / 12), "the highest limit on the route is 12 m/s"


def test_free_speed_can_be_given(road: RoadMap, drive: Drive) -> None:
    (score,) = travels(Trajectory(STEP, (drive("a", "east", 6 * TIME, arrived=10.0),)), road, free_speed=6.0)
    assert score.delay == pytest.approx(0, abs=1e-9)


def test_arrival_between_two_rows_and_a_late_start(road: RoadMap, drive: Drive) -> None:
    track = drive("a", "north", 5 * TIME, arrived=4.05, first_step=10)
    (score,) = travels(Trajectory(STEP, (track,)), road)
    assert score.time == pytest.approx(3.05)
    assert score.velocity == pytest.approx(5.0)


def test_those_who_did_not_arrive_and_human_drivers_are_absent(road: RoadMap, drive: Drive) -> None:
    tracks = (
        drive("a", "east", 5 * TIME),
        drive("b", "east", 5 * TIME, kind=Kind.HDV, arrived=10.0),
        drive("c", "east", 5 * TIME, arrived=0.0),
    )
    assert travels(Trajectory(STEP, tracks), road) == ()


def test_curves_are_measured_along_the_way_driven(road: RoadMap, drive: Drive) -> None:
    path = road.paths["merge"]
    s = np.linspace(0, path.length, len(TIME))
    (score,) = travels(Trajectory(STEP, (drive("a", "merge", s, arrived=TIME[-1]),)), road)
    assert score.velocity == pytest.approx(path.length / TIME[-1], rel=1e-3)
