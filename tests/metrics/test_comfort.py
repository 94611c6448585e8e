"""Hard braking, jerk, stops and reversals, worked out by hand."""

import numpy as np
import pytest

from codriving.datatypes.record import Track
from codriving.datatypes.world import Kind
from codriving.metrics.comfort import hard_braking, jerk, reversals, stops


def _track(speed: list[float], action: tuple[str, ...] | None = None) -> Track:
    n = len(speed)
    zero = np.zeros(n)
    return Track("a", Kind.CAV, "r", 0, zero, zero, zero, np.array(speed), zero, action or ("IDLE",) * n, None)


def test_hard_braking_is_a_share_of_the_time() -> None:
    """Steps of 0.5 s: 10 -> 8 brakes with 4 m/s2, 8 -> 7 with 2, then it stays: one of four steps."""
    assert hard_braking([_track([10, 8, 7, 7, 7])], 0.5, 3.4) == 0.25
    assert hard_braking([_track([10, 8, 7, 7, 7]), _track([5, 5, 5, 5, 5])], 0.5, 3.4) == 0.125
    assert hard_braking([_track([10, 8, 7, 7, 7])], 0.5, 4.5) == 0
    assert hard_braking([], 0.5, 3.4) is None


def test_jerk_is_the_change_of_acceleration_within_a_second() -> None:
    """Steps of 0.5 s, accelerations 0, 2, 2, -1 m/s2: changes over two steps are 2 and -3, on average 2.5 m/s3."""
    assert jerk([_track([5, 5, 6, 7, 6.5])], 0.5) == pytest.approx(2.5)
    assert jerk([_track([5, 5, 6])], 0.5) is None
    assert jerk([], 0.5) is None


@pytest.mark.parametrize(
    ("speed", "count"),
    [
        ([5, 3, 0.4, 0, 0, 3, 5], 1),
        ([0, 0, 3, 5], 0),
        ([5, 0.4, 0.6, 0.4, 1.9, 0.4], 1),
        ([5, 0.4, 2.1, 0.4], 2),
        ([5, 0.6, 5], 0),
    ],
)
def test_a_stop_begins_below_a_half_and_ends_above_two_metres_a_second(speed: list[float], count: int) -> None:
    assert stops([_track(speed)]) == count


def test_stops_are_of_a_vehicle() -> None:
    assert stops([_track([5, 0, 5]), _track([5, 5, 5])]) == 0.5
    assert stops([]) is None


def test_reversals_are_flips_a_minute() -> None:
    """In twelve steps of 0.5 s, 6 s, FASTER - SLOWER - FASTER - SLOWER flips three times: 30 a minute.

    SLOWER - IDLE - FASTER is none: there was a decision between.
    """
    actions = ("", *["FASTER"] * 3, *["SLOWER"] * 3, "FASTER", "FASTER", "SLOWER", "IDLE", "FASTER", "FASTER")
    assert reversals([_track([5] * 13, actions)], 0.5) == pytest.approx(30)
    assert reversals([_track([5] * 13, ("", *["IDLE"] * 12))], 0.5) == 0
    assert reversals([_track([5] * 13, ("",) * 13)], 0.5) is None, "it takes no actions"
    assert reversals([], 0.5) is None
