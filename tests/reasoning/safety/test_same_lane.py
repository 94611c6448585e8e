"""First layer: no vehicle on the ego lane is run into, or made to brake abruptly."""

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import pytest
from worlds import Junction, car

from codriving.datatypes.situation import Role
from codriving.datatypes.world import Action
from codriving.environment.environment import Environment
from codriving.reasoning.safety.adjacent_lane import check_adjacent
from codriving.reasoning.safety.assessment import ThreeLayers
from codriving.reasoning.safety.safety_input import SafetyInput
from codriving.reasoning.safety.same_lane import check_ahead, check_behind, forced_braking
from codriving.reasoning.sharing.sharing import SensedStates, SharedStates


def follower(junction: Junction, gap: float, speed: float, leader: float, who: str = "HDV1") -> SafetyInput:
    """CAV1 follows a vehicle with a free distance."""
    return junction.safety_input(car("CAV1", "south-north", 60.0, speed), car(who, "south-north", 65.0 + gap, leader))


def followed(junction: Junction, gap: float, speed: float, behind: float, ahead: float | None = None) -> SafetyInput:
    """A vehicle follows CAV1; and if asked for, a vehicle stands ahead of it at a free distance."""
    cars = [car("CAV1", "south-north", 60.0, speed), car("HDV1", "south-north", 55.0 - gap, behind)]
    if ahead is not None:
        cars.append(car("HDV2", "south-north", 65.0 + ahead, 0.0))
    return junction.safety_input(*cars)


def test_a_slow_leader_near_removes_faster_and_names_itself(junction: Junction) -> None:
    found = [check_ahead(follower(junction, float(gap), 6.0, 5.0)) for gap in range(4, 20)]
    assert {Action.FASTER} in [set(removed) for removed in found], "at some distance, braking is not yet needed"
    for removed in found:
        for action, (reason,) in removed.items():
            assert reason.startswith(f"same lane: {action}")
            assert "HDV1" in reason


def test_a_leader_far_ahead_removes_nothing(junction: Junction) -> None:
    assert check_ahead(follower(junction, 40.0, 6.0, 6.0)) == {}
    assert check_ahead(follower(junction, 5.0, 0.0, 0.0)).keys() <= {Action.FASTER}


@pytest.mark.parametrize("leader", [0.0, 5.0, 9.0])
def test_the_nearer_the_leader_the_fewer_actions(leader: float, junction: Junction) -> None:
    removed = [set(check_ahead(follower(junction, gap, 6.0, leader))) for gap in (2.0, 5.0, 10.0, 20.0, 40.0)]
    assert removed[0]
    assert not removed[-1]
    for nearer, farther in pairwise(removed):
        assert farther <= nearer


def test_a_human_leader_needs_more_room_than_a_cav(junction: Junction) -> None:
    for gap in range(2, 30, 2):
        human = set(check_ahead(follower(junction, float(gap), 9.0, 9.0)))
        cav = set(check_ahead(follower(junction, float(gap), 9.0, 9.0, "CAV2")))
        assert cav <= human


@pytest.mark.parametrize("gap", [6.0, 9.0, 12.0, 15.0])
@pytest.mark.parametrize("leader", [0.0, 4.0, 8.0])
def test_what_is_left_can_stop_behind_the_hardest_braking(gap: float, leader: float, junction: Junction) -> None:
    given = follower(junction, gap, 6.0, leader)
    removed = check_ahead(given)
    least = given.forecast.reach(leader, False).least
    for action, stops in zip(given.actions, given.stops, strict=True):
        if action not in removed:
            assert (65.0 + gap + least - stops > 5.0).all()


def test_a_vehicle_that_has_merged_ahead_counts_although_it_came_from_elsewhere(junction: Junction) -> None:
    (zone,) = junction.road_map.zones("south-north", "west-north")
    assert zone.merge_i is not None
    assert zone.merge_j is not None
    given = junction.safety_input(
        car("CAV1", "south-north", zone.merge_i + 1.0, 9.0), car("CAV2", "west-north", zone.merge_j + 9.0, 0.0)
    )
    assert Action.FASTER in check_ahead(given)


def test_a_vehicle_that_is_not_known_to_drive_across_is_ahead(junction: Junction) -> None:
    world = junction.world(car("CAV1", "south-north", 97.0, 8.0), car("CAV2", "west-east", 113.0, 0.0))
    for sharing, leads in ((SharedStates(), False), (SensedStates(), True)):
        given = junction.think(world, sharing).safety_input("CAV1")
        assert (Action.FASTER in check_ahead(given)) is leads


