"""All three layers together."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from worlds import Junction, car, order_of

from codriving.datatypes.action import Action
from codriving.datatypes.situation import ActionAssessment
from codriving.reasoning.safety.assessment import NoCheck, ThreeLayers, least_dangerous
from codriving.reasoning.safety.outlook import LONGITUDINAL, motions

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
    outlook = junction.outlook(*cars, ego="CAV0")
    names = set(outlook.others)
    assessments = ThreeLayers().assess(outlook)
    assert tuple(a.action for a in assessments) == outlook.actions
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
    # Nose to tail with somebody who stands: nothing is safe any more.
    outlook = junction.outlook(car("CAV1", "south-north", 60.0, 9.0), car("HDV1", "south-north", 68.0, 0.0))
    found = by_action(ThreeLayers().assess(outlook))
    assert [a for a in found if found[a].safe] == [Action.SLOWER] == [least_dangerous(outlook)]
    assert "least dangerous" in found[Action.SLOWER].reasons[-1]
    assert any(reason.startswith("same lane") for reason in found[Action.SLOWER].reasons)


def test_going_on_may_be_the_least_dangerous(junction: Junction) -> None:
    # It is leaving the crossing in front of somebody who does not brake; if it slows down, it is hit.
    outlook = junction.outlook(
        car("CAV1", "south-north", 110.0, 6.0), car("HDV1", "west-east", 104.0, 9.0), order=order_of("HDV1 CAV1")
    )
    assert least_dangerous(outlook) is Action.FASTER


def test_without_the_check_everything_stays(junction: Junction) -> None:
    outlook = junction.outlook(car("CAV1", "south-north", 60.0, 9.0), car("HDV1", "south-north", 67.0, 0.0))
    assessments = NoCheck().assess(outlook)
    assert all(a.safe and not a.reasons for a in assessments)
    assert [a.progress for a in assessments] == [a.progress for a in ThreeLayers().assess(outlook)]


def test_arrivals_are_the_earliest_at_each_conflict(junction: Junction) -> None:
    outlook = junction.outlook(
        car("CAV1", "south-north", 60.0, 6.0), car("CAV2", "west-east", 60.0, 6.0), car("CAV3", "east-west", 60.0, 6.0)
    )
    found = by_action(ThreeLayers().assess(outlook))
    assert all(len(a.arrivals) == len(outlook.conflicts) == 2 for a in found.values())
    for k, c in enumerate(outlook.conflicts):
        times = [found[a].arrivals[k] for a in (Action.FASTER, Action.IDLE, Action.SLOWER)]
        assert times == sorted(times)
        assert c.distances[0] / 9.0 < times[0] < math.inf


def test_progress_falls_with_the_eagerness_of_the_action(junction: Junction) -> None:
    found = by_action(ThreeLayers().assess(junction.outlook(car("CAV1", "south-north", 60.0, 6.0))))
    faster, idle, slower = (found[a].progress for a in (Action.FASTER, Action.IDLE, Action.SLOWER))
    assert faster is not None
    assert idle is not None
    assert slower is not None
    assert faster > idle > slower


@pytest.mark.parametrize("change", [Action.LANE_LEFT, Action.LANE_RIGHT])
def test_a_lane_change_keeps_the_speed(change: Action, junction: Junction) -> None:
    thoughts = junction.thoughts(car("CAV1", "south-north", 60.0, 6.0))
    stops, goes = motions(thoughts.scenes["CAV1"], (*LONGITUDINAL, change), thoughts.forecast)
    idle = LONGITUDINAL.index(Action.IDLE)
    assert (stops[-1] == stops[idle]).all()
    assert (goes[-1] == goes[idle]).all()
    assert (goes >= stops).all()
