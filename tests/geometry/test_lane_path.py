"""Lane paths against highway-env's lanes, and the joining of lanes."""

import math

import numpy as np
import pytest
from highway_env.road.lane import CircularLane, SineLane, StraightLane
from hypothesis import given, settings
from hypothesis import strategies as st

from codriving.datatypes.road import Arc, Lane, Sine, Straight
from codriving.geometry.lane_path import lane_path, lane_starts, route_path
from codriving.geometry.path import Path
from codriving.geometry.road_map import RoadMap

metres = st.floats(-200, 200)
points = st.tuples(metres, metres)
ends = st.tuples(points, points).filter(lambda p: math.dist(*p) > 1)


def _sample(path: Path) -> list[tuple[float, np.ndarray, float]]:
    """Twenty points of a path, both ends among them: arc length, point, heading."""
    rows = np.unique(np.linspace(0, len(path.points) - 1, 20).astype(int))
    return [(float(path.arc_lengths[k]), path.points[k], float(path.headings[k])) for k in rows]


@settings(deadline=None)
@given(ends)
def test_straight_lane_is_highway_envs(points: tuple[tuple[float, float], tuple[float, float]]) -> None:
    path = lane_path(Lane(("a", "b", 0), Straight(*points)))
    theirs = StraightLane(*points)
    assert path.length == pytest.approx(theirs.length)
    for s, point, heading in _sample(path):
        np.testing.assert_allclose(point, theirs.position(s, 0), atol=1e-9)
        assert heading == pytest.approx(theirs.heading_at(s))


@settings(deadline=None)
@given(points, st.floats(3, 60), st.floats(-7, 7), st.floats(0.1, 5), st.booleans())
def test_arc_is_highway_envs(
    center: tuple[float, float], radius: float, start: float, turn: float, clockwise: bool
) -> None:
    end = start + turn if clockwise else start - turn
    path = lane_path(Lane(("a", "b", 0), Arc(center, radius, start, end, clockwise)))
    theirs = CircularLane(center, radius, start, end, clockwise)
    assert path.length == pytest.approx(theirs.length)
    for s, point, heading in _sample(path):
        np.testing.assert_allclose(point, theirs.position(s, 0), atol=1e-9)
        assert heading == pytest.approx(theirs.heading_at(s))


@settings(deadline=None)
@given(ends, st.floats(-8, 8), st.floats(0.01, 0.2), st.floats(-3, 3))
def test_sine_lane_is_highway_envs(
    points: tuple[tuple[float, float], tuple[float, float]], amplitude: float, pulsation: float, phase: float
) -> None:
    path = lane_path(Lane(("a", "b", 0), Sine(*points, amplitude, pulsation, phase)))
    theirs = SineLane(*points, amplitude, pulsation, phase)
    for _, point, heading in _sample(path):
        longitudinal, lateral = theirs.local_coordinates(point)
        assert lateral == pytest.approx(0, abs=1e-6)
        np.testing.assert_allclose(theirs.position(longitudinal, 0), point, atol=1e-6)
        assert heading == pytest.approx(theirs.heading_at(longitudinal), abs=1e-6)
    # highway-env measures along the base line, we along the curve itself.
    chords = np.hypot(*np.diff(path.points, axis=0).T)
    assert chords.max() <= path.spacing + 1e-3
    assert chords.sum() == pytest.approx(path.length, rel=2e-3)


def test_spacing_divides_the_length_evenly() -> None:
    path = lane_path(Lane(("a", "b", 0), Straight((0, 0), (10.2, 0))))
    assert path.spacing == pytest.approx(10.2 / 20)
    assert path.arc_lengths[-1] == path.length == pytest.approx(10.2)


def test_lanes_that_meet_are_joined_without_a_seam(intersection: RoadMap) -> None:
    for name, path in intersection.paths.items():
        lanes = [intersection.lanes[k] for k in intersection.routes[name].lanes]
        assert path.length == pytest.approx(sum(lane_path(lane).length for lane in lanes))
        assert np.hypot(*np.diff(path.points, axis=0).T).max() <= path.spacing + 1e-9
        assert np.abs(np.diff(path.headings)).max() < 0.06


def test_lane_starts_count_the_lanes_before() -> None:
    lanes = [Lane(("a", "b", 0), Straight((0, 0), (30, 0))), Lane(("b", "c", 0), Straight((30, 0), (50, 0)))]
    assert lane_starts(lanes) == (0.0, 30.0)


def test_a_gap_is_bridged_smoothly() -> None:
    lanes = [Lane(("a", "b", 0), Straight((0, 0), (30, 0))), Lane(("b", "c", 0), Straight((36, 2), (50, 2)))]
    path = route_path(lanes)
    start = lane_starts(lanes)[1]
    assert start == pytest.approx(30 + math.hypot(6, 2), abs=0.3)
    assert start > 30 + math.hypot(6, 2)
    assert np.hypot(*np.diff(path.points, axis=0).T).max() <= path.spacing + 1e-6
    chord_headings = np.arctan2(*np.diff(path.points, axis=0).T[::-1])
    np.testing.assert_allclose(chord_headings, (path.headings[1:] + path.headings[:-1]) / 2, atol=0.03)


def test_headings_do_not_spin_where_lanes_state_them_a_turn_apart() -> None:
    lanes = [
        Lane(("a", "b", 0), Straight((0, 0), (10, 0))),
        Lane(("b", "c", 0), Arc((10, 20), 20, 1.5 * math.pi, 2 * math.pi)),
    ]
    path = route_path(lanes)
    assert path.headings[-1] == pytest.approx(math.pi / 2)
    assert np.abs(np.diff(path.headings)).max() < 0.05
