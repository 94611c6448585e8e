"""When two motions come too close: one after the other, or onto a stretch where a vehicle may be."""

from dataclasses import replace

import numpy as np
import pytest
from driven import layered, moment_of, ordered, ordering_of, planned, puppets
from hypothesis import given, settings
from hypothesis import strategies as st
from worlds import Car, Junction, car

from codriving.datatypes.world import Action
from codriving.geometry.box import PLANNING, TRUE, corners, overlap
from codriving.geometry.zone import ConflictZone
from codriving.reasoning.execution.planned import Executor
from codriving.reasoning.execution.violations import SIZES, Meeting, first_true, meets, minds_humans, passes_too_early

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
    # The less is known of a vehicle, the more is blocked.
    assert meets(zone, ego, low - wider, high + wider, lag, pad)[0] <= meets(zone, ego, low, high, lag, pad)[0]


@settings(deadline=None)
@given(pairs, places, paces, places, paces, lags, pads)
def test_a_vehicle_that_touches_the_other_from_behind_passes_too_early(
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
def test_far_from_the_zone_no_vehicle_comes_too_close(
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
    # After a lane change the vehicle that is left is minded for less time than there is to lie between two vehicles.
    zone = zone_of(junction, ("south-north", "south-north"))
    ego, first = motion(60.0, [1.5] * 4)[None], motion(68.0, [1.5] * (N - 1))
    behind = np.concatenate([np.full(lag, first[0]), first])[:5]
    expected = int(first_true((behind <= zone.mirrored().front(ego[0]))[None])[0])
    assert passes_too_early(zone, ego, first, lag, 0.0)[0] == expected
    assert meets(zone, ego, first, first, lag, 0.0)[0] <= expected


def test_nothing_is_found_among_no_plans() -> None:
    assert first_true(np.zeros((0, 4), dtype=np.bool_)).shape == (0,)
    assert first_true(np.array([[False, True, True], [False, False, False]])).tolist() == [1, 3]


SAMPLES = 30
ROUTES = ("south-north", "west-east")


def meeting(
    junction: Junction, place: float, there: float, lag: int = 5, pad: float = 1.0, until: int = SAMPLES
) -> Meeting:
    zones = [tuple(junction.road_map.zones(*ROUTES, size)) for size in SIZES]
    return Meeting(tuple(zones), place, there, until, lag, pad)


def straight(*speeds: float) -> np.ndarray:
    """Plans at constant speed, five samples a second."""
    return np.outer(speeds, np.arange(SAMPLES) * 0.2)


@settings(deadline=None)
@given(st.floats(70.0, 100.0), st.floats(70.0, 125.0), st.floats(0.0, 9.0), st.integers(0, 6), st.integers(1, SAMPLES))
def test_a_meeting_of_two_who_are_apart_is_that_of_the_planning_size(
    junction: Junction, place: float, there: float, speed: float, lag: int, until: int
) -> None:
    travels, first = straight(0.0, 4.0, 9.0), straight(speed)[0]
    found = meeting(junction, place, there, lag, until=until).steps(travels, first)
    (zone,) = junction.road_map.zones(*ROUTES)
    motion = place + travels[:, :until]
    steps = passes_too_early(zone, motion, there + first, lag, 1.0)
    planning = np.where(steps < until, steps, SAMPLES)
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
    assert stays == SAMPLES
    assert 0 < goes < SAMPLES
    # Without smaller sizes every plan is as bad as any other.
    assert replace(m, zones=m.zones[:1]).steps(straight(0.0, 6.0), straight(0.0)[0]).tolist() == [0, 0]


def test_bodies_that_touch_already_leave_no_plan(junction: Junction) -> None:
    (true,) = junction.road_map.zones(*ROUTES, SIZES[-1])
    m = meeting(junction, (true.entry_i + true.exit_i) / 2, (true.entry_j + true.exit_j) / 2)
    assert m.steps(straight(0.0, 9.0), straight(0.0)[0]).tolist() == [0, 0]


def test_no_vehicle_is_minded_for_longer_than_asked(junction: Junction) -> None:
    (zone,) = junction.road_map.zones(*ROUTES)
    place, there = zone.entry_i - 9.0, (zone.entry_j + zone.exit_j) / 2
    travels, stands = straight(9.0), straight(0.0)[0]
    (step,) = meeting(junction, place, there).steps(travels, stands)
    assert 0 < step < SAMPLES
    assert meeting(junction, place, there, until=int(step)).steps(travels, stands).tolist() == [SAMPLES]
    assert meeting(junction, place, there, until=int(step) + 1).steps(travels, stands).tolist() == [step]


@pytest.mark.parametrize("lag", [0, 5])
def test_the_second_waits_until_the_first_has_left_for_long_enough(lag: int, junction: Junction) -> None:
    (zone,) = junction.road_map.zones(*ROUTES)
    first = straight(6.0)[0]
    m = meeting(junction, zone.entry_i - 8.0, zone.entry_j - 2.0, lag, pad=0.0)
    speeds = np.linspace(0.5, 9.0, 30)
    works = m.steps(straight(*speeds), first) == SAMPLES
    assert works[0]
    assert not works[-1]
    assert works.tolist() == sorted(works.tolist(), reverse=True), "the slower, the better"
    fastest = place = zone.entry_i - 8.0 + straight(float(speeds[works][-1]))[0]
    inside = np.flatnonzero(fastest > zone.entry_i + 0.5)
    if inside.size and inside[0] > lag:
        left = zone.entry_j - 2.0 + first[inside[0] - lag]
        assert left > float(zone.mirrored().front(place[inside[0]]))


def touching(junction: Junction, one: Car, a: np.ndarray, other: Car, b: np.ndarray) -> bool:
    """Whether the bodies of two vehicles overlap at any step."""
    places = [(s, t) for s, t in zip(a, b, strict=True) if np.isfinite(s) and np.isfinite(t)]
    for s, t in places:
        paths = [junction.road_map.paths[c.route] for c in (one, other)]
        bodies = [corners(*p.position(q), p.heading(q), 5.0, 2.0) for p, q in zip(paths, (s, t), strict=True)]
        if overlap(*bodies):
            return True
    return False


def stands_in(junction: Junction, route: str, other: str, share: float) -> Car:
    """A driver who stands in the zone that a route shares with another one, or where the two merge."""
    (zone,) = junction.road_map.zones(route, other, TRUE)
    end = zone.exit_j if zone.merge_j is None else zone.merge_j
    return car("HDV1", other, zone.entry_j + share * (end - zone.entry_j), 0.0)


@pytest.mark.parametrize("make", [planned, layered])
@pytest.mark.parametrize("share", [0.3, 0.5])
@pytest.mark.parametrize("other", ["west-east", "east-west", "west-north"])
def test_a_driver_who_stands_in_a_zone_is_never_run_into(
    other: str, share: float, make: type[Executor], junction: Junction
) -> None:
    human = stands_in(junction, "south-north", other, share)
    for place in (40.0, 80.0):
        me = car("CAV1", "south-north", place, 9.0)
        show = puppets(junction, ordered(junction, executor=make()), [me, human], 20.0)
        assert not touching(junction, me, show.places["CAV1"], human, show.places["HDV1"])
        (zone,) = junction.road_map.zones("south-north", other, TRUE)
        assert show.places["CAV1"].max() < zone.entry_i
        assert show.places["CAV1"].max() > zone.entry_i - 40.0, "it comes near all the same"


def test_no_vehicle_runs_into_a_driver_who_stands_ahead(junction: Junction) -> None:
    me, human = car("CAV1", "south-north", 50.0, 9.0), car("HDV1", "south-north", 85.0, 0.0)
    show = puppets(junction, ordered(junction), [me, human], 15.0)
    assert 60.0 < show.places["CAV1"].max() < 79.5


@pytest.mark.parametrize("make", [planned, layered])
def test_a_driver_who_waits_does_not_hold_up_the_cavs(make: type[Executor], junction: Junction) -> None:
    # Two CAVs cross, and a driver right before the zone lets all pass, though no CAV can tell that at first.
    (zone,) = junction.road_map.zones("south-north", "west-east")
    for before in (2.0, 6.0):
        cars = [
            car("CAV1", "south-north", 60.0, 8.0),
            car("CAV2", "east-west", 62.0, 8.0),
            car("HDV1", "west-east", zone.entry_j - before, 0.0),
        ]
        show = puppets(junction, ordered(junction, executor=make()), cars, 40.0)
        assert show.arrived("CAV1")
        assert show.arrived("CAV2")


def test_a_driver_who_goes_on_is_let_through(junction: Junction) -> None:
    # Both would be there at the same time, and the driver has the right of way and does nothing about it.
    for place in (60.0, 66.0, 72.0):
        me, human = car("CAV1", "south-north", 66.0, 8.0), car("HDV1", "west-east", place, 8.0)
        show = puppets(junction, ordered(junction), [me, human], 25.0)
        mine, theirs = show.places["CAV1"], show.places["HDV1"]
        assert not touching(junction, me, mine, human, theirs), place
        assert show.arrived("CAV1")
        (zone,) = junction.road_map.zones("south-north", "west-east", TRUE)
        left, entered = np.argmax(theirs > zone.exit_j), np.argmax(mine > zone.entry_i)
        assert (entered - left) * junction.model.step > 1.0, "there is time between the two"


def test_a_vehicle_that_drives_behind_minds_the_cav_and_not_the_other_way_round(junction: Junction) -> None:
    me, behind = car("CAV1", "south-north", 60.0, 6.0), car("HDV1", "south-north", 53.0, 9.0)
    moment = moment_of(junction.thoughts(me, behind))
    drive = planned().drive(moment, ordering_of("CAV1"))
    assert drive.actions == {"CAV1": Action.FASTER}
    assert drive.expected["HDV1"][0].places[0] == pytest.approx(53.0)


def test_the_one_behind_a_slow_driver_does_not_come_too_close(junction: Junction) -> None:
    me, ahead = car("CAV1", "south-north", 30.0, 9.0), car("HDV1", "south-north", 55.0, 2.0)
    show = puppets(junction, ordered(junction), [me, ahead], 15.0)
    assert (show.places["HDV1"] - show.places["CAV1"]).min() > 5.5
    assert show.places["CAV1"][-1] > 65.0, "it keeps up"


def test_what_is_on_no_route_holds_no_plan_up(junction: Junction) -> None:
    """A place that a message gives can lie beside the road."""
    ego = car("CAV1", "south-north", 80.0, 8.0)
    drives = np.arange(N, dtype=np.float64)[None]
    for offset, routes, first in ((0.0, 3, 10), (12.0, 0, N)):
        human = replace(car("HDV1", "south-north", 96.0, 0.0), offset=offset)
        moment = junction.thoughts(ego, human).moment()
        known = moment.vehicles["CAV1"]
        assert len(known["HDV1"].routes) == routes
        assert minds_humans(moment, known["CAV1"], drives, 0, 0, 0.0).tolist() == [first]
