"""How all vehicles are expected to move if the passing order is kept."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from worlds import LAG, Junction, Thoughts, car, order_of

from codriving.datatypes.order import PassingOrder
from codriving.datatypes.world import Action, DrivingModel
from codriving.geometry.clearance import first_overlap
from codriving.reasoning.conflicts import is_behind
from codriving.reasoning.prediction.expectation import Expected, expect, keeps_order, worth
from codriving.reasoning.prediction.rollout import FIRST, HOLDS, PLANS, ROLLS, WAITS, plan_library, starts_with

HEADWAY = 0.8


def expected(
    thoughts: Thoughts, order: PassingOrder, ego: str = "CAV1", minds_conflicts: bool = True
) -> dict[str, tuple[Expected, ...]]:
    return expect(replace(thoughts.moment(), sees_conflicts=minds_conflicts), ego, order, LAG)


def overlap(junction: Junction, one: Expected, other: Expected) -> bool:
    zones = junction.road_map.zones(one.route, other.route)
    return any(first_overlap(z, one.places[None], other.places)[0] < len(one.places) for z in zones)


@pytest.mark.parametrize("first", ["CAV1", "CAV2"])
def test_the_first_goes_freely_and_the_second_keeps_out_of_its_way(first: str, junction: Junction) -> None:
    second = "CAV2" if first == "CAV1" else "CAV1"
    thoughts = junction.thoughts(car("CAV1", "south-north", 70.0, 6.0), car("CAV2", "west-east", 74.0, 6.0))
    found = expected(thoughts, order_of(f"{first} {second}"))
    (leader,), (waits,) = found[first], found[second]
    assert leader.free
    assert not waits.free
    assert leader.places[-1] > waits.places[-1]
    assert not overlap(junction, leader, waits)


def test_a_human_driver_whose_way_is_open_counts_in_what_an_action_gets(junction: Junction) -> None:
    cars = car("CAV1", "south-north", 78.0, 8.0), car("HDV1", "west-east", 76.0, 8.0)
    thoughts = junction.thoughts(*cars)
    (human,) = thoughts.scenes["CAV1"].neighbours
    assert {route for route, _ in human.routes} == {"west-east", "west-north", "west-south"}

    def gets(*ways: str) -> float:
        only = replace(human, routes=tuple(r for r in human.routes if r[0] in ways))
        scene = replace(thoughts.scenes["CAV1"], neighbours=(only,))
        known = replace(thoughts, scenes={"CAV1": scene})
        return expected(known, order_of("HDV1 CAV1"))["CAV1"][0].progress[Action.IDLE]

    across, away = gets("west-east"), gets("west-south")
    assert across < away
    assert gets("west-east", "west-south") == pytest.approx((across + away) / 2)


@settings(max_examples=30, deadline=None)
@given(
    st.sampled_from(["west-east", "west-north", "east-west", "north-east", "east-south"]),
    st.floats(30.0, 85.0),
    st.floats(30.0, 85.0),
    st.floats(0.0, 9.0),
    st.floats(0.0, 9.0),
)
def test_an_order_that_is_kept_leaves_no_overlap(
    junction: Junction, other: str, s: float, t: float, v: float, w: float
) -> None:
    thoughts = junction.thoughts(car("CAV1", "south-north", s, v), car("CAV2", other, t, w))
    found = expected(thoughts, thoughts.negotiate())
    assume(all(motion.progress for name in found for motion in found[name]))
    assert not overlap(junction, found["CAV1"][0], found["CAV2"][0])


def test_human_drivers_are_expected_to_go_on_at_their_speed_on_each_route(junction: Junction) -> None:
    thoughts = junction.thoughts(car("CAV1", "south-north", 80.0, 6.0), car("HDV1", "west-east", 80.0, 6.0))
    found = expected(thoughts, order_of("HDV1 CAV1"))["HDV1"]
    assert {motion.route for motion in found} == {"west-east", "west-north", "west-south"}
    for motion in found:
        assert motion.free
        assert not motion.progress
        assert motion.places[-1] - motion.places[0] == pytest.approx(6.0 * thoughts.forecast.times[-1])


def test_a_human_driver_who_goes_second_holds_no_vehicle_up(junction: Junction) -> None:
    thoughts = junction.thoughts(car("CAV1", "south-north", 88.0, 6.0), car("HDV1", "west-east", 108.0, 2.0))
    assert len(thoughts.scenes["CAV1"].neighbours[0].routes) == 1
    held, free = (expected(thoughts, order_of(pair))["CAV1"][0] for pair in ("HDV1 CAV1", "CAV1 HDV1"))
    assert free.free
    assert not held.free
    assert held.places[-1] < free.places[-1]


def test_followers_stay_behind_their_leaders_without_being_told(junction: Junction) -> None:
    thoughts = junction.thoughts(car("CAV1", "south-north", 60.0, 9.0), car("CAV2", "south-north", 75.0, 3.0, 0.0))
    found = expected(thoughts, PassingOrder((), ()))
    gap = found["CAV2"][0].places - found["CAV1"][0].places
    assert (gap > 5.0).all()


@pytest.mark.parametrize(("gap", "lag", "keeps"), [(24.0, LAG, True), (21.0, LAG, False), (21.0, 2, True)])
def test_a_follower_keeps_a_headway_or_the_margin_if_that_is_less(
    gap: float, lag: int, keeps: bool, junction: Junction
) -> None:
    thoughts = junction.thoughts(car("CAV1", "south-north", 30.0, 9.0), car("CAV2", "south-north", 60.0, 9.0))
    times = thoughts.forecast.times
    assert round(HEADWAY / thoughts.forecast.sample) < LAG
    # At 20 m/s the headway takes 16 m and the margin of these worlds 20 m, from one planning footprint to the next.
    ahead = {"CAV2": (Expected("south-north", 30.0 + gap + 20 * times, True, {}),)}
    route, order = "south-north", PassingOrder((), ())
    (flag,) = keeps_order(thoughts.moment(), "CAV1", "CAV1", route, (30.0 + 20 * times)[None], ahead, order, lag, True)
    assert flag == keeps


@pytest.mark.parametrize(
    ("first", "place", "by_zone", "keeps"),
    [
        ("CAV2", 70.0, True, True),
        ("CAV2", 70.0, False, False),
        ("CAV2", 76.0, True, False),  # Out of its way, but not by the margin of 1 s
        ("CAV2", 100.0, True, False),
        ("HDV1", 70.0, True, False),  # No human driver is driven past on account of when it is likely to come
    ],
)
def test_zone_by_zone_a_cav_may_pass_before_one_that_goes_first_if_it_is_out_of_its_way_in_time(
    first: str, place: float, by_zone: bool, keeps: bool, junction: Junction
) -> None:
    thoughts = junction.thoughts(car("CAV1", "south-north", 85.0, 8.0), car(first, "west-east", place, 8.0))
    moment, times = replace(thoughts.moment(), by_zone=by_zone), thoughts.forecast.times
    ahead = {first: (Expected("west-east", place + 8 * times, True, {}),)}
    own, order = (85.0 + 8 * times)[None], order_of(f"{first} CAV1")
    (flag,) = keeps_order(moment, "CAV1", "CAV1", "south-north", own, ahead, order, LAG, True)
    assert flag == keeps


def test_who_changes_lanes_is_expected_on_both_of_them(highway: Junction) -> None:
    thoughts = highway.thoughts(car("CAV1", "lane-0", 300.0, 20.0, offset=2.5))
    entered, left = expected(thoughts, PassingOrder((), ()))["CAV1"]
    assert (entered.route, left.route) == ("lane-0", "lane-1")
    assert set(entered.progress) == set(FIRST) - {Action.HOLD}
    assert left.progress == {}
    assert np.allclose(entered.places, left.places)


@pytest.mark.parametrize(("gap", "minded"), [(14.0, True), (60.0, False)])
def test_the_lane_that_is_left_counts_until_the_body_is_off_it(gap: float, minded: bool, highway: Junction) -> None:
    # A slow vehicle ahead on the lane that is left: it matters only if it is reached before the body is off that lane.
    thoughts = highway.thoughts(
        car("CAV1", "lane-0", 300.0, 20.0, 25.0, offset=2.5), car("HDV1", "lane-1", 300.0 + gap, 14.0)
    )
    motion = expected(thoughts, PassingOrder((), ()))["CAV1"][0]
    assert motion.free is not minded
    stays = highway.thoughts(car("CAV1", "lane-1", 300.0, 20.0, 25.0), car("HDV1", "lane-1", 300.0 + gap, 14.0))
    assert not expected(stays, PassingOrder((), ()))["CAV1"][0].free


def test_who_follows_a_vehicle_that_changes_onto_its_lane_minds_it(highway: Junction) -> None:
    me = car("CAV1", "lane-1", 300.0, 25.0)
    for offset, minded in ((0.0, False), (1.0, True)):
        thoughts = highway.thoughts(me, car("CAV2", "lane-0", 325.0, 18.0, offset=offset))
        assert expected(thoughts, PassingOrder((), ()))["CAV1"][0].free is not minded


def test_who_detects_no_conflicts_minds_those_ahead_and_no_others(junction: Junction) -> None:
    me = car("CAV1", "south-north", 80.0, 6.0)
    crossing, ahead = car("CAV2", "west-east", 104.0, 2.0), car("CAV2", "south-north", 95.0, 3.0, 0.0)
    for other, free in ((crossing, True), (ahead, False)):
        found = expected(junction.thoughts(me, other), PassingOrder((), ()), minds_conflicts=False)
        assert found["CAV1"][0].free is free
    assert not expected(junction.thoughts(me, crossing), order_of("CAV2 CAV1"))["CAV1"][0].free


def test_progress_is_that_of_the_best_plan_that_begins_with_an_action(junction: Junction) -> None:
    thoughts = junction.thoughts(car("CAV1", "south-north", 60.0, 6.0))
    ((motion,),) = expected(thoughts, PassingOrder((), ())).values()
    assert motion.free
    assert set(motion.progress) == set(FIRST) - {Action.HOLD}
    assert motion.progress[Action.FASTER] > motion.progress[Action.IDLE] > motion.progress[Action.SLOWER] > 0
    assert motion.progress[Action.FASTER] == pytest.approx(float(worth((motion.places - motion.places[0])[None])[0]))


def test_of_two_ways_that_end_at_one_place_the_one_that_is_there_earlier_is_worth_more() -> None:
    waits, hurries = np.array([0.0, 0.0, 0.0, 40.0]), np.array([0.0, 30.0, 40.0, 40.0])
    slow, fast = worth(np.array([waits, hurries]))
    assert slow < fast < 40.0
    # Arriving at last still counts more than having been quick.
    assert worth(np.array([[0.0, 0.0, 0.0, 50.0]]))[0] > fast


def test_no_progress_where_the_order_cannot_be_kept(junction: Junction) -> None:
    # It is in the zone already, and is told to let the other one pass first.
    thoughts = junction.thoughts(car("CAV1", "south-north", 107.0, 6.0), car("CAV2", "west-east", 80.0, 6.0))
    (motion,) = expected(thoughts, order_of("CAV2 CAV1"))["CAV1"]
    assert not motion.progress
    assert not motion.free


def test_plans_are_each_something_now_then_waiting_or_rolling_then_going_or_holding() -> None:
    slower, idle, faster = Action.SLOWER, Action.IDLE, Action.FASTER
    assert len(set(PLANS)) == len(PLANS)
    assert PLANS[0] == (faster, faster), "the vehicle that is best off with it is held up by none"
    assert PLANS[-1] == (slower, slower), "what is expected of the vehicle that cannot keep the order"
    first = starts_with(PLANS)
    assert sorted(k for indices in first.values() for k in indices) == list(range(len(PLANS)))
    for action, indices in first.items():
        mine = {PLANS[k] for k in indices}
        assert {plan[0] for plan in mine} == {action}
        assert {(action, faster), (action, slower), (action, idle)} <= mine
        assert {(action, *(slower,) * k, faster) for k in WAITS} <= mine
        assert {(action, *(idle,) * k, faster) for k in ROLLS} <= mine
        assert {(action, *(change,) * k, idle) for change in (slower, faster) for k in HOLDS} <= mine


def test_plans_of_steady_driving_are_those_of_before_and_such_as_hold() -> None:
    faster, hold, idle, slower = Action.FASTER, Action.HOLD, Action.IDLE, Action.SLOWER
    model = DrivingModel((0.0, 3.0, 6.0, 9.0), 1.6, 0.1, 0.5, 50.0)
    steady = plan_library(replace(model, steady=True))
    assert plan_library(model) == PLANS == tuple(plan for plan in steady if hold not in plan)
    assert (steady[0], steady[-1]) == (PLANS[0], PLANS[-1])
    assert {(hold, faster), (hold, idle), (hold, slower), (faster, hold), (slower, slower, hold)} <= set(steady)
    assert set(starts_with(steady)) == {faster, idle, hold, slower}


def test_who_is_behind_whom(junction: Junction) -> None:
    (following,) = junction.road_map.zones("south-north", "south-north")
    assert is_behind(following, 50.0, 60.0)
    assert not is_behind(following, 60.0, 50.0)
    (diverging,) = junction.road_map.zones("south-north", "south-west")
    assert is_behind(diverging, 50.0, 60.0)
    assert not is_behind(diverging, 50.0, diverging.exit_j + 1.0)
    (merging,) = junction.road_map.zones("south-north", "west-north")
    assert merging.merge_i is not None
    assert merging.merge_j is not None
    assert is_behind(merging, merging.merge_i + 5.0, merging.merge_j + 15.0)
    assert not is_behind(merging, merging.merge_i + 15.0, merging.merge_j + 5.0)
    assert is_behind(merging, 114.5, 123.0), "from the beginning of the zone on no vehicle can get past another one"
    assert is_behind(merging, 60.0, 110.0), "the other one is in the zone already"
    assert not is_behind(merging, 110.0, 60.0)
    assert not is_behind(merging, 109.0, 108.0), "it is still open who is first"
    assert not np.any([is_behind(z, 100.0, 105.0) for z in junction.road_map.zones("south-north", "west-east")])
