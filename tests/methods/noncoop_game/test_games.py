"""Motions of a game: held accelerations, exact, never backwards and never too fast."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from codriving.methods.noncoop_game.games import ACCELERATIONS, constant_acceleration, passage

TIMES = np.arange(16) * 0.2
TOP = 9.0


@given(st.floats(0.0, 10.0), st.floats(0.1, 3.0))
def test_the_motion_is_that_of_small_steps(speed: float, hold: float) -> None:
    travelled, last = constant_acceleration(speed, ACCELERATIONS, hold, TOP, TIMES)
    step = 1e-3
    for k, acceleration in enumerate(ACCELERATIONS):
        v, s = speed, 0.0
        for n in range(3000):
            v_new = min(max(v + acceleration * step, 0.0), max(TOP, speed)) if n * step < hold else v
            s, v = s + (v + v_new) / 2 * step, v_new
        assert travelled[k, -1] == pytest.approx(s, abs=0.03)
        assert last[k] == pytest.approx(v, abs=0.02)
    assert (np.diff(travelled, axis=1) >= -1e-9).all()


@pytest.mark.parametrize("speed", [0.0, 9.0, 11.0])
def test_no_number_is_undefined_at_rest_or_beyond_the_top(speed: float) -> None:
    travelled, last = constant_acceleration(speed, ACCELERATIONS, 1.0, TOP, TIMES)
    assert np.isfinite(travelled).all()
    assert (last >= 0).all()
    assert (last <= max(TOP, speed)).all()


def test_passage_is_now_within_or_beyond_the_horizon_or_never() -> None:
    travelled, last = constant_acceleration(5.0, np.array([0.0, -5.0]), 1.0, TOP, TIMES)
    assert passage(0.0, travelled, last, TIMES).tolist() == [0.0, 0.0]
    assert passage(-3.0, travelled, last, TIMES).tolist() == [0.0, 0.0]
    assert passage(7.0, travelled, last, TIMES) == pytest.approx([1.4, np.inf])
    assert passage(40.0, travelled, last, TIMES) == pytest.approx([8.0, np.inf])
    assert passage(2.0, travelled, last, TIMES)[1] == pytest.approx(0.556, abs=0.02), "before it stands"
