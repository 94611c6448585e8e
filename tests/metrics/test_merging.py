"""Gaps between vehicles that merge: worked out by hand, and against brute force over footprints."""

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from codriving.datatypes.record import Track, Trajectory
from codriving.datatypes.world import Kind
from codriving.geometry.box import corners, overlaps
from codriving.geometry.path import Path
from codriving.geometry.road_map import RoadMap
from codriving.metrics.merging import merging_gap
from codriving.metrics.pet import post_encroachment_times

Drive = Callable[..., Track]

STEP = 0.1
ALL = slice(None)


def _straight(name: str, x: np.ndarray, y: np.ndarray) -> Track:
    n = len(x)
    zero = np.zeros(n)
    return Track(name, Kind.CAV, "r", 0, x, y, zero, zero, zero, ("IDLE",) * n, None)


def test_the_place_is_where_the_second_enters_the_lane() -> None:
    """A drives along y = 0 at 10 m/s. B drives 3 s behind it beside the lane, and moves over at x = 50 m, t = 8 s.

    B's nose is then at 52.5 m. A's tail left that place when its centre was at 55 m, at t = 5.5 s: 8 - 5.5 = 2.5 s.
    B moves over by 4 m within 0.1 s; it is over the edge of A's ground after half of that, hence 0.05 s less.
    """
    t = np.arange(0, 15, STEP)
    a = _straight("a", 10 * t, 0 * t)
    b = _straight("b", 10 * (t - 3), np.where(t < 7.95, 4.0, 0.0))
    found = merging_gap(a, b, ALL, ALL, STEP)
    assert found is not None
    assert found[:2] == ("a", "b")
    assert found[2] == pytest.approx(2.5, abs=0.06)
    assert merging_gap(b, a, ALL, ALL, STEP) == pytest.approx(found)


def test_one_that_merges_in_front_is_followed() -> None:
    """B moves over at x = 50 m, t = 5 s; A comes 2 s later at 10 m/s, so its nose is at B's tail, 47.5 m, at 6.5 s.

    B's tail leaves 47.5 m when it moves on from x = 50 m, at t = 5 s: 6.5 - 5 = 1.5 s, the headway less a length.
    """
    t = np.arange(0, 15, STEP)
    a = _straight("a", 10 * (t - 2), 0 * t)
    b = _straight("b", 10 * t, np.where(t < 4.95, 4.0, 0.0))
    found = merging_gap(a, b, ALL, ALL, STEP)
    assert found is not None
    assert found[:2] == ("b", "a")
    assert found[2] == pytest.approx(1.5, abs=0.06)


def test_no_gap_between_vehicles_that_stay_beside_one_another_or_follow_from_the_start() -> None:
    t = np.arange(0, 15, STEP)
    a = _straight("a", 10 * t, 0 * t)
    assert merging_gap(a, _straight("b", 10 * (t - 3), 0 * t + 4), ALL, ALL, STEP) is None
    assert merging_gap(a, _straight("b", 10 * t + 20, 0 * t), ALL, ALL, STEP) is None


def test_vehicles_on_one_place_at_once_have_a_negative_gap() -> None:
    """B moves over 2 m behind A, at 10 m/s: A's tail is 3 m behind B's nose, and leaves its place 0.3 s later."""
    t = np.arange(0, 15, STEP)
    a = _straight("a", 10 * t + 2, 0 * t)
    found = merging_gap(a, _straight("b", 10 * t, np.where(t < 4.95, 4.0, 0.0)), ALL, ALL, STEP)
    assert found is not None
    assert found[2] == pytest.approx(-0.3, abs=0.06)


FINE = 0.02


def _brute(
    one: Callable[[np.ndarray], tuple[np.ndarray, ...]],
    other: Callable[[np.ndarray], tuple[np.ndarray, ...]],
    until: float,
) -> float | None:
    """The gap by definition: every footprint of the one against every footprint of the other, every 0.02 s."""
    t = np.arange(0, until, FINE)
    a, b = one(t), other(t)
    over = np.hypot(b[0][:, None] - a[0], b[1][:, None] - a[1]) < 5.4  # (times of b, times of a)
    rows, columns = np.nonzero(over)
    over[rows, columns] = overlaps(corners(*b, 5.0, 2.0)[rows], corners(*a, 5.0, 2.0)[columns])
    found = []
    for matrix in (over, over.T):
        enters = np.flatnonzero(matrix.any(axis=1))
        if len(enters) and enters[0] > 0:
            leaves = np.flatnonzero(matrix[enters[0]])[-1]
            if leaves < len(t) - 1:
                found.append((enters[0] - leaves) * FINE)
    return max(found, default=None)


def _motion(path: Path, start: float, speed: float, change: float) -> Callable[[np.ndarray], tuple[np.ndarray, ...]]:
    def at(t: np.ndarray) -> tuple[np.ndarray, ...]:
        s = start + speed * t + change * np.minimum(t, 8.0) ** 2 / 2 + change * 8.0 * np.maximum(t - 8.0, 0.0)
        return *path.position(s), path.heading(s)

    return at


@given(st.floats(4, 9), st.floats(4, 9), st.floats(0, 12), st.floats(0, 12), st.floats(-0.2, 0.3))
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None, max_examples=25)
def test_it_agrees_with_brute_force_over_footprints(
    road: RoadMap, speed: float, other: float, lead: float, other_lead: float, change: float
) -> None:
    one, two = (
        _motion(road.paths["east"], lead, speed, change),
        _motion(road.paths["merge"], other_lead, other, -change),
    )
    t = np.arange(0, 20, STEP)
    tracks = tuple(
        Track(name, Kind.CAV, route, 0, *at(t), 0 * t, 0 * t, ("IDLE",) * len(t), None)
        for name, route, at in (("a", "east", one), ("b", "merge", two))
    )
    expected = _brute(one, two, 20)
    # What is still coming together when the episode ends depends on how deep a touch has to be.
    assume(expected is not None and expected > 0.2 and _brute(one, two, 19) == expected)
    (pet,) = post_encroachment_times(Trajectory(STEP, tracks), road)
    assert pet.value == pytest.approx(expected, abs=0.1)
