"""What is measured of trajectories alone, worked out by hand."""

from dataclasses import replace

import numpy as np
import pytest

from codriving.datatypes.record import Ending, Outcome, Track, Trajectory
from codriving.datatypes.world import Kind
from codriving.metrics.recorded import closest_recorded, driven_pets, driven_travels, outcome_of, recorded_time
from codriving.metrics.standard import StandardMetrics

STEP = 0.1

CAV, HDV = Kind.CAV, Kind.HDV


def track(name: str, x: np.ndarray, y: np.ndarray, heading: float, kind: Kind = CAV, first: int = 0) -> Track:
    ones = np.ones(len(x))
    speed = np.hypot(np.gradient(x), np.gradient(y)) / STEP
    return Track(name, kind, "", first, x, y, heading * ones, speed, 0 * ones, ("",) * len(x), None)


def crossing(delay: float, kinds: tuple[Kind, Kind] = (CAV, CAV), rows: int = 150) -> Trajectory:
    """A drives east and B south at 10 m/s; both pass the middle, A at 5 s and B later by a delay [s]."""
    t = STEP * np.arange(rows)
    a = track("a", 10 * (t - 5), 0 * t, 0.0, kinds[0])
    b = track("b", 0 * t, 10 * (t - 5 - delay), np.pi / 2, kinds[1])
    return Trajectory(STEP, (a, b))


def test_pet_of_a_crossing() -> None:
    """A's tail leaves B's lane, 1 m past the middle, when its centre is at 3.5 m, at 5.35 s.

    B's nose enters A's lane, 1 m before the middle, when its centre is at -3.5 m, at 7.65 s if it is 3 s later.
    """
    (pet,) = driven_pets(crossing(3.0))
    assert (pet.first, pet.second, pet.kind) == ("a", "b", "driven")
    assert pet.value == pytest.approx(2.3, abs=0.02)
    (pet,) = driven_pets(crossing(-3.0))
    assert (pet.first, pet.second) == ("b", "a")
    assert pet.value == pytest.approx(2.3, abs=0.02)


def test_pet_of_longer_and_wider_vehicles() -> None:
    """If A is 12 m long, it leaves at 5.7 s; if it is 3 m wide, B enters its ground when its centre is at -4 m."""
    a, b = crossing(3.0).tracks
    (long,) = driven_pets(Trajectory(STEP, (replace(a, length=12.0), b)))
    assert long.value == pytest.approx(1.95, abs=0.02)
    (wide,) = driven_pets(Trajectory(STEP, (replace(a, width=3.0), b)))
    assert wide.value == pytest.approx(2.25, abs=0.02)


@pytest.mark.parametrize("delay", [3.0, 3.025, 3.05, 3.075])
def test_headings_that_pass_pi_are_no_turn(delay: float) -> None:
    """B drives west; files write its heading now as pi, now as -pi."""
    t = STEP * np.arange(150)
    a, b = track("a", 0 * t, 10 * (t - 5), np.pi / 2), track("b", 10 * (5 + delay - t), 0 * t, np.pi)
    written = replace(b, heading=np.where(np.arange(150) % 2, np.pi, -np.pi))
    for second in (b, written):
        (pet,) = driven_pets(Trajectory(STEP, (a, second)))
        assert pet.first == "a"
        assert pet.value == pytest.approx(delay - 0.7, abs=0.02)


def test_time_without_vehicles_is_not_recorded() -> None:
    a, b = crossing(3.0).tracks
    assert recorded_time(Trajectory(STEP, (a, replace(b, first_step=50)))) == pytest.approx(19.9)
    assert recorded_time(Trajectory(STEP, (a, replace(b, first_step=36_000)))) == pytest.approx(29.8)


def test_pairs_without_a_cav_or_never_recorded_together_have_none() -> None:
    assert driven_pets(crossing(3.0, (HDV, HDV))) == ()
    assert len(driven_pets(crossing(3.0, (HDV, CAV)))) == 1
    a, b = crossing(3.0).tracks
    assert driven_pets(Trajectory(STEP, (a, replace(b, first_step=len(a.x))))) == ()
    assert len(driven_pets(Trajectory(STEP, (a, replace(b, first_step=len(a.x) - 1))))) == 1


def test_one_that_waits_at_the_junction_counts_to_when_it_goes_on() -> None:
    """A stands on B's lane for 10 s after the middle, and B comes 3 s after it has left."""
    t = STEP * np.arange(300)
    way = np.where(t < 5, 10 * (t - 5), np.where(t < 15, 0.0, 10 * (t - 15)))
    a, b = track("a", way, 0 * t, 0.0), track("b", 0 * t, 10 * (t - 18), np.pi / 2)
    (pet,) = driven_pets(Trajectory(STEP, (a, b)))
    assert (pet.first, pet.value) == ("a", pytest.approx(2.3, abs=0.02))


