"""Positions on a path and projections onto it."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from codriving.datatypes.road import Arc, Lane, Straight
from codriving.geometry.lane_path import lane_path, route_path
from codriving.geometry.path import Path, nearest_from, progress
from codriving.geometry.road_map import RoadMap

TURN = route_path(
    [
        Lane(("a", "b", 0), Straight((0, 0), (40, 0))),
        Lane(("b", "c", 0), Arc((40, 9), 9, -math.pi / 2, 0)),
        Lane(("c", "d", 0), Straight((49, 9), (49, 50))),
    ]
)


@settings(deadline=None)
@given(st.floats(-10, TURN.length + 10), st.floats(-3, 3))
def test_a_point_beside_the_path_is_projected_back(s: float, lateral: float) -> None:
    x, y = TURN.position(s)
    heading = float(TURN.heading(s))
    found, offset = TURN.project(float(x) - lateral * math.sin(heading), float(y) + lateral * math.cos(heading))
    assert found == pytest.approx(s, abs=0.02 + 0.03 * abs(lateral))
    assert offset == pytest.approx(lateral, abs=0.01)


@settings(deadline=None)
@given(st.floats(-20, 80), st.floats(-20, 80))
def test_a_projection_is_the_nearest_place(x: float, y: float) -> None:
    s, lateral = TURN.project(x, y)
    px, py = TURN.position(np.linspace(-100, TURN.length + 100, 3000))
    assert abs(lateral) <= np.hypot(px - x, py - y).min() + 0.02
    px, py = TURN.position(s)
    assert np.hypot(px - x, py - y) == pytest.approx(abs(lateral), abs=1e-6)


def test_the_offset_is_positive_on_the_right_of_a_screen() -> None:
    path = lane_path(Lane(("a", "b", 0), Straight((0, 0), (10, 0))))
    assert path.project(4, 1) == pytest.approx((4, 1))
    assert path.project(4, -1) == pytest.approx((4, -1))


def test_positions_keep_the_shape_and_go_straight_on() -> None:
    s = np.array([[-4.0, 0.0], [TURN.length, TURN.length + 4.0]])
    x, y = TURN.position(s)
    assert x.shape == y.shape == TURN.heading(s).shape == (2, 2)
    np.testing.assert_allclose(x, [[-4, 0], [49, 49]], atol=1e-9)
    np.testing.assert_allclose(y, [[0, 0], [50, 54]], atol=1e-9)
    np.testing.assert_allclose(TURN.heading(s), [[0, 0], [math.pi / 2, math.pi / 2]])


def test_near_tells_two_passages_of_one_place_apart() -> None:
    there_and_back = np.concatenate((np.linspace((0, 0), (50, 0), 101), np.linspace((49.5, 0), (0, 0), 100)))
    headings = np.repeat([0.0, math.pi], [101, 100])
    path = Path(there_and_back, headings, 100.0)
    assert path.project(20, 0.2, near=18)[0] == pytest.approx(20)
    assert path.project(20, 0.2, near=78)[0] == pytest.approx(80)


def test_near_beyond_the_end_still_finds_the_end() -> None:
    s, _ = TURN.project(49, 53, near=TURN.length + 20)
    assert s == pytest.approx(TURN.length + 3)


@given(st.lists(st.tuples(st.floats(-15.0, 60.0), st.floats(-25.0, 25.0)), min_size=1, max_size=6))
def test_many_projections_are_those_one_by_one(places: list[tuple[float, float]]) -> None:
    x, y = np.array(places).T
    assert TURN.project_all(x, y) == [TURN.project(*place) for place in places]


@given(st.floats(0.0, 6.3), st.lists(st.tuples(st.floats(-90, 90), st.floats(-90, 90)), min_size=1, max_size=5))
def test_on_a_straight_path_the_nearest_point_is_that_of_a_full_search(
    heading: float, places: list[tuple[float, float]]
) -> None:
    end = 60.0 * math.cos(heading), 60.0 * math.sin(heading)
    path = lane_path(Lane(("a", "b", 0), Straight((0.0, 0.0), end)))
    (mx, my), (nx, ny) = path.points[40], path.points[41]
    x, y = np.array([*places, ((mx + nx) / 2, (my + ny) / 2)]).T
    dx, dy = path.points[:, 0] - x[:, None], path.points[:, 1] - y[:, None]
    nearest = (dx * dx + dy * dy).argmin(axis=1).tolist()
    expected = [path.project_at(*one) for one in zip(nearest, x.tolist(), y.tolist(), strict=True)]
    assert path.project_all(x, y) == expected


@pytest.mark.parametrize("begin", [0, 1, 2, 9])
def test_of_two_points_that_are_as_near_the_first_one_is_taken(begin: int) -> None:
    places = [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)]
    assert nearest_from(places, begin, 0.5, 1.0, 0, 2) == 0
    assert nearest_from(places, begin, 0.5, 1.0, 1, 2) == 1


@given(st.floats(-10.0, TURN.length + 10.0) | st.sampled_from([0.0, TURN.length]))
def test_a_single_place_is_that_of_the_arrays(s: float) -> None:
    x, y = TURN.position(s)
    assert TURN.place(s) == (float(x), float(y), float(TURN.heading(s)))


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
