"""Post-encroachment times of tracks with known answers."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from codriving.datatypes.record import Track, Trajectory
from codriving.datatypes.world import Kind
from codriving.geometry.road_map import RoadMap
from codriving.metrics.pet import post_encroachment_times

Drive = Callable[..., Track]

STEP = 0.1
TIME = np.arange(0, 30, STEP)

# East and north cross at right angles, 30 m and 60 m from their starts; footprints of 5 x 2 m meet within 3.5 m.
EAST, NORTH, HALF = 30.0, 60.0, 3.5


def _pets(*tracks: Track, road: RoadMap) -> list[tuple[str, str, str, float]]:
    found = post_encroachment_times(Trajectory(STEP, tracks), road)
    return [(pet.first, pet.second, pet.kind, pet.value) for pet in found]


@given(st.floats(3, 12), st.floats(3, 12), st.floats(0, 10))
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
def test_two_that_cross_at_constant_speed(
    road: RoadMap, drive: Drive, speed: float, other_speed: float, lead: float
) -> None:
    east, north = drive("a", "east", lead + speed * TIME), drive("b", "north", other_speed * TIME)
    east_in, east_out = (EAST - HALF - lead) / speed, (EAST + HALF - lead) / speed
    north_in, north_out = (NORTH - HALF) / other_speed, (NORTH + HALF) / other_speed
    # Who is first must not hang on rounding.
    assume(abs(east_in - north_in) > 0.01)
    ((first, second, kind, value),) = _pets(east, north, road=road)
    assert kind == "crossing"
    if east_in < north_in:
        assert (first, second) == ("a", "b")
        assert value == pytest.approx(north_in - east_out, abs=0.005)
    else:
        assert (first, second) == ("b", "a")
        assert value == pytest.approx(east_in - north_out, abs=0.005)


def test_both_in_the_area_at_once_is_negative_and_kept(road: RoadMap, drive: Drive) -> None:
    east, north = drive("a", "east", 5.0 * TIME), drive("b", "north", 9.9 * TIME)
    ((_, _, _, value),) = _pets(east, north, road=road)
    assert value == pytest.approx((NORTH - HALF) / 9.9 - (EAST + HALF) / 5.0, abs=0.005)
    assert value < 0


def test_a_stop_before_the_area_counts_as_waiting(road: RoadMap, drive: Drive) -> None:
    waits = np.minimum(5.0 * TIME, 20.0) + np.maximum(0.0, 5.0 * (TIME - 15.0))
    ((first, _, _, value),) = _pets(drive("a", "east", waits), drive("b", "north", 10.0 * TIME), road=road)
    assert first == "b"
    assert value == pytest.approx(15.0 + (EAST - HALF - 20.0) / 5.0 - (NORTH + HALF) / 10.0, abs=0.005)


def test_a_later_start_shifts_the_clock(road: RoadMap, drive: Drive) -> None:
    at_once = _pets(drive("a", "east", 5.0 * TIME), drive("b", "north", 5.0 * TIME), road=road)
    later = _pets(drive("a", "east", 5.0 * TIME), drive("b", "north", 5.0 * TIME, first_step=20), road=road)
    assert later[0][3] == pytest.approx(at_once[0][3] + 20 * STEP)


def test_merging_is_measured_where_the_two_come_together(road: RoadMap, drive: Drive) -> None:
    """`merge` comes at an angle with tan = 30 / 58 and touches the ground of `east`, y = 1 m, with a corner first.

    Its centre is then at y = 1 + 2.5 sin + cos = 3.04 m, 6.6 m before its lane ends at x = -2 m, at 5 m/s.
    """
    east, merge = drive("a", "east", 10.0 * TIME), drive("b", "merge", 5.0 * TIME)
    ((first, second, kind, value),) = _pets(east, merge, road=road)
    assert (first, second, kind) == ("a", "b", "converging")
    sin, cos = 30 / math.hypot(58, 30), 58 / math.hypot(58, 30)
    before = (1 + 2.5 * sin + cos) / sin
    corner = -2 - before * cos + 2.5 * cos - sin
    assert value == pytest.approx((math.hypot(58, 30) - before) / 5 - (60 + corner + 2.5) / 10, abs=0.1)


def test_a_passage_that_never_completes_leaves_the_pair_out(road: RoadMap, drive: Drive) -> None:
    north = drive("b", "north", 10.0 * TIME)
    assert _pets(drive("a", "east", np.minimum(5.0 * TIME, EAST + HALF - 0.2)), north, road=road) == []
    assert _pets(drive("a", "east", np.minimum(5.0 * TIME, EAST - HALF - 1)), north, road=road) == []
    assert _pets(drive("a", "east", 45.0 + 5.0 * TIME), north, road=road) == [], "it was past the area from the start"
    assert len(_pets(drive("a", "east", np.minimum(5.0 * TIME, EAST + HALF + 0.2)), north, road=road)) == 1


def test_pairs_of_human_drivers_do_not_count(road: RoadMap, drive: Drive) -> None:
    s = 10.0 * TIME
    a, b = drive("a", "east", s, kind=Kind.HDV), drive("b", "north", s, kind=Kind.HDV)
    assert _pets(a, b, road=road) == []
    assert len(_pets(a, drive("c", "north", s), road=road)) == 1


def test_followers_on_one_route_have_none(road: RoadMap, drive: Drive) -> None:
    assert _pets(drive("a", "east", 20 + 8.0 * TIME), drive("b", "east", 8.0 * TIME), road=road) == []


def test_swapping_the_names_does_not_change_the_value(road: RoadMap, drive: Drive) -> None:
    one = _pets(drive("a", "east", 7.0 * TIME), drive("b", "north", 6.0 * TIME), road=road)
    other = _pets(drive("a", "north", 6.0 * TIME), drive("b", "east", 7.0 * TIME), road=road)
    assert one[0][3] == pytest.approx(other[0][3])
    assert one[0][:2] == other[0][1::-1]
