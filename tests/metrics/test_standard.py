"""Our metrics as a whole."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from codriving.datatypes.parts import Metric
from codriving.datatypes.record import Ending, Outcome, Track, Trajectory
from codriving.datatypes.world import Kind
from codriving.errors import ConfigError
from codriving.geometry.road_map import RoadMap
from codriving.metrics.standard import StandardMetrics, travels

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


STEP = 0.1
TIMES = np.arange(0, 20, STEP)


def test_velocity_is_path_length_over_time_until_arrival(road: RoadMap, drive: Drive) -> None:
    # 4 m/s for 5 s, then 8 m/s; arrived at 10 s after 60 m, and still on the road afterwards.
    s = np.where(TIMES < 5, 4 * TIMES, 20 + 8 * (TIMES - 5))
    (score,) = travels(Trajectory(STEP, (drive("a", "east", s, arrived=10.0),)), road)
    assert (score.id, score.time) == ("a", 10.0)
    assert score.velocity == pytest.approx(6.0)
    assert score.delay == pytest.approx(10 - 60 / 12), "the highest limit on the route is 12 m/s"


def test_free_speed_can_be_given(road: RoadMap, drive: Drive) -> None:
    (score,) = travels(Trajectory(STEP, (drive("a", "east", 6 * TIMES, arrived=10.0),)), road, free_speed=6.0)
    assert score.delay == pytest.approx(0, abs=1e-9)


def test_arrival_between_two_rows_and_a_late_start(road: RoadMap, drive: Drive) -> None:
    track = drive("a", "north", 5 * TIMES, arrived=4.05, first_step=10)
    (score,) = travels(Trajectory(STEP, (track,)), road)
    assert score.time == pytest.approx(3.05)
    assert score.velocity == pytest.approx(5.0)


def test_those_who_did_not_arrive_and_human_drivers_are_absent(road: RoadMap, drive: Drive) -> None:
    tracks = (
        drive("a", "east", 5 * TIMES),
        drive("b", "east", 5 * TIMES, kind=Kind.HDV, arrived=10.0),
        drive("c", "east", 5 * TIMES, arrived=0.0),
    )
    assert travels(Trajectory(STEP, tracks), road) == ()


def test_curves_are_measured_along_the_way_driven(road: RoadMap, drive: Drive) -> None:
    path = road.paths["merge"]
    s = np.linspace(0, path.length, len(TIMES))
    (score,) = travels(Trajectory(STEP, (drive("a", "merge", s, arrived=TIMES[-1]),)), road)
    assert score.velocity == pytest.approx(path.length / TIMES[-1], rel=1e-3)


def test_who_stands_in_the_way_by_the_scene_is_no_measure_of_human_drivers(road: RoadMap, drive: Drive) -> None:
    cav, human = drive("a", "east", 6 * TIME, arrived=15.0), drive("h", "north", 5 * TIME, kind=Kind.HDV)
    place = np.where(TIME < 10, 30.0, 30.0 + 5 * (TIME - 10) ** 2)
    stands = drive("s", "merge", place, kind=Kind.HDV)
    alone = {track.id: np.arange(0, 130, 1.0) for track in (cav, human, stands)}
    outcome = Outcome(Ending.SUCCESS, 15.0, {"a": 15.0})

    def numbers(*tracks: Track) -> dict[str, float | None]:
        score = StandardMetrics().score(Trajectory(0.1, tracks, alone), outcome, road)
        return {number.name: number.value for number in score.numbers}

    without, counted = numbers(cav, human), numbers(cav, human, stands)
    left_out = numbers(cav, human, replace(stands, style="blocker"))
    mean_over_people = ("jerk_hdvs", "delay_hdvs", "fairness", "time_all")
    assert {name: left_out[name] for name in mean_over_people} == {name: without[name] for name in mean_over_people}
    assert all(counted[name] != without[name] for name in mean_over_people)
