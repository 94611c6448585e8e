"""When the built-in decider changes lanes."""

from dataclasses import replace

import pytest
from worlds import Car, Junction, car

from codriving.datatypes.order import PassingOrder
from codriving.datatypes.situation import ActionAssessment, Decision, LaneChange, Situation
from codriving.datatypes.world import Action
from codriving.reasoning.decision.rules import decide_one

LEFT, RIGHT, FASTER, IDLE, SLOWER = (
    Action.LANE_LEFT,
    Action.LANE_RIGHT,
    Action.FASTER,
    Action.IDLE,
    Action.SLOWER,
)


def decide(world: Junction, me: Car, gains: dict[Action, float | None], forced: bool = False) -> Decision:
    """The decision of CAV1 if each of these actions is safe and gets it so far."""
    reasons = ("same lane: no", "no action is safe; this one is the least dangerous") if forced else ()
    made = tuple(ActionAssessment(action, True, reasons, (), gain) for action, gain in gains.items())
    return decide_one(Situation(world.thoughts(me).scenes["CAV1"], (), PassingOrder((), ()), (), made))


@pytest.mark.parametrize(("share", "action"), [(0.04, FASTER), (0.06, LEFT)])
def test_lanes_are_changed_to_get_clearly_farther(share: float, action: Action, highway: Junction) -> None:
    me = car("CAV1", "lane-1", 300.0, 20.0)
    for stays in (50.0, 250.0):
        decision = decide(highway, me, {SLOWER: stays / 2, FASTER: stays, LEFT: stays * (1 + share)})
        assert decision.action is action
    assert ("farther than staying" in decision.reason) is (action is LEFT)


def test_of_two_sides_the_one_that_gets_farther_is_taken(highway: Junction) -> None:
    me = car("CAV1", "lane-1", 300.0, 20.0)
    for left, right, action in ((150.0, 170.0, RIGHT), (170.0, 150.0, LEFT), (None, 150.0, RIGHT), (None, None, IDLE)):
        assert decide(highway, me, {IDLE: 100.0, LEFT: left, RIGHT: right}).action is action


def test_one_lane_change_after_the_other(highway: Junction) -> None:
    gains = {IDLE: 100.0, LEFT: 200.0}
    assert decide(highway, car("CAV1", "lane-1", 300.0, 20.0), gains).action is LEFT
    assert decide(highway, car("CAV1", "lane-1", 300.0, 20.0, offset=2.0), gains).action is IDLE


@pytest.mark.parametrize(("speed", "action"), [(2.9, IDLE), (3.1, LEFT)])
def test_no_vehicle_blocks_two_lanes_by_changing_slowly(speed: float, action: Action, highway: Junction) -> None:
    assert decide(highway, car("CAV1", "lane-1", 300.0, speed), {IDLE: 100.0, LEFT: 200.0}).action is action


@pytest.mark.parametrize(("gain", "action"), [(None, LEFT), (85.1, LEFT), (84.9, IDLE)])
def test_what_the_route_asks_for_is_done_unless_it_costs_much(
    gain: float | None, action: Action, merge: Junction
) -> None:
    decision = decide(merge, car("CAV1", "ramp", 240.0, 15.0), {IDLE: 100.0, LEFT: gain})
    assert decision.action is action
    assert ("the route asks for" in decision.reason) is (action is LEFT)


def test_who_has_to_change_to_one_side_never_changes_to_the_other(merge: Junction) -> None:
    assert decide(merge, car("CAV1", "ramp", 240.0, 15.0), {IDLE: 10.0, RIGHT: 200.0}).action is IDLE


def test_a_little_progress_is_given_up_to_be_closer(highway: Junction) -> None:
    me = car("CAV1", "lane-1", 300.0, 20.0)
    for best in (50.0, 250.0):
        within, beyond = best * 0.981, best * 0.979
        assert decide(highway, me, {SLOWER: best, IDLE: within, FASTER: beyond}).action is IDLE


@pytest.mark.parametrize(("speed", "action"), [(0.0, FASTER), (6.0, SLOWER)])
def test_who_stands_and_cannot_keep_the_order_does_not_stand_for_ever(
    speed: float, action: Action, junction: Junction
) -> None:
    me = car("CAV1", "south-north", 60.0, speed)
    decision = decide(junction, me, {SLOWER: None, IDLE: None, FASTER: None})
    assert decision.action is action
    assert "order cannot be kept" in decision.reason


def test_no_lane_change_when_nothing_is_safe(highway: Junction) -> None:
    decision = decide(highway, car("CAV1", "lane-1", 300.0, 20.0), {IDLE: 100.0}, forced=True)
    assert decision.action is IDLE
    assert "least dangerous" in decision.reason


@pytest.mark.parametrize(
    ("side", "gains", "action"),
    [
        (LEFT, {IDLE: 100.0, LEFT: 90.0, RIGHT: 200.0}, LEFT),
        (RIGHT, {IDLE: 100.0, LEFT: 200.0, RIGHT: 90.0}, RIGHT),
        (RIGHT, {IDLE: 100.0, LEFT: 200.0, RIGHT: 84.0}, IDLE),
        (LEFT, {IDLE: 100.0, RIGHT: 200.0}, IDLE),
    ],
)
def test_a_route_asks_for_the_side_on_which_its_lane_is(
    side: Action, gains: dict[Action, float | None], action: Action, highway: Junction
) -> None:
    scene = highway.thoughts(car("CAV1", "lane-1", 300.0, 20.0)).scenes["CAV1"]
    # The index of a lane of another segment says nothing of the side.
    scene = replace(scene, must_change=LaneChange(("later", "end", 1), 50.0, side))
    made = tuple(ActionAssessment(a, True, (), (), gain) for a, gain in gains.items())
    assert decide_one(Situation(scene, (), PassingOrder((), ()), (), made)).action is action
