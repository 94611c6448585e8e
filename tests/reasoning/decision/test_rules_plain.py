"""When the model need not be asked: no vehicle to consider, and nothing to weigh up."""

from dataclasses import replace

import pytest
from worlds import Car, Junction, car, order_of

from codriving.datatypes.situation import ActionAssessment, LaneChange, Situation
from codriving.datatypes.world import Action
from codriving.reasoning.decision.rules import decide_one, is_plain
from codriving.reasoning.safety.assessment import ThreeLayers

GOOD = tuple(
    ActionAssessment(action, True, (), (), gain)
    for action, gain in ((Action.SLOWER, 70.0), (Action.IDLE, 80.0), (Action.FASTER, 80.0))
)


def situation(world: Junction, *cars: Car) -> Situation:
    thoughts = world.thoughts(*cars)
    return Situation(thoughts.scenes["CAV1"], thoughts.conflicts["CAV1"], order_of(), (), GOOD)


ALONE = car("CAV1", "south-north", 75, 8)


def test_alone_on_the_road_everything_is_plain(junction: Junction) -> None:
    assert is_plain(situation(junction, ALONE), True)
    assert is_plain(situation(junction, ALONE), False)


def test_a_lane_change_that_is_not_safe_does_not_matter(junction: Junction) -> None:
    unsafe = ActionAssessment(Action.LANE_LEFT, False, ("adjacent lane: no",), (), None)
    assert is_plain(replace(situation(junction, ALONE), assessments=(*GOOD, unsafe)), True)


@pytest.mark.parametrize(
    ("other", "plain"),
    [
        (car("CAV2", "west-east", 20, 8), False),
        (car("HDV1", "west-east", 80, 8), False),
        (car("CAV2", "south-north", 90, 8), False),
        (car("CAV2", "south-north", 100, 8), True),
        (car("CAV2", "south-north", 100, 7.7), True),
        (car("CAV2", "south-north", 100, 6), False),
        (car("HDV1", "south-north", 60, 8), True),
    ],
    ids=["crossing", "human crossing", "near ahead", "far ahead", "caught up a little", "caught up", "behind"],
)
def test_a_vehicle_to_consider(junction: Junction, other: Car, plain: bool) -> None:
    assert is_plain(situation(junction, ALONE, other), True) is plain


def test_where_conflicts_cannot_be_seen_each_vehicle_ahead_counts(junction: Junction) -> None:
    ahead = replace(situation(junction, ALONE, car("CAV2", "west-east", 62, 8)), conflicts=())
    assert is_plain(ahead, True)
    assert not is_plain(ahead, False)
    behind = replace(
        situation(junction, car("CAV1", "south-north", 120, 8), car("CAV2", "west-east", 20, 8)), conflicts=()
    )
    assert is_plain(behind, False)


def assessed(action: Action, **change: object) -> tuple[ActionAssessment, ...]:
    return tuple(replace(a, **change) if a.action is action else a for a in GOOD)  # type: ignore[arg-type]


def test_best_action_must_be_plain(junction: Junction) -> None:
    good = situation(junction, ALONE)
    for changed in (
        replace(good, assessments=assessed(Action.SLOWER, safe=False, reasons=("same lane: no",))),
        replace(good, assessments=assessed(Action.FASTER, progress=60.0)),
        replace(good, assessments=assessed(Action.IDLE, progress=None)),
        replace(good, assessments=(*GOOD, ActionAssessment(Action.LANE_LEFT, True, (), (), 120.0))),
        replace(good, order=order_of("HDV1 CAV1")),
        replace(good, scene=replace(good.scene, must_change=LaneChange(("a", "b", 1), 50.0, Action.LANE_LEFT))),
        replace(good, scene=replace(good.scene, covers=(("south-west", 20.0),))),
    ):
        assert not is_plain(changed, True)
    stays = replace(good, assessments=(*GOOD, ActionAssessment(Action.LANE_LEFT, True, (), (), 81.0)))
    assert is_plain(stays, True)


@pytest.mark.parametrize(("gap", "speed", "plain"), [(75.0, 23.0, False), (75.0, 25.0, False), (75.0, 29.0, True)])
def test_faster_towards_a_slower_leader_is_not_plain(gap: float, speed: float, plain: bool, highway: Junction) -> None:
    # From 25 m/s FASTER leads to 30 m/s, so that a leader at 23 m/s comes 70 m nearer within 10 s.
    given = highway.safety_input(car("CAV1", "lane-1", 300.0, 25.0), car("HDV1", "lane-1", 305.0 + gap, speed))
    found = Situation(given.scene, given.conflicts, given.order, (), ThreeLayers().assess(given))
    assert decide_one(found).action is Action.FASTER
    assert is_plain(found, True) is plain
