"""Do two motions keep out of each other's way?"""

import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from worlds import Junction

from codriving.geometry.clearance import (
    MANY,
    covered_after,
    first_overlap,
    halts_behind,
    reacts,
    stays_ahead,
    stays_behind,
)

TIMES = np.arange(51) * 0.2
PLACES = st.floats(60.0, 125.0)
SPEEDS = st.floats(0.0, 9.0)
OTHERS = st.sampled_from(["west-east", "west-north", "east-south", "north-east"])


@settings(max_examples=60, deadline=None)
@given(OTHERS, PLACES, PLACES, SPEEDS, SPEEDS, st.integers(0, 4))
def test_a_vehicle_that_stays_behind_or_ahead_does_not_overlap(
    junction: Junction, other: str, s: float, t: float, v: float, w: float, lag: int
) -> None:
    mine, theirs = (s + v * TIMES)[None], t + w * TIMES
    for zone in junction.road_map.zones("south-north", other):
        behind = stays_behind(zone, mine, theirs, lag, 0.0)[0]
        ahead = stays_ahead(zone, mine, theirs, lag, 0.0)[0]
        # The two tables of a zone may differ by a row where it begins or ends; what stays an overlap a row on is one.
        deep = [
            (mine[0] >= zone.back(theirs + row)) & (mine[0] <= zone.front(theirs + row)) for row in (-0.6, 0.0, 0.6)
        ]
        # With a lag the first moments count as well.
        assert not np.all(deep, axis=0).any() or not (behind or ahead)
        # The same, seen from the other one.
        back = zone.mirrored()
        assert ahead == stays_behind(back, theirs[None], mine[0], lag, 0.0)[0] or lag > 0
        # More lag and more room are never easier.
        assert behind >= stays_behind(zone, mine, theirs, lag + 2, 0.0)[0]
        assert ahead >= stays_ahead(zone, mine, theirs, lag, 1.0)[0]


def test_with_a_lag_the_first_moments_count(junction: Junction) -> None:
    # Both are in the zone within a second, and out of it again before the lag of two seconds is over.
    (zone,) = junction.road_map.zones("west-east", "north-south")
    mine, theirs = (zone.entry_i - 2.0 + 9.0 * TIMES)[None], zone.entry_j - 2.0 + 9.0 * TIMES
    assert first_overlap(zone, mine, theirs)[0] < 10
    assert not stays_behind(zone, mine, theirs, 10, 0.0)[0]
    assert not stays_ahead(zone, mine, theirs, 10, 0.0)[0]


def test_first_overlap_is_the_moment_of_meeting(junction: Junction) -> None:
    (zone,) = junction.road_map.zones("south-north", "west-east")
    stands = np.full(51, (zone.entry_j + zone.exit_j) / 2)
    mine = np.stack([60.0 + 9.0 * TIMES, np.full(51, 60.0)])
    steps = first_overlap(zone, mine, stands)
    assert steps[1] == 51
    assert abs(mine[0, steps[0]] - zone.entry_i) < 4.0


def test_a_motion_that_ends_behind_another_can_stop_there(junction: Junction) -> None:
    (following,) = junction.road_map.zones("south-north", "south-north")
    mine = (60.0 + 6.0 * TIMES)[None]
    # It comes to 120 m, stops 6^2 / (2 x 3) = 6 m on, and needs 6 m to the centre of the vehicle ahead.
    assert halts_behind(following, mine, np.full(51, 132.1), 0.2).tolist() == [True]
    assert halts_behind(following, mine, np.full(51, 131.9), 0.2).tolist() == [False]
    assert halts_behind(following, mine, 66.1 + 6.0 * TIMES, 0.2).tolist() == [True], "it stops as late"


def test_a_driver_reacts_to_a_vehicle_in_the_zone_and_no_other(junction: Junction) -> None:
    (zone,) = junction.road_map.zones("south-north", "west-east")
    theirs = 40.0 + 8.0 * TIMES
    slowed = reacts(zone, (100.0 + 5.0 * TIMES)[None], theirs, 0.2)
    assert np.array_equal(slowed[:5], theirs[:5])
    assert slowed[-1] < theirs[-1]
    assert (np.diff(slowed) >= -1e-9).all()
    assert np.array_equal(reacts(zone, (20.0 + 1.0 * TIMES)[None], theirs, 0.2), theirs)
    both = reacts(zone, np.array([100.0 + 5.0 * TIMES, 20.0 + 1.0 * TIMES]), theirs, 0.2)
    assert np.array_equal(both, [slowed, theirs])


@settings(deadline=None)
@given(OTHERS, PLACES, SPEEDS, st.integers(0, 5))
def test_of_many_motions_the_steps_before_the_zone_may_be_left_out(
    junction: Junction, other: str, t: float, w: float, lag: int
) -> None:
    mine = np.array([place + v * TIMES for place in (20.0, 60.0, 85.0, 110.0) for v in np.linspace(0.0, 9.0, 13)])
    assert len(mine) > MANY
    for zone in junction.road_map.zones("south-north", other):
        each = [stays_behind(zone, one[None], t + w * TIMES, lag, 0.5)[0] for one in mine]
        assert stays_behind(zone, mine, t + w * TIMES, lag, 0.5).tolist() == each
        late = mine[: MANY + 1] - 200.0
        assert stays_behind(zone, late, t + w * TIMES, lag, 0.5).all()


def test_when_a_distance_is_covered() -> None:
    travel, times = [0.0, 1.0, 3.0], [0.0, 0.5, 1.0]
    assert covered_after((-1.0, 0.0, 0.5, 1.0, 2.0, 5.0), travel, times, 0.5) == (0.0, 0.0, 0.25, 0.5, 0.75, 1.5)
    assert covered_after((1.0,), [0.0, 0.0, 0.0], times, 0.5) == (math.inf,)
    # A vehicle that is taken to be a little ahead has covered less than that already.
    assert covered_after((0.5,), [1.0, 1.0, 1.0], times, 0.5) == (-math.inf,)


@settings(deadline=None)
@given(OTHERS, st.integers(0, 5), st.floats(0.0, 2.0))
def test_staying_ahead_of_several_is_that_of_each(junction: Junction, other: str, lag: int, pad: float) -> None:
    mine = np.array([85.0 + v * TIMES for v in (3.0, 6.0, 9.0)])
    theirs = np.array([place + 8.0 * TIMES for place in (40.0, 75.0, 90.0)])
    for zone in junction.road_map.zones("south-north", other):
        one_by_one = [stays_ahead(zone, m[None], o, lag, pad)[0] for m, o in zip(mine, theirs, strict=True)]
        assert stays_ahead(zone, mine, theirs, lag, pad).tolist() == one_by_one