def test_a_second_lap_does_not_count() -> None:
    """A comes by at 5 s and again, back, at 25 s; B passes between, 3 s after the first time."""
    t = STEP * np.arange(300)
    a = track("a", np.where(t < 15, 10 * (t - 5), 10 * (25 - t)), 0 * t, 0.0)
    b = track("b", 0 * t, 10 * (t - 8), np.pi / 2)
    (pet,) = driven_pets(Trajectory(STEP, (a, b)))
    assert (pet.first, pet.second, pet.value) == ("a", "b", pytest.approx(2.3, abs=0.02))


def test_both_at_once_is_negative_and_those_who_follow_have_none() -> None:
    (pet,) = driven_pets(crossing(0.5))
    assert pet.value == pytest.approx(-0.2, abs=0.02)
    t = STEP * np.arange(100)
    follow = Trajectory(STEP, (track("a", 10 * t + 20, 0 * t, 0.0), track("b", 10 * t, 0 * t, 0.0)))
    assert driven_pets(follow) == ()


def test_contact_of_a_cav_is_a_collision() -> None:
    """A's footprint is on B's lane from 4.65 s to 5.35 s; B, 0.5 s later, comes onto A's lane at 5.15 s."""
    assert outcome_of(crossing(3.0)).ending is Ending.SUCCESS
    found = outcome_of(crossing(0.5, (CAV, HDV)))
    assert (found.ending, found.collision and found.collision.pair) == (Ending.COLLISION, "CAV-HDV")
    assert found.collision is not None
    assert found.collision.time == pytest.approx(5.2)
    assert outcome_of(crossing(0.5, (HDV, HDV))).ending is Ending.SUCCESS
    a, b = crossing(0.0).tracks
    beside = Trajectory(STEP, (a, replace(a, id="c", y=a.y + 1.99)))
    assert outcome_of(beside).ending is Ending.SUCCESS, "places are rounded"
    assert outcome_of(Trajectory(STEP, (a, replace(a, id="c", y=a.y + 1.97)))).ending is Ending.COLLISION
    assert outcome_of(Trajectory(STEP, (a, replace(b, first_step=51)))).ending is Ending.SUCCESS


def test_a_long_recording_is_compared_window_by_window() -> None:
    """B follows A 20 m behind, and comes closer by 2 m/s: the gap of 15 m is 3 m after 6 s, at step 999,960."""
    t = STEP * np.arange(61)
    a, b = track("a", 8 * t + 20, 0 * t, 0.0), track("b", 10 * t, 0 * t, 0.0)
    far = [replace(one, first_step=999_900) for one in (a, b)]
    found = closest_recorded(Trajectory(STEP, (*far, track("c", 0 * t, 500 + 0 * t, 0.0))))
    assert found.ttc == pytest.approx(1.5)
    assert found.drac == pytest.approx(2 / 3)


def test_travels_end_with_the_recording_or_the_arrival() -> None:
    t = STEP * np.arange(101)
    a = track("a", np.where(t < 5, 10 * t, 50 + 2 * (t - 5)), 0 * t, 0.0)
    (whole,) = driven_travels([a], STEP)
    assert (whole.time, whole.velocity) == pytest.approx((10.0, 6.0))
    (arrived,) = driven_travels([replace(a, arrived=4.0)], STEP)
    assert (arrived.time, arrived.velocity) == pytest.approx((4.0, 10.0))
    assert driven_travels([replace(a, kind=HDV)], STEP) == ()


def test_the_standard_metric_scores_a_recording() -> None:
    metric = StandardMetrics(near_miss=1.5, hard_braking=3.4)
    trajectory = crossing(2.0)
    score = metric.score_recording(trajectory, Outcome(Ending.SUCCESS, 14.9, {}))
    numbers = {number.name: number.value for number in score.numbers}
    assert list(numbers) == ["ttc_min", "drac_max", "braking_max", "hard_braking", "jerk", "stops"]
    assert (score.success, score.clean, len(score.travels)) == (True, False, 2)
    assert numbers["ttc_min"] is None
    assert numbers["braking_max"] == pytest.approx(0.0, abs=1e-9)
    assert metric.score_recording(crossing(3.0), Outcome(Ending.SUCCESS, 14.9, {})).clean is True
    a, b = trajectory.tracks
    slow = replace(a, speed=np.where(np.arange(len(a.x)) < 50, 10.0, 9.5))
    braking = metric.score_recording(Trajectory(STEP, (slow, b)), Outcome(Ending.SUCCESS, 14.9, {}))
    numbers = {number.name: number.value for number in braking.numbers}
    assert numbers["braking_max"] == pytest.approx(5.0)
    assert numbers["hard_braking"] == pytest.approx(1 / 298)
