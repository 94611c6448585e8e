"""Where one CAV has to let another one go first."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from worlds import Junction

from codriving.reasoning.execution.meeting import Meeting
from codriving.reasoning.execution.violations import SIZES, passes_too_early

N = 30
ROUTES = ("south-north", "west-east")


def meeting(junction: Junction, place: float, there: float, lag: int = 5, pad: float = 1.0, until: int = N) -> Meeting:
    zones = [tuple(junction.road_map.zones(*ROUTES, size)) for size in SIZES]
    return Meeting(zones[0], place, there, until, lag, pad, tuple(zones[1:]))


def straight(*speeds: float) -> np.ndarray:
    """Plans at constant speed, five samples a second."""
    return np.outer(speeds, np.arange(N) * 0.2)


@settings(deadline=None)
@given(st.floats(70.0, 100.0), st.floats(70.0, 125.0), st.floats(0.0, 9.0), st.integers(0, 6), st.integers(1, N))
def test_a_meeting_of_two_who_are_apart_is_that_of_the_planning_size(
    junction: Junction, place: float, there: float, speed: float, lag: int, until: int
) -> None:
    travels, first = straight(0.0, 4.0, 9.0), straight(speed)[0]
    found = meeting(junction, place, there, lag, until=until).steps(travels, first)
    (zone,) = junction.road_map.zones(*ROUTES)
    motion = place + travels[:, :until]
    steps = passes_too_early(zone, motion, there + first, lag, 1.0)
    planning = np.where(steps < until, steps, N)
    if planning.any():
        assert found.tolist() == planning.tolist()
    else:
        assert (found >= planning).all()


def test_two_who_are_closer_than_planned_keep_what_room_there_is(junction: Junction) -> None:
    (large,) = junction.road_map.zones(*ROUTES)
    (true,) = junction.road_map.zones(*ROUTES, SIZES[-1])
    # Its nose is in the margin of the zone, and the other one stands in the way: it may stay, and not go on.
    place, there = (large.entry_i + true.entry_i) / 2, (true.entry_j + true.exit_j) / 2
    m = meeting(junction, place, there)
    stays, goes = m.steps(straight(0.0, 6.0), straight(0.0)[0]).tolist()
    assert stays == N
    assert 0 < goes < N
    # Without smaller sizes every plan is as bad as any other.
    assert replace(m, smaller=()).steps(straight(0.0, 6.0), straight(0.0)[0]).tolist() == [0, 0]


def test_bodies_that_touch_already_leave_no_plan(junction: Junction) -> None:
    (true,) = junction.road_map.zones(*ROUTES, SIZES[-1])
    m = meeting(junction, (true.entry_i + true.exit_i) / 2, (true.entry_j + true.exit_j) / 2)
    assert m.steps(straight(0.0, 9.0), straight(0.0)[0]).tolist() == [0, 0]


def test_nobody_is_minded_for_longer_than_asked(junction: Junction) -> None:
    (zone,) = junction.road_map.zones(*ROUTES)
    place, there = zone.entry_i - 9.0, (zone.entry_j + zone.exit_j) / 2
    travels, stands = straight(9.0), straight(0.0)[0]
    (step,) = meeting(junction, place, there).steps(travels, stands)
    assert 0 < step < N
    assert meeting(junction, place, there, until=int(step)).steps(travels, stands).tolist() == [N]
    assert meeting(junction, place, there, until=int(step) + 1).steps(travels, stands).tolist() == [step]


@pytest.mark.parametrize("lag", [0, 5])
def test_the_second_waits_until_the_first_has_left_for_long_enough(lag: int, junction: Junction) -> None:
    (zone,) = junction.road_map.zones(*ROUTES)
    first = straight(6.0)[0]
    m = meeting(junction, zone.entry_i - 8.0, zone.entry_j - 2.0, lag, pad=0.0)
    speeds = np.linspace(0.5, 9.0, 30)
    works = m.steps(straight(*speeds), first) == N
    assert works[0]
    assert not works[-1]
    assert works.tolist() == sorted(works.tolist(), reverse=True), "the slower, the better"
    fastest = place = zone.entry_i - 8.0 + straight(float(speeds[works][-1]))[0]
    inside = np.flatnonzero(fastest > zone.entry_i + 0.5)
    if inside.size and inside[0] > lag:
        left = zone.entry_j - 2.0 + first[inside[0] - lag]
        assert left > float(zone.mirrored().front(place[inside[0]]))
