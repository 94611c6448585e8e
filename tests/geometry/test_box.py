"""Oriented boxes and their overlap."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from codriving.geometry.box import TRUE, Footprint, corners, overlap, overlaps, separation

places = st.tuples(st.floats(-6, 6), st.floats(-6, 6), st.floats(-7, 7))


def _corners(place: tuple[float, float, float]) -> np.ndarray:
    return corners(*place, TRUE.length, TRUE.width)


def _separation(a: tuple[float, float, float], b: tuple[float, float, float]) -> float:
    cos, sin = math.cos(a[2]), math.sin(a[2])
    dx, dy = b[0] - a[0], b[1] - a[1]
    turn = b[2] - a[2]
    numbers = (cos * dx + sin * dy, cos * dy - sin * dx, math.cos(turn), math.sin(turn))
    return float(separation(*(np.array(n) for n in numbers), TRUE))


def test_corners_lie_half_a_length_and_half_a_width_away() -> None:
    assert corners(1, 2, 0, 5, 2) == pytest.approx(np.array([[3.5, 3], [3.5, 1], [-1.5, 1], [-1.5, 3]]))
    assert corners(0, 0, math.pi / 2, 5, 2) == pytest.approx(np.array([[-1, 2.5], [1, 2.5], [1, -2.5], [-1, -2.5]]))
    assert corners(np.zeros((3, 2)), np.zeros((3, 2)), np.zeros((3, 2)), 5, 2).shape == (3, 2, 4, 2)


def test_known_overlaps() -> None:
    here = _corners((0, 0, 0))
    assert overlap(here, here)
    assert overlap(here, _corners((4.9, 1.9, 0)))
    assert not overlap(here, _corners((5.0, 0, 0))), "touching is not overlapping"
    assert not overlap(here, _corners((5.1, 0, 0)))
    assert not overlap(here, _corners((0, 2.1, 0)))
    # A diagonal box: its bounding box overlaps, it does not.
    assert not overlap(here, _corners((3.9, 2.8, -math.pi / 4)))
    assert overlap(here, _corners((3.5, 0, math.pi / 2 - 1e-6)))


def test_a_box_within_another_overlaps_it() -> None:
    assert overlap(_corners((0, 0, 0.3)), corners(0.1, 0, 1.0, 0.4, 0.2))


@given(places, places)
def test_overlap_is_symmetric_and_agrees_with_separation(
    a: tuple[float, float, float], b: tuple[float, float, float]
) -> None:
    gap = _separation(a, b)
    assert gap == pytest.approx(_separation(b, a), abs=1e-9)
    assume(abs(gap) > 1e-6)
    assert overlap(_corners(a), _corners(b)) == overlap(_corners(b), _corners(a)) == (gap < 0)


@given(places, places, st.tuples(st.floats(-100, 100), st.floats(-100, 100), st.floats(-4, 4)))
def test_overlap_survives_a_rigid_motion(
    a: tuple[float, float, float], b: tuple[float, float, float], motion: tuple[float, float, float]
) -> None:
    assume(abs(_separation(a, b)) > 1e-6)
    cos, sin = math.cos(motion[2]), math.sin(motion[2])

    def moved(p: tuple[float, float, float]) -> tuple[float, float, float]:
        return cos * p[0] - sin * p[1] + motion[0], sin * p[0] + cos * p[1] + motion[1], p[2] + motion[2]

    assert overlap(_corners(a), _corners(b)) == overlap(_corners(moved(a)), _corners(moved(b)))


@given(places, places)
def test_a_shared_point_means_overlap(a: tuple[float, float, float], b: tuple[float, float, float]) -> None:
    along, across = np.meshgrid(np.linspace(-2.49, 2.49, 40), np.linspace(-0.99, 0.99, 20))
    x = a[0] + along * math.cos(a[2]) - across * math.sin(a[2]) - b[0]
    y = a[1] + along * math.sin(a[2]) + across * math.cos(a[2]) - b[1]
    inside = (abs(x * math.cos(b[2]) + y * math.sin(b[2])) < 2.5) & (abs(y * math.cos(b[2]) - x * math.sin(b[2])) < 1)
    if inside.any():
        assert overlap(_corners(a), _corners(b))
    elif _separation(a, b) < -0.3:
        raise AssertionError("boxes that overlap by 0.3 m share no point")


def test_many_pairs_at_once_give_the_same_as_one_by_one() -> None:
    rng = np.random.default_rng(3)
    a, b = rng.uniform(-5, 5, (2, 50, 3))
    boxes_a, boxes_b = (corners(*p.T, TRUE.length, TRUE.width) for p in (a, b))
    one_by_one = [overlap(p, q) for p, q in zip(boxes_a, boxes_b, strict=True)]
    assert overlaps(boxes_a, boxes_b).tolist() == one_by_one
    assert overlaps(boxes_a[:, None], boxes_b[None])[range(50), range(50)].tolist() == one_by_one
    assert 5 < sum(one_by_one) < 45


@given(places, places)
def test_boxes_of_two_sizes_overlap_where_their_separation_is_negative(
    a: tuple[float, float, float], b: tuple[float, float, float]
) -> None:
    cos, sin = math.cos(a[2]), math.sin(a[2])
    dx, dy = b[0] - a[0], b[1] - a[1]
    turn = b[2] - a[2]
    numbers = (cos * dx + sin * dy, cos * dy - sin * dx, math.cos(turn), math.sin(turn))
    apart = float(separation(*(np.array(n) for n in numbers), TRUE, Footprint(7.0, 1.2)))
    assume(abs(apart) > 1e-6)
    assert (apart < 0) == overlap(_corners(a), corners(*b, 7.0, 1.2))
