"""The numbers of a flow, counted by hand in a window from 10 to 20 s."""

from collections.abc import Callable, Mapping

import numpy as np
import pytest

from codriving.datatypes.record import Collision, Ending, FlowArrival, FlowLog, Outcome, Track, Trajectory
from codriving.datatypes.world import Kind
from codriving.geometry.road_map import RoadMap
from codriving.metrics.standard import StandardMetrics

Drive = Callable[..., Track]

ALONE = 10 * np.arange(0, 14, 0.1)  # At 10 m/s; the goal of `east` is at 110 m


def times(seconds: float) -> np.ndarray:
    return np.arange(round(seconds * 10) + 1) * 0.1


def measured(
    road: RoadMap,
    tracks: tuple[Track, ...],
    wanted: Mapping[str, float],
    collisions: tuple[Collision, ...] = (),
    off_road: tuple[str, ...] = (),
) -> dict[str, float | None]:
    arrivals = tuple(FlowArrival(name, Kind.CAV if name.startswith("C") else Kind.HDV, t) for name, t in wanted.items())
    left = {track.id: track.arrived for track in tracks if track.arrived is not None}
    log = FlowLog(10.0, 0.1, arrivals, collisions)
    outcome = Outcome(Ending.COUNTED, 20.0, left, off_road=off_road, flow=log)
    trajectory = Trajectory(0.1, tracks, dict.fromkeys(wanted, ALONE))
    score = StandardMetrics(hard_braking=3.4).score(trajectory, outcome, road)
    assert score.success is None
    assert score.clean is None
    assert (score.pets, score.travels) == ((), ())
    return {number.name: number.value for number in score.numbers}


def test_one_that_drives_as_alone_loses_nothing(road: RoadMap, drive: Drive) -> None:
    track = drive("C1", "east", 10 * times(11), arrived=18.0, first_step=70)
    found = measured(road, (track,), {"C1": 7.0, "C2": 25.0})
    assert found["delay"] is None, "none wants to come in within the window"
    track = drive("C1", "east", 10 * times(8), first_step=120)
    assert measured(road, (track,), {"C1": 12.0})["delay"] == pytest.approx(0, abs=0.01)


def test_delay_is_what_all_lose_in_the_window_for_each_that_wants_to_come_in(road: RoadMap, drive: Drive) -> None:
    """C1 is there from 2 s on at 5 m/s: from 40 to 90 m in the 10 s of the window, alone 5 s: 5 s lost.

    H1 wants in at 12 s and comes in at 15 s, from where on it drives as alone: 3 s. H2 still waits since 16 s: 4 s. H3
    left before the window. Two want to come in within it: 12 / 2 s, of human drivers 7 / 2 s, of CAVs none.
    """
    tracks = (
        drive("C1", "east", 5 * times(18), first_step=20),
        drive("H1", "east", 10 * times(5), Kind.HDV, first_step=150),
        drive("H3", "east", 5 * times(8), Kind.HDV, arrived=9.0, first_step=10),
    )
    found = measured(road, tracks, {"C1": 2.0, "H1": 12.0, "H2": 16.0, "H3": 1.0})
    assert found["delay"] == pytest.approx(6, abs=0.02)
    assert found["delay_hdvs"] == pytest.approx(3.5, abs=0.02)
    assert found["delay_cavs"] is None
    assert (found["demand"], found["waiting"]) == (720, 1)


def test_of_a_jam_the_delay_is_large_though_none_arrives(road: RoadMap, drive: Drive) -> None:
    """All 10 s of the one that stands, and 9 s of the one outside, for one that wants to come in."""
    track = drive("H1", "east", 50 + 0 * times(20), Kind.HDV)
    assert measured(road, (track,), {"H1": 0.0, "H2": 11.0})["delay"] == pytest.approx(19, abs=0.01)


def test_who_leaves_within_the_window_counts_the_first_moment_not(road: RoadMap, drive: Drive) -> None:
    """At 10.0 s the warm-up ends; 10.1 and 20.0 s count: two in 10 s are 720 an hour."""
    tracks = tuple(
        drive(f"C{k}", "east", 10 * times(10), arrived=at, first_step=round(at * 10) - 100)
        for k, at in enumerate((10.0, 10.1, 20.0))
    )
    found = measured(road, tracks, {"C0": 0.0, "C1": 0.1, "C2": 10.0})
    assert (found["throughput"], found["vehicles"]) == (720, 2)


def test_collisions_for_a_thousand_vehicles_that_leave_the_road(road: RoadMap, drive: Drive) -> None:
    """One in the warm-up does not count; one in the window with two vehicles, one that leaves, one beside the road."""
    ends = {"C0": 5.0, "C1": 5.0, "C2": 15.0, "H1": 15.0, "C3": 16.0, "C4": 17.0, "C5": 20.0}
    tracks = tuple(
        drive(
            name,
            "east",
            10 * times(4),
            Kind.HDV if name == "H1" else Kind.CAV,
            arrived=16.0 if name == "C3" else None,
            first_step=round(at * 10) - 40,
        )
        for name, at in ends.items()
    )
    hits = (Collision(5.0, "C0", "C1", "CAV-CAV"), Collision(15.0, "C2", "H1", "CAV-HDV"))
    humans = (Collision(15.0, "H1", "H2", "HDV-HDV"),)
    found = measured(road, tracks, {name: at - 4 for name, at in ends.items()}, hits, ("C4",))
    assert (found["collisions"], found["vehicles"], found["off_road"]) == (1, 4, 1)
    assert found["collisions_cavs"] == 1
    assert measured(road, tracks, {}, humans)["collisions_cavs"] == 0
    assert found["collisions_per_1000"] == 250
    assert measured(road, (), {})["collisions_per_1000"] is None


def test_velocity_and_hard_braking_are_of_the_window_alone(road: RoadMap, drive: Drive) -> None:
    """C1 drives 10 m/s in the warm-up and 5 m/s in the window, 5 s to 75 m; C2 10 m/s for 5 s: 75 m in 10 s.

    It brakes from 10 to 5 m/s at 8 s, which is before the window. C2 brakes twice by 4 m/s2 in it: 2 in 0.075 km.
    """
    s = np.concatenate((10 * times(5), 50 + 5 * times(10)[1:]))
    speed = np.full(51, 10.0)
    speed[10:12] -= 0.4  # One braking of 4 m/s2, and back
    speed[30:33] -= 0.4
    first = drive("C1", "east", s, first_step=0)
    second = drive("C2", "east", 10 * times(5), first_step=150)
    second = Track(*(speed if name == "speed" else getattr(second, name) for name in second.__slots__))
    found = measured(road, (first, second), {"C1": 0.0, "C2": 15.0})
    assert found["velocity"] == pytest.approx(75 / 10, abs=0.02)
    assert found["hard_braking"] == pytest.approx(2 / 0.075, rel=0.01)


def test_without_drives_alone_there_is_no_delay(road: RoadMap, drive: Drive) -> None:
    track = drive("C1", "east", 5 * times(8), first_step=120)
    log = FlowLog(10.0, 0.1, (FlowArrival("C1", Kind.CAV, 12.0),), ())
    outcome = Outcome(Ending.COUNTED, 20.0, {}, flow=log)
    score = StandardMetrics().score(Trajectory(0.1, (track,)), outcome, road)
    assert {number.name: number.value for number in score.numbers}["delay"] is None
