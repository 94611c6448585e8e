"""When two motions come too close: one after the other, or onto a stretch where somebody may be."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from worlds import Junction

from codriving.geometry.box import PLANNING, corners, overlap
from codriving.geometry.zone import ConflictZone
from codriving.reasoning.execution.violations import first_true, meets, passes_too_early

PAIRS = (
    ("south-north", "west-east"),  # crossing
    ("south-west", "north-south"),
    ("south-north", "west-north"),  # converging
    ("west-east", "south-east"),
    ("south-north", "south-west"),  # diverging
    ("south-north", "south-north"),  # one behind the other
)
N = 20

pairs = st.sampled_from(PAIRS)
places = st.floats(80.0, 135.0)
paces = st.lists(st.floats(0.0, 2.0), min_size=N - 1, max_size=N - 1)
lags = st.integers(0, 8)
pads = st.floats(0.0, 3.0)


def zone_of(junction: Junction, pair: tuple[str, str]) -> ConflictZone:
    (zone,) = junction.road_map.zones(*pair)
    return zone


def motion(begin: float, steps: list[float]) -> np.ndarray:
    return begin + np.concatenate([[0.0], np.cumsum(steps)])


@settings(deadline=None)
@given(pairs, places, places, pads)
def test_two_points_meet_where_the_front_and_back_functions_say(
    junction: Junction, pair: tuple[str, str], mine: float, theirs: float, pad: float
) -> None:
    zone = zone_of(junction, pair)
    there = np.array([theirs])
    seen = zone.mirrored()
    expected = seen.back(mine) - pad <= theirs <= seen.front(mine) + pad
    assert (meets(zone, np.array([[mine]]), there, there, 0, pad)[0] == 0) == expected


@settings(deadline=None)
@given(pairs, places, places)
def test_two_bodies_that_overlap_meet(junction: Junction, pair: tuple[str, str], mine: float, theirs: float) -> None:
    paths = [junction.road_map.paths[route] for route in pair]
    bodies = [
        corners(*p.position(s), p.heading(s), PLANNING.length - 0.3, PLANNING.width - 0.3)
        for p, s in zip(paths, (mine, theirs), strict=True)
    ]
    there = np.array([theirs])
    if overlap(*bodies):
        assert meets(zone_of(junction, pair), np.array([[mine]]), there, there, 0, 0.0)[0] == 0


@settings(deadline=None)
@given(pairs, places, paces, places, paces, places, lags, pads, st.integers(0, 4), st.floats(0.0, 2.0))
def test_more_time_or_room_is_never_kept_for_longer(
    junction: Junction,
    pair: tuple[str, str],
    mine: float,
    my_paces: list[float],
    theirs: float,
    paces: list[float],
    most: float,
    lag: int,
    pad: float,
    later: int,
    wider: float,
) -> None:
    zone, ego = zone_of(junction, pair), motion(mine, my_paces)[None]
    low = motion(theirs, paces)
    high = low + max(most - theirs, 0.0)
    for more in ((lag + later, pad), (lag, pad + wider)):
        assert meets(zone, ego, low, high, *more)[0] <= meets(zone, ego, low, high, lag, pad)[0]
        assert passes_too_early(zone, ego, low, *more)[0] <= passes_too_early(zone, ego, low, lag, pad)[0]
    # The less is known of somebody, the more is blocked.
    assert meets(zone, ego, low - wider, high + wider, lag, pad)[0] <= meets(zone, ego, low, high, lag, pad)[0]


@settings(deadline=None)
@given(pairs, places, paces, places, paces, lags, pads)
def test_whoever_touches_the_other_from_behind_passes_too_early(
    junction: Junction,
    pair: tuple[str, str],
    mine: float,
    my_paces: list[float],
    theirs: float,
    paces: list[float],
    lag: int,
    pad: float,
) -> None:
    # To go second is to be behind all along: more than just not to touch the other.
    zone, ego, first = zone_of(junction, pair), motion(mine, my_paces)[None], motion(theirs, paces)
    early = passes_too_early(zone, ego, first, lag, pad)[0]
    behind = np.concatenate([np.full(lag, first[0]), first])[:N]
    touched = first_true((zone.over_i.lowest(ego) - pad <= behind) & (zone.over_i.highest(ego) + pad >= behind))[0]
    assert early <= touched
    if early == N:
        assert (behind > zone.mirrored().front(ego[0]) + pad).all()


@settings(deadline=None)
@given(pairs, paces, lags, pads)
def test_far_from_the_zone_nobody_comes_too_close(
    junction: Junction, pair: tuple[str, str], paces: list[float], lag: int, pad: float
) -> None:
    zone = zone_of(junction, pair)
    ego, first = motion(10.0, paces)[None], motion(80.0, paces)
    assert meets(zone, ego, first, first, lag, pad)[0] == N
    assert passes_too_early(zone, ego, first, lag, pad)[0] == N


def test_the_step_is_the_first_one_of_each_plan(junction: Junction) -> None:
    zone = zone_of(junction, ("south-north", "west-east"))
    plans = np.stack([np.linspace(zone.entry_i - 10.0, zone.exit_i - 1.0, N), np.full(N, zone.entry_i - 10.0)])
    stands = np.full(N, (zone.entry_j + zone.exit_j) / 2)
    steps = meets(zone, plans, stands, stands, 0, 0.0)
    assert 0 < steps[0] < N
    assert steps[1] == N
    lone = [int(meets(zone, plans[:1, : k + 1], stands, stands, 0, 0.0)[0]) for k in range(N)]
    assert lone == [k + 1 if k < steps[0] else steps[0] for k in range(N)]


@pytest.mark.parametrize("lag", [0, 3, 5, 6, 40])
def test_a_short_look_may_be_shorter_than_the_time_between_the_two(lag: int, junction: Junction) -> None:
    # Whoever changes lanes minds the one that it leaves for less time than there is to lie between two vehicles.
    zone = zone_of(junction, ("south-north", "south-north"))
    ego, first = motion(60.0, [1.5] * 4)[None], motion(68.0, [1.5] * (N - 1))
    behind = np.concatenate([np.full(lag, first[0]), first])[:5]
    expected = int(first_true((behind <= zone.mirrored().front(ego[0]))[None])[0])
    assert passes_too_early(zone, ego, first, lag, 0.0)[0] == expected
    assert meets(zone, ego, first, first, lag, 0.0)[0] <= expected


def test_nothing_is_found_among_no_plans() -> None:
    assert first_true(np.zeros((0, 4), dtype=np.bool_)).shape == (0,)
    assert first_true(np.array([[False, True, True], [False, False, False]])).tolist() == [1, 3]
