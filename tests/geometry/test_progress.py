"""Progress of recorded vehicles along their routes."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from codriving.geometry.path import Path, progress
from codriving.geometry.road_map import RoadMap

U_TURN = Path(
    np.concatenate((np.linspace((0, 0), (50, 0), 101), np.linspace((49.5, 0), (0, 0), 100))),
    np.repeat([0.0, math.pi], [101, 100]),
    100.0,
)


@settings(deadline=None)
@given(start=st.floats(0, 40), speed=st.floats(0.5, 15), name=st.integers(0, 11))
def test_a_driven_path_is_recovered(intersection: RoadMap, start: float, speed: float, name: int) -> None:
    path = intersection.paths[sorted(intersection.paths)[name]]
    s = start + speed * np.arange(0, 12, 0.1)
    found = progress(path, *path.position(s), path.heading(s))
    np.testing.assert_allclose(found, s, atol=0.02)


def test_it_never_falls_while_a_vehicle_drifts_sideways(intersection: RoadMap) -> None:
    path = intersection.paths["south-west"]
    s = np.linspace(90, 130, 200)
    x, y = path.position(s)
    x[100:105], y[100:105] = path.position(s[100:105] - 0.7)  # a measurement that jumps back
    wobble = 0.6 * np.sin(np.arange(200) / 3)
    heading = path.heading(s)
    found = progress(path, x - wobble * np.sin(heading), y + wobble * np.cos(heading), heading)
    assert (np.diff(found) >= 0).all()
    np.testing.assert_allclose(found, s, atol=1.2)


def test_the_heading_tells_the_two_directions_of_a_leg_apart() -> None:
    x = np.array([10.0, 30.0, 30.0, 10.0])
    found = progress(U_TURN, x, np.zeros(4), np.array([0.0, 0.0, math.pi, math.pi]))
    assert found == pytest.approx([10, 30, 70, 90])
