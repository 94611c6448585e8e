"""Second layer: lane changes among the vehicles of the lanes beside, on the highway and at the merge."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from worlds import Car, Junction, car

from codriving.datatypes.road import Lane, LaneId, Road, Route, Straight, Turn
from codriving.datatypes.world import Action
from codriving.geometry.road_map import RoadMap
from codriving.reasoning.safety.adjacent_lane import check_adjacent
from codriving.reasoning.safety.assessment import ThreeLayers, progress
from codriving.reasoning.safety.safety_input import SafetyInput
from codriving.reasoning.safety.same_lane import check_ahead
from codriving.reasoning.sharing.sharing import SensedStates

LENGTH, WIDTH, LANE = 5.0, 2.0, 4.0
SIDES = {Action.LANE_LEFT: 0, Action.LANE_RIGHT: 2}
SPEED = st.floats(15.0, 30.0)


def among(highway: Junction, *others: Car, speed: float = 20.0) -> SafetyInput:
    """CAV1 on the second lane from the left at 300 m, and some others."""
    return highway.safety_input(car("CAV1", "lane-1", 300.0, speed), *others)


FIVE = set(Action) - {Action.HOLD}


def human(lane: int, place: float, speed: float = 20.0, pedal: float = 0.0) -> Car:
    return car("HDV1", f"lane-{lane}", place, speed, pedal=pedal)


def allowed(given: SafetyInput) -> set[Action]:
    return {a.action for a in ThreeLayers().assess(given) if a.safe}


def test_both_lanes_beside_are_offered_and_free(highway: Junction) -> None:
    given = among(highway)
    assert given.scene.adjacent_lanes == (("begin", "end", 0), ("begin", "end", 2))
    assert set(given.actions) == allowed(given) == FIVE
    assert check_adjacent(given) == {}


@pytest.mark.parametrize(("action", "lane"), SIDES.items())
def test_a_vehicle_beside_removes_the_change_to_its_side_and_nothing_else(
    action: Action, lane: int, highway: Junction
) -> None:
    given = among(highway, human(lane, 302.0))
    found = check_adjacent(given)
    assert set(found) == {action}
    assert all(reason.startswith("adjacent lane: ") and "HDV1" in reason for reason in found[action])
    assert allowed(given) == FIVE - {action}


@pytest.mark.parametrize("place", [240.0, 360.0])
def test_a_free_gap_stays_allowed(place: float, highway: Junction) -> None:
    assert check_adjacent(among(highway, human(0, place))) == {}


def test_a_lane_change_is_a_way_out_behind_a_vehicle_that_stands(highway: Junction) -> None:
    given = among(highway, human(1, 340.0, 0.0), speed=18.0)
    assert set(check_ahead(given)) >= {Action.IDLE, Action.FASTER}
    assert check_adjacent(given) == {}
    assert set(SIDES) <= allowed(given)
    # But not once the body would still be on the lane when it comes there.
    assert set(check_adjacent(among(highway, human(1, 318.0, 0.0), speed=18.0))) == set(SIDES)


def test_without_lane_changes_there_is_nothing_to_check(junction: Junction) -> None:
    given = junction.safety_input(car("CAV1", "south-north", 60.0, 6.0), car("HDV1", "south-west", 66.0, 6.0))
    assert check_adjacent(given) == {}


def test_a_lane_that_leads_elsewhere_is_not_changed_to(junction: Junction) -> None:
    ids: tuple[LaneId, ...] = (("a", "b", 0), ("a", "b", 1), ("b", "c", 0), ("b", "d", 0))
    lines = (((0, 0), (200, 0)), ((0, 4), (200, 4)), ((200, 0), (400, 0)), ((200, 4), (400, 4)))
    lanes = tuple(Lane(name, Straight(*line)) for name, line in zip(ids, lines, strict=True))
    on = Route("on", (ids[0], ids[2]), Turn.STRAIGHT, 200, 350)
    off = Route("off", (ids[1], ids[3]), Turn.STRAIGHT, 200, 350)
    fork = Junction(junction.environment)
    fork.road_map = RoadMap(Road("fork", lanes, (on, off)))
    given = fork.safety_input(car("CAV1", "on", 100.0, 6.0))
    assert check_adjacent(given) == {Action.LANE_RIGHT: ["adjacent lane: it does not lead where the CAV goes"]}
    assert progress(given, Action.LANE_RIGHT) is None


def test_a_vehicle_whose_lane_is_not_known_counts(highway: Junction) -> None:
    for place, removed in ((301.0, {Action.LANE_LEFT}), (240.0, set())):
        world = highway.world(car("CAV1", "lane-1", 300.0, 20.0), human(0, place))
        given = highway.think(world, SensedStates()).safety_input("CAV1")
        assert [n.lane for n in given.scene.neighbours] == [None]
        assert set(check_adjacent(given)) == removed


@settings(max_examples=40, deadline=None)
@given(
    st.sampled_from(["CAV2", "HDV1"]),
    st.integers(0, 3),
    st.sampled_from([-3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0]),
    st.floats(-50.0, 50.0),
    SPEED,
    SPEED,
)
def test_no_lane_change_that_touches_any_vehicle_within_two_seconds(
    highway: Junction, name: str, lane: int, offset: float, apart: float, mine: float, theirs: float
) -> None:
    assume(0 <= LANE * lane + offset <= 3 * LANE)
    given = among(highway, car(name, f"lane-{lane}", 300.0 + apart, theirs, offset=offset), speed=mine)
    times = np.linspace(0.0, 2.0, 21)
    touches = np.abs(apart + (theirs - mine) * times) < LENGTH

    def on(k: int) -> bool:
        """Whether the other one is on a lane, or will be."""
        return lane == k or abs(LANE * (lane - k) + offset) < (LANE + WIDTH) / 2

    removed = check_adjacent(given)
    for action, side in SIDES.items():
        # On the lane that it leaves, the CAV is responsible for the vehicle that is ahead, until its body is off it.
        left = on(1) and apart > LENGTH and bool(touches[times <= 1.6].any())
        if left or (on(side) and touches.any()):
            assert action in removed


@settings(max_examples=40, deadline=None)
@given(st.integers(-79, 79).map(lambda k: k / 10), SPEED, SPEED, st.booleans())
def test_two_cavs_alongside_never_change_onto_the_lane_between_them(
    highway: Junction, apart: float, one: float, other: float, swap: bool
) -> None:
    lanes = ("lane-2", "lane-0") if swap else ("lane-0", "lane-2")
    thoughts = highway.thoughts(car("CAV1", lanes[0], 300.0, one), car("CAV2", lanes[1], 300.0 + apart, other))
    inwards = (Action.LANE_LEFT, Action.LANE_RIGHT) if swap else (Action.LANE_RIGHT, Action.LANE_LEFT)
    goes = {
        name
        for name, action in zip(("CAV1", "CAV2"), inwards, strict=True)
        if _goes(thoughts.safety_input(name), action)
    }
    # The one ahead goes; if they are level, the one with the higher id.
    assert goes == {"CAV2" if apart >= 0 else "CAV1"}


def _goes(given: SafetyInput, action: Action) -> bool:
    return action not in check_adjacent(given)


@settings(max_examples=30, deadline=None)
@given(st.floats(-60.0, 60.0), SPEED)
def test_two_cavs_at_one_speed_never_change_into_the_same_gap(highway: Junction, apart: float, speed: float) -> None:
    thoughts = highway.thoughts(car("CAV1", "lane-0", 300.0, speed), car("CAV2", "lane-2", 300.0 + apart, speed))
    if _goes(thoughts.safety_input("CAV1"), Action.LANE_RIGHT) and _goes(
        thoughts.safety_input("CAV2"), Action.LANE_LEFT
    ):
        assert abs(apart) > LENGTH + 2.0


@settings(max_examples=60, deadline=None)
@given(st.floats(0.0, 80.0), SPEED, SPEED)
def test_a_faster_one_from_behind_does_not_change_into_the_same_gap(
    highway: Junction, apart: float, behind: float, ahead: float
) -> None:
    thoughts = highway.thoughts(car("CAV1", "lane-0", 300.0, behind), car("CAV2", "lane-2", 300.0 + apart, ahead))
    if _goes(thoughts.safety_input("CAV1"), Action.LANE_RIGHT) and _goes(
        thoughts.safety_input("CAV2"), Action.LANE_LEFT
    ):
        # The one behind sees the other one on its lane a second later, and then brakes by 4 m/s2 to its speed.
        closing = max(0.0, behind - ahead)
        assert apart - closing - closing**2 / 8 > LENGTH


def test_how_far_a_faster_vehicle_on_the_far_side_is_looked_for(highway: Junction) -> None:
    # At 28 and 20 m/s: 8 m, 8 m of reaction and 8 m of braking.
    for apart, goes in ((23.9, False), (24.1, True)):
        thoughts = highway.thoughts(car("CAV1", "lane-0", 300.0, 28.0), car("CAV2", "lane-2", 300.0 + apart, 20.0))
        assert _goes(thoughts.safety_input("CAV1"), Action.LANE_RIGHT) is goes
        assert _goes(thoughts.safety_input("CAV2"), Action.LANE_LEFT)
    # A slower one behind is looked for within 8 m.
    for apart, goes in ((7.9, False), (8.1, True)):
        thoughts = highway.thoughts(car("CAV1", "lane-0", 300.0, 20.0), car("CAV2", "lane-2", 300.0 + apart, 28.0))
        assert _goes(thoughts.safety_input("CAV1"), Action.LANE_RIGHT) is goes


def test_of_a_cav_on_the_far_side_the_speed_that_it_is_going_to_drive_counts_too(highway: Junction) -> None:
    # All drive 20 m/s now; the one behind is going to drive 25 m/s, or the one ahead 15 m/s: 8 m + 5 m + 3.125 m.
    for mine, theirs in ((25.0, 20.0), (20.0, 15.0)):
        for apart, goes in ((16.0, False), (16.2, True)):
            one = car("CAV1", "lane-0", 300.0, 20.0, target=mine)
            other = car("CAV2", "lane-2", 300.0 + apart, 20.0, target=theirs)
            assert _goes(highway.thoughts(one, other).safety_input("CAV1"), Action.LANE_RIGHT) is goes


def test_a_human_driver_on_the_far_side_might_change_there_as_well(highway: Junction) -> None:
    for place, removed in ((296.0, {Action.LANE_RIGHT}), (304.0, {Action.LANE_RIGHT}), (320.0, set())):
        assert set(check_adjacent(among(highway, human(3, place)))) == removed


def test_a_human_driver_whose_acceleration_is_not_known_is_taken_to_be_calm(merge: Junction) -> None:
    world = merge.world(car("CAV1", "ramp", 240.0, 15.0, offset=0.0), car("HDV1", "main-0", 240.0, 15.0))
    given = merge.think(world, SensedStates()).safety_input("CAV1")
    assert [n.acceleration for n in given.scene.neighbours] == [None]
    assert _goes(given, Action.LANE_LEFT)


def test_who_has_to_change_does_not_wait_for_human_drivers_whom_nothing_urges(merge: Junction) -> None:
    for pedal, goes in ((0.0, True), (-0.29, True), (-0.31, False)):
        given = merge.safety_input(
            car("CAV1", "ramp", 240.0, 15.0, offset=0.0), car("HDV1", "main-0", 240.0, 15.0, pedal=pedal)
        )
        assert given.scene.must_change is not None
        assert _goes(given, Action.LANE_LEFT) is goes
