"""All three layers together."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from worlds import Junction, car, order_of

from codriving.datatypes.situation import ActionAssessment
from codriving.datatypes.world import Action
from codriving.reasoning.safety.assessment import NoCheck, ThreeLayers, least_dangerous, progress
from codriving.reasoning.safety.safety_input import LONGITUDINAL

ROUTES = ("south-north", "south-west", "west-east", "west-north", "east-west", "north-east")
ANYWHERE = st.tuples(st.sampled_from(ROUTES), st.floats(40.0, 125.0), st.floats(0.0, 9.0))


def by_action(assessments: tuple[ActionAssessment, ...]) -> dict[Action, ActionAssessment]:
    return {a.action: a for a in assessments}


@settings(max_examples=50, deadline=None)
@given(st.lists(ANYWHERE, min_size=1, max_size=4), st.lists(ANYWHERE, max_size=3))
def test_something_always_stays_and_every_removal_has_reasons(
    junction: Junction, cavs: list[tuple[str, float, float]], humans: list[tuple[str, float, float]]
) -> None:
    cars = [car(f"CAV{k}", *c) for k, c in enumerate(cavs)] + [car(f"HDV{k}", *c) for k, c in enumerate(humans)]
    given = junction.safety_input(*cars, ego="CAV0")
    names = set(given.vehicles)
    assessments = ThreeLayers().assess(given)
    assert tuple(a.action for a in assessments) == given.actions
    assert any(a.safe for a in assessments)
    for a in assessments:
        assert a.safe or a.reasons
        for reason in a.reasons:
            if "least dangerous" in reason:
                assert a.safe
                assert sum(other.safe for other in assessments) == 1
                continue
            assert reason.startswith(("same lane: ", "adjacent lane: ", "conflict lane: "))
            assert any(name in reason for name in names)


def test_if_nothing_is_safe_the_least_dangerous_is_kept_and_says_so(junction: Junction) -> None:
    # Nose to tail with a vehicle that stands: nothing is safe any more.
    given = junction.safety_input(car("CAV1", "south-north", 60.0, 9.0), car("HDV1", "south-north", 68.0, 0.0))
    found = by_action(ThreeLayers().assess(given))
    assert [a for a in found if found[a].safe] == [Action.SLOWER] == [least_dangerous(given)]
    assert "least dangerous" in found[Action.SLOWER].reasons[-1]
    assert any(reason.startswith("same lane") for reason in found[Action.SLOWER].reasons)


def test_going_on_may_be_the_least_dangerous(junction: Junction) -> None:
    # It is leaving the crossing in front of a vehicle that does not brake; if it slows down, it is hit.
    given = junction.safety_input(
        car("CAV1", "south-north", 110.0, 6.0), car("HDV1", "west-east", 104.0, 9.0), order=order_of("HDV1 CAV1")
    )
    assert least_dangerous(given) is Action.FASTER


@pytest.mark.parametrize("reverse", [False, True])
@pytest.mark.parametrize(
    ("offered", "least"),
    [
        ("SLOWER IDLE FASTER", "SLOWER"),
        ("IDLE SLOWER FASTER", "SLOWER"),
        ("FASTER IDLE", "IDLE"),
        ("FASTER SLOWER", "SLOWER"),
    ],
)
def test_of_actions_that_are_as_bad_it_is_the_slowest(
    offered: str, least: str, reverse: bool, junction: Junction
) -> None:
    # The two overlap already, whatever CAV1 does.
    thoughts = junction.thoughts(car("CAV1", "south-north", 60.0, 6.0), car("HDV1", "south-north", 62.0, 0.0))
    actions = tuple(Action(name) for name in offered.split())
    assert least_dangerous(thoughts.safety_input("CAV1", actions=actions[::-1] if reverse else actions)) == least


def test_without_the_check_everything_stays(junction: Junction) -> None:
    given = junction.safety_input(car("CAV1", "south-north", 60.0, 9.0), car("HDV1", "south-north", 67.0, 0.0))
    assessments = NoCheck().assess(given)
    assert all(a.safe and not a.reasons for a in assessments)
    assert [a.progress for a in assessments] == [a.progress for a in ThreeLayers().assess(given)]


def test_arrivals_are_the_earliest_at_each_conflict(junction: Junction) -> None:
    given = junction.safety_input(
        car("CAV1", "south-north", 60.0, 6.0), car("CAV2", "west-east", 60.0, 6.0), car("CAV3", "east-west", 60.0, 6.0)
    )
    found = by_action(ThreeLayers().assess(given))
    assert all(len(a.arrivals) == len(given.conflicts) == 2 for a in found.values())
    for k, c in enumerate(given.conflicts):
        times = [found[a].arrivals[k] for a in (Action.FASTER, Action.IDLE, Action.SLOWER)]
        assert times == sorted(times)
        assert c.distances[0] / 9.0 < times[0] < math.inf


def test_progress_falls_with_the_eagerness_of_the_action(junction: Junction) -> None:
    found = by_action(ThreeLayers().assess(junction.safety_input(car("CAV1", "south-north", 60.0, 6.0))))
    faster, idle, slower = (found[a].progress for a in (Action.FASTER, Action.IDLE, Action.SLOWER))
    assert faster is not None
    assert idle is not None
    assert slower is not None
    assert faster > idle > slower


@pytest.mark.parametrize("change", [Action.LANE_LEFT, Action.LANE_RIGHT])
def test_a_lane_change_keeps_the_speed(change: Action, junction: Junction) -> None:
    thoughts = junction.thoughts(car("CAV1", "south-north", 60.0, 6.0))
    given = thoughts.safety_input("CAV1", actions=(Action.FASTER, Action.IDLE, Action.SLOWER, change))
    stops, goes = given.stops, given.goes
    assert (stops[-1] == stops[1]).all()
    assert (goes[-1] == goes[1]).all()
    assert (goes >= stops).all()


@pytest.mark.parametrize(
    ("mine", "human", "least"),
    [
        # It goes on in front of a vehicle that may accelerate, and of a vehicle that may not brake.
        ((109.0, 6.0), ("west-east", 100.0, 4.0), Action.FASTER),
        ((110.0, 3.0), ("east-west", 98.0, 4.0), Action.FASTER),
        # It does not brake in front of a vehicle that may brake as well.
        ((107.0, 9.0), ("east-west", 101.0, 6.0), Action.IDLE),
    ],
)
def test_three_guesses_of_what_others_do_decide_what_is_least_dangerous(
    mine: tuple[float, float], human: tuple[str, float, float], least: Action, junction: Junction
) -> None:
    given = junction.safety_input(car("CAV1", "south-north", *mine), car("HDV1", *human))
    assert least_dangerous(given) is least


def test_a_lane_change_gets_farther_than_staying_behind_a_slow_vehicle(highway: Junction) -> None:
    given = highway.safety_input(
        car("CAV1", "lane-1", 300.0, 20.0), car("HDV1", "lane-1", 335.0, 15.0), car("HDV2", "lane-2", 335.0, 15.0)
    )
    found = by_action(ThreeLayers().assess(given))
    left, right, stays = (
        found[Action.LANE_LEFT].progress,
        found[Action.LANE_RIGHT].progress,
        found[Action.IDLE].progress,
    )
    assert left is not None
    assert right is not None
    assert stays is not None
    assert left > 1.2 * stays
    assert right == pytest.approx(stays, rel=0.01)
    assert found[Action.LANE_LEFT].safe


def test_behind_a_vehicle_on_the_lane_that_it_leaves_a_change_gets_less_far_the_nearer_that_one_is(
    highway: Junction,
) -> None:
    def gains(place: float) -> float | None:
        given = highway.safety_input(car("CAV1", "lane-1", 300.0, 25.0, 30.0), car("HDV1", "lane-1", place, 15.0))
        return progress(given, Action.LANE_LEFT)

    near, far = gains(318.0), gains(380.0)
    assert far is not None
    assert near is None or near < far


@settings(max_examples=20, deadline=None)
@given(st.floats(0.0, 25.0), st.floats(0.0, 25.0), st.floats(5.0, 30.0), st.floats(0.0, 30.0))
def test_a_lane_change_is_never_forced(highway: Junction, ahead: float, behind: float, v: float, w: float) -> None:
    given = highway.safety_input(
        car("CAV1", "lane-1", 300.0, v),
        car("HDV1", "lane-1", 305.0 + ahead, w),
        car("HDV2", "lane-0", 295.0 - behind, w),
        car("HDV3", "lane-2", 300.0, v),
    )
    found = ThreeLayers().assess(given)
    forced = [a.action for a in found if a.safe and a.reasons]
    assert any(a.safe for a in found)
    assert set(forced) <= set(LONGITUDINAL)


def test_lane_changes_are_judged_by_the_second_layer_alone(highway: Junction) -> None:
    given = highway.safety_input(
        car("CAV1", "lane-1", 300.0, 18.0), car("HDV1", "lane-1", 340.0, 0.0), car("HDV2", "lane-2", 301.0, 18.0)
    )
    found = by_action(ThreeLayers().assess(given))
    assert not found[Action.IDLE].safe
    assert found[Action.LANE_LEFT].reasons == ()
    assert found[Action.LANE_RIGHT].reasons
    assert all(reason.startswith("adjacent lane: ") for reason in found[Action.LANE_RIGHT].reasons)
