"""A CAV as if it had changed lanes already."""

from dataclasses import replace

import pytest
from worlds import Junction, car, order_of

from codriving.datatypes.order import PassingOrder
from codriving.datatypes.situation import Role
from codriving.datatypes.world import Action
from codriving.reasoning.safety.safety_input import SafetyInput

LEFT, RIGHT = Action.LANE_LEFT, Action.LANE_RIGHT


def merging(merge: Junction, place: float, other: float, order: PassingOrder | None = None) -> SafetyInput:
    """CAV1 on the left main lane, CAV2 on the ramp; they meet only if CAV1 changes lanes."""
    return merge.safety_input(car("CAV1", "main-0", place, 15.0), car("CAV2", "ramp", other, 15.0), order=order)


def test_the_lane_beside_and_who_is_on_it(highway: Junction) -> None:
    given = highway.safety_input(
        car("CAV1", "lane-1", 300.0, 20.0),
        car("HDV1", "lane-0", 330.0, 20.0),
        car("HDV2", "lane-1", 340.0, 20.0),
        car("HDV3", "lane-2", 280.0, 20.0),
    )
    seen = {}
    for action in (LEFT, RIGHT):
        there = given.beside(action)
        assert there is not None
        start, end, index = given.scene.intent.target_lane
        assert there.scene.intent.target_lane == (start, end, index + (1 if action is RIGHT else -1))
        seen[there.scene.intent.route] = {n.id: n.role for n in there.scene.neighbours if n.role is not Role.OTHER}
    assert seen == {"lane-0": {"HDV1": Role.LEADING}, "lane-2": {"HDV3": Role.REARING}}


def test_the_body_is_still_on_the_lane_that_it_leaves(highway: Junction) -> None:
    given = highway.safety_input(car("CAV1", "lane-1", 300.0, 20.0), car("HDV1", "lane-0", 330.0, 20.0))
    there = given.beside(LEFT)
    assert there is not None
    assert there.vehicles["CAV1"].routes == (("lane-0", pytest.approx(300.0)), ("lane-1", 300.0))
    assert there.scene.covers == (("lane-1", 300.0),)
    assert given.vehicles["CAV1"].routes == (("lane-1", 300.0),), "the view itself stays as it is"


def test_it_goes_on_at_the_same_speed_from_the_same_place(merge: Junction) -> None:
    # The ramp comes to the main road on a bend, so that its arc lengths are other ones.
    given = merge.safety_input(car("CAV1", "ramp", 260.0, 15.0))
    there = given.beside(LEFT)
    assert there is not None
    x = given.scene.ego.x
    assert there.scene.place == there.goes[0, 0] == there.stops[0, 0] == pytest.approx(x, abs=1e-6)
    assert there.scene.place < given.scene.place - 0.1
    assert there.actions == (Action.IDLE,)
    k = given.actions.index(LEFT)
    assert there.goes[0] - there.scene.place == pytest.approx(given.goes[k] - given.scene.place)
    assert there.scene.must_change is None


def test_who_comes_from_the_ramp_is_met_only_on_the_lane_beside(merge: Junction) -> None:
    given = merging(merge, 220.0, 235.0)
    assert given.conflicts == ()
    there = given.beside(RIGHT)
    assert there is not None
    assert {c.other for c in there.conflicts} == {"CAV2"}
    (n,) = there.scene.neighbours
    assert n.role is Role.CONFLICT


@pytest.mark.parametrize(("place", "other", "first"), [(215.0, 240.0, "CAV2"), (240.0, 215.0, "CAV1")])
def test_the_nearer_one_goes_first_where_nothing_was_agreed(
    place: float, other: float, first: str, merge: Junction
) -> None:
    given = merging(merge, place, other)
    assert given.order.first_of("CAV1", "CAV2") is None
    there = given.beside(RIGHT)
    assert there is not None
    assert there.order.first_of("CAV1", "CAV2") == first


@pytest.mark.parametrize("first", ["CAV1", "CAV2"])
def test_what_was_agreed_stays(first: str, merge: Junction) -> None:
    second = "CAV2" if first == "CAV1" else "CAV1"
    there = merging(merge, 215.0, 240.0, order_of(f"{first} {second}")).beside(RIGHT)
    assert there is not None
    assert [(p.first, p.second) for p in there.order.precedences] == [(first, second)]


def test_it_is_worked_out_once(highway: Junction) -> None:
    given = highway.safety_input(car("CAV1", "lane-1", 300.0, 20.0))
    assert given.beside(LEFT) is given.beside(LEFT)
    assert given.beside(LEFT) is not given.beside(RIGHT)


def test_who_detects_no_conflicts_detects_none_there_either(merge: Junction) -> None:
    given = merging(merge, 220.0, 235.0)
    there = replace(given, moment=replace(given.moment, sees_conflicts=False)).beside(RIGHT)
    assert there is not None
    assert there.conflicts == ()
