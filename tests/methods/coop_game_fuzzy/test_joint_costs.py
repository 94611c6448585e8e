"""The risk field: its middle, its axes, how it turns and grows."""

from math import exp, pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from codriving.methods.coop_game_fuzzy.joint_costs import Poses, risk


def source(heading: float = 0.0, speed: float = 9.0) -> Poses:
    return Poses(np.array(10.0), np.array(-5.0), np.array(heading), np.array(speed))


def test_risk_is_one_in_the_middle_and_falls_to_one_over_e_at_the_axes() -> None:
    assert risk(10.0, -5.0, source(), 9.0) == 1.0
    assert risk(18.0, -5.0, source(), 9.0) == pytest.approx(exp(-1))
    assert risk(10.0, -2.5, source(), 9.0) == pytest.approx(exp(-1))


def test_field_turns_with_the_vehicle() -> None:
    assert risk(10.0, 3.0, source(pi / 2), 9.0) == pytest.approx(exp(-1))
    assert risk(12.5, -5.0, source(pi / 2), 9.0) == pytest.approx(exp(-1))


@pytest.mark.parametrize(("speed", "length"), [(0.0, 4.0), (4.5, 6.0), (9.0, 8.0), (20.0, 8.0)])
def test_field_is_longer_the_faster_the_vehicle_is(speed: float, length: float) -> None:
    assert risk(10.0 + length, -5.0, source(speed=speed), 9.0) == pytest.approx(exp(-1))
    assert risk(10.0, -2.5, source(speed=speed), 9.0) == pytest.approx(exp(-1))


@given(st.floats(-50, 50), st.floats(-50, 50), st.floats(-4, 4), st.floats(0, 9))
def test_risk_is_the_same_ahead_and_behind_and_never_above_one(
    x: float, y: float, heading: float, speed: float
) -> None:
    there, opposite = (risk(10.0 + k * x, -5.0 + k * y, source(heading, speed), 9.0) for k in (1, -1))
    assert 0.0 <= there <= 1.0
    assert there == pytest.approx(opposite)


def test_places_and_vehicles_are_broadcast() -> None:
    many = Poses(*(np.broadcast_to(np.arange(4.0), (3, 4)) for _ in range(4)))
    assert risk(np.zeros((5, 1, 1)), np.zeros((5, 1, 1)), many, 9.0).shape == (5, 3, 4)
