"""Bounds of human drivers hold whatever they do."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from codriving.geometry.limited import accelerated
from codriving.reasoning.prediction.forecast import likely_distances, slowest

DRIFT = (1.0, 0.75, 6.0)
HARD_ACCELERATION = 1.5
HARD_BRAKING = 6.0

TIMES = np.linspace(0.0, 12.0, 61)
SPEEDS = st.floats(0.0, 30.0)


@given(SPEEDS, SPEEDS)
def test_constant_speed_lies_between_the_bounds(speed: float, limit: float) -> None:
    least, most = slowest(speed, TIMES, 6.0), accelerated(speed, TIMES, limit, 1.5)
    assert (least <= speed * TIMES + 1e-9).all()
    assert (most >= speed * TIMES - 1e-9).all()


@given(SPEEDS, SPEEDS)
def test_no_vehicle_drives_backwards_or_beyond_the_limit(speed: float, limit: float) -> None:
    least, most = slowest(speed, TIMES, 6.0), accelerated(speed, TIMES, limit, 1.5)
    assert least[0] == most[0] == 0.0
    assert (np.diff(least) >= -1e-9).all()
    assert (np.diff(most) <= max(speed, limit) * np.diff(TIMES) + 1e-9).all()


@given(SPEEDS, SPEEDS, st.lists(st.floats(-1.0, 1.0), min_size=60, max_size=60))
def test_no_way_to_drive_leaves_the_bounds(speed: float, limit: float, pedals: list[float]) -> None:
    v, places = speed, [0.0]
    for pedal, dt in zip(pedals, np.diff(TIMES), strict=True):
        wanted = v + dt * (pedal * HARD_ACCELERATION if pedal > 0 else pedal * HARD_BRAKING)
        after = min(max(wanted, 0.0), max(limit, speed))
        # While it stops within the step, it covers what braking as hard leaves it.
        mean = (v + after) / 2 if wanted >= 0 else v * v / (2 * (v - wanted))
        places.append(places[-1] + mean * dt)
        v = after
    assert (slowest(speed, TIMES, 6.0) <= np.array(places) + 1e-6).all()
    assert (np.array(places) <= accelerated(speed, TIMES, limit, 1.5) + 1e-6).all()


@given(SPEEDS)
def test_a_driver_is_likely_near_where_its_speed_leads(speed: float) -> None:
    at_once, each_second, at_most = DRIFT
    least, most = likely_distances(speed * TIMES, TIMES)
    steady = speed * TIMES
    assert (least <= steady + 1e-9).all()
    assert (steady <= most + 1e-9).all()
    assert (least >= 0).all()
    assert (most - steady <= at_most + 1e-9).all()
    assert most[0] == at_once, "where it is now is known only up to this"
    assert most[5] - steady[5] == pytest.approx(at_once + each_second * TIMES[5])
    # Nearer to the present nothing is less certain than later.
    assert (np.diff(most - steady) >= -1e-9).all()


def test_what_is_likely_lies_within_what_is_possible_at_speed() -> None:
    least, most = likely_distances(15.0 * TIMES, TIMES)
    late = TIMES >= 2.0
    assert (slowest(15.0, TIMES, 6.0)[late] <= least[late]).all()
    assert (most[late] <= accelerated(15.0, TIMES, 21.0, 1.5)[late]).all()


def test_braking_ends_at_rest() -> None:
    least = slowest(9.0, TIMES, 6.0)
    assert least[-1] == least[-2] > 0
    assert (slowest(0.0, TIMES, 6.0) == 0).all()
