"""The yardstick of lane changes: how hard a vehicle would accelerate behind another one."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from codriving.reasoning.prediction.idm import IntelligentDriver

DRIVER = IntelligentDriver()
speeds = st.floats(0.0, 35.0)
wanted = st.floats(1.0, 35.0)
gaps = st.floats(-2.0, 200.0)


def test_on_a_free_road_it_goes_to_the_speed_that_is_wanted() -> None:
    assert DRIVER.accelerate(0.0, 9.0) == pytest.approx(DRIVER.acceleration)
    assert DRIVER.accelerate(9.0, 9.0) == pytest.approx(0.0)
    assert 0 < DRIVER.accelerate(4.5, 9.0) < DRIVER.acceleration
    assert DRIVER.accelerate(10.0, 9.0) < 0


@given(speeds, wanted, gaps, speeds)
def test_it_does_not_ask_for_more_than_a_car_can_do(v: float, v0: float, gap: float, leader: float) -> None:
    for a in (DRIVER.accelerate(v, v0), DRIVER.accelerate(v, v0, gap, leader)):
        assert -DRIVER.hardest <= a <= DRIVER.acceleration


@given(speeds, wanted, gaps, speeds, st.floats(0.0, 50.0))
def test_more_room_or_a_faster_leader_never_slows_it_down(
    v: float, v0: float, gap: float, leader: float, more: float
) -> None:
    a = DRIVER.accelerate(v, v0, gap, leader)
    assert DRIVER.accelerate(v, v0, gap + more, leader) >= a
    assert DRIVER.accelerate(v, v0, gap, leader + more) >= a
    assert DRIVER.accelerate(v, v0 + more, gap, leader) >= a
    assert DRIVER.accelerate(v, v0) >= a


@given(st.floats(0.0, 25.0))
def test_at_the_desired_gap_behind_an_equal_it_keeps_its_speed(v: float) -> None:
    # Treiber, Hennecke and Helbing (2000): s_e(v) = (s0 + v T) / sqrt(1 - (v / v0)^4).
    gap = (DRIVER.gap + v * DRIVER.headway) / (1 - (v / 30.0) ** 4) ** 0.5
    assert DRIVER.accelerate(v, 30.0, gap, v) == pytest.approx(0.0, abs=1e-9)
    assert DRIVER.accelerate(v, 30.0, gap - 0.5, v) < 0 < DRIVER.accelerate(v, 30.0, gap + 0.5, v)


def test_a_desired_gap_worked_out_by_hand() -> None:
    # 2 + 10 * 1.2 + 10 * 4 / (2 * sqrt(6)) = 22.165 m; 2 * (1 - 0.0625 - (22.165 / 30)^2) m/s2.
    assert DRIVER.accelerate(10.0, 20.0, 30.0, 6.0) == pytest.approx(0.7833, abs=1e-3)


def test_a_vehicle_that_touches_the_one_ahead_brakes_as_hard_as_it_can() -> None:
    for gap in (0.0, -3.0):
        assert DRIVER.accelerate(5.0, 9.0, gap, 0.0) == -DRIVER.hardest
    assert DRIVER.accelerate(0.0, 0.0) > -DRIVER.hardest, "nothing is divided by zero"
