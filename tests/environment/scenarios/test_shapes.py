"""Points that are turned, and lanes that bend from one point to another."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from codriving.errors import ScenarioError
from codriving.geometry.curve import lane_curve
from codriving.scenarios import Arc, Lane, Straight, bend, turned

COORDINATE = st.floats(-100, 100)


def test_a_quarter_turn_leads_from_x_to_y() -> None:
    assert turned((3.0, 0.0), math.pi / 2) == pytest.approx((0.0, 3.0))
    assert turned((2.0, 11.0), math.pi / 2) == pytest.approx((-11.0, 2.0)), "from the south to the west"


@given(x=COORDINATE, y=COORDINATE, heading=st.floats(-math.pi, math.pi), ahead=COORDINATE, right=COORDINATE)
def test_a_bend_leaves_in_its_direction_and_ends_where_it_should(
    x: float, y: float, heading: float, ahead: float, right: float
) -> None:
    assume(abs(right) > 0.1 or ahead > 0.1)
    assume(abs(right) > 1e-3 or right == 0)
    dx, dy = turned((ahead, right), heading)
    shape = bend((x, y), heading, (x + dx, y + dy))
    curve = lane_curve(shape)
    points, headings = curve.at(np.array([0.0, curve.length]))
    scale = 1e-6 * max(1.0, shape.radius if isinstance(shape, Arc) else 1.0)
    assert points[0] == pytest.approx((x, y), abs=scale)
    assert points[1] == pytest.approx((x + dx, y + dy), abs=scale)
    assert math.remainder(headings[0] - heading, math.tau) == pytest.approx(0.0, abs=1e-6)
    if isinstance(shape, Arc):
        assert shape.clockwise == (right > 0)
        assert 0 < curve.length <= math.tau * shape.radius


def test_straight_ahead_is_a_straight_line() -> None:
    assert bend((1.0, 2.0), 0.0, (9.0, 2.0)) == Straight((1.0, 2.0), (9.0, 2.0))


def test_a_right_angle_is_a_quarter_of_a_circle() -> None:
    arc = bend((-11.0, 2.0), 0.0, (-2.0, 11.0))
    assert isinstance(arc, Arc)
    assert (arc.center, arc.radius) == (pytest.approx((-11.0, 11.0)), pytest.approx(9.0))
    assert lane_curve(Lane(("a", "b", 0), arc).shape).length == pytest.approx(9.0 * math.pi / 2)


@pytest.mark.parametrize("end", [(0.0, 0.0), (-5.0, 0.0)])
def test_nothing_bends_straight_back(end: tuple[float, float]) -> None:
    with pytest.raises(ScenarioError, match=r"no lane bends from \(0.0, 0.0\) to .* not ahead"):
        bend((0.0, 0.0), 0.0, end)