def test_abrupt_braking_is_removed_while_a_faster_action_is_safe(junction: Junction) -> None:
    near = 0
    for gap in (1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 20.0):
        given = followed(junction, gap, 6.0, 9.0)
        assert given.scene.neighbours[0].role is Role.REARING
        abrupt = check_behind(given)
        slower = next(a for a in ThreeLayers().assess(given) if a.action is Action.SLOWER)
        # Where it comes too close whatever is done, nothing is gained by not braking.
        helps = Action.SLOWER in abrupt and set(abrupt) != set(given.actions)
        assert slower.safe is not helps
        assert helps or slower.reasons == ()
        near += helps
        if helps:
            assert slower.reasons == (abrupt[Action.SLOWER][0],)
            assert "same lane: SLOWER would force HDV1 behind to brake" in slower.reasons[0]
    assert near > 0


def test_braking_stays_allowed_when_nothing_faster_is_safe(junction: Junction) -> None:
    given = followed(junction, 4.0, 6.0, 9.0, ahead=6.0)
    allowed = {a.action for a in ThreeLayers().assess(given) if a.safe}
    assert Action.SLOWER in allowed


def test_a_follower_far_behind_or_slow_is_no_reason(junction: Junction) -> None:
    assert check_behind(followed(junction, 40.0, 8.0, 9.0)) == {}
    assert check_behind(followed(junction, 5.0, 9.0, 2.0)) == {}
    assert check_behind(junction.safety_input(car("CAV1", "south-north", 60.0, 8.0))) == {}


def test_forced_braking_falls_with_the_gap_and_with_the_own_speed(junction: Junction) -> None:
    given = followed(junction, 30.0, 3.0, 9.0)
    near = replace(given.scene.neighbours[0], gap=12.0)
    far = replace(given.scene.neighbours[0], gap=30.0)
    braking = {a: forced_braking(given, near, goes) for a, goes in zip(given.actions, given.goes, strict=True)}
    assert braking[Action.SLOWER] > braking[Action.IDLE] >= braking[Action.FASTER]
    assert forced_braking(given, far, given.goes[0]) < braking[Action.SLOWER]
    assert forced_braking(given, replace(near, speed=1.0), given.goes[1]) == 0


@pytest.mark.parametrize(("gap", "removed"), [(20.0, True), (60.0, False)])
def test_while_it_changes_lanes_a_cav_minds_who_is_ahead_on_the_lane_that_it_leaves(
    gap: float, removed: bool, highway: Junction
) -> None:
    ahead = car("HDV1", "lane-1", 300.0 + gap, 5.0)
    leaving = highway.safety_input(car("CAV1", "lane-0", 300.0, 20.0, offset=2.5), ahead)
    assert (Action.FASTER in check_ahead(leaving)) is removed
    # On the lane itself it could not stop behind it from either distance.
    assert Action.FASTER in check_ahead(highway.safety_input(car("CAV1", "lane-1", 300.0, 20.0), ahead))
    assert check_ahead(highway.safety_input(car("CAV1", "lane-0", 300.0, 20.0), ahead)) == {}


def test_what_is_left_can_stop_before_the_lane_ends(merge: Junction) -> None:
    removed = []
    for place in range(230, 310, 5):
        given = merge.safety_input(car("CAV1", "ramp", float(place), 12.0))
        change = given.scene.must_change
        assert change is not None
        found = check_ahead(given)
        for action, stops in zip(given.actions, given.stops, strict=True):
            reaches = stops[-1] - given.scene.place > change.room - 2.0
            assert (action in found) is bool(reaches)
        removed.append(set(found) - {Action.LANE_LEFT})
    assert removed[0] == set()
    assert {Action.FASTER} in removed
    assert removed[-1] == {Action.FASTER, Action.IDLE, Action.SLOWER}
    for farther, nearer in pairwise(removed):
        assert farther <= nearer
    assert check_ahead(merge.safety_input(car("CAV1", "main-1", 290.0, 12.0))) == {}, "its lane goes on"


@pytest.mark.parametrize(
    ("limits", "room", "safe"), [("road", 60.0, True), ("road", 15.0, False), ("none", 15.0, True)]
)
def test_who_leaves_a_lane_that_ends_could_stop_before_it(
    limits: str, room: float, safe: bool, configured: Callable[..., Environment]
) -> None:
    merge = Junction(configured("scenario=merge", f"limits={limits}"))
    # The ramp lane ends at 330 m; the CAV is on the main lane, its body still half on the ramp's.
    given = merge.safety_input(car("CAV1", "main-1", 330.0 - room, 15.0, offset=1.8))
    assert [route for route, _ in given.vehicles["CAV1"].routes] == ["main-1", "ramp"]
    assert (Action.IDLE not in check_ahead(given)) is safe


def test_a_lane_change_is_begun_only_where_the_cav_could_still_stop_beside(
    configured: Callable[..., Environment],
) -> None:
    merge = Junction(configured("scenario=merge", "limits=road"))
    for place, safe in ((240.0, True), (312.0, False)):
        given = merge.safety_input(car("CAV1", "ramp", place, 12.0))
        assert (Action.LANE_LEFT in given.actions, Action.LANE_LEFT not in check_adjacent(given)) == (True, safe)
