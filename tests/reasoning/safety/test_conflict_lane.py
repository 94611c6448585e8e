"""Third layer: no action intensifies a conflict."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from worlds import Junction, car, order_of, standing

from codriving.datatypes.order import Relation
from codriving.datatypes.world import Action
from codriving.geometry.box import TRUE
from codriving.geometry.clearance import first_overlap
from codriving.reasoning.safety.adjacent_lane import check_adjacent
from codriving.reasoning.safety.conflict_lane import changes_before, check_conflicts
from codriving.reasoning.safety.safety_input import SafetyInput

ALL = {Action.SLOWER, Action.IDLE, Action.FASTER}


def crossing(
    junction: Junction,
    mine: float,
    theirs: float,
    speed: float = 6.0,
    *order: str,
    who: str = "CAV2",
    binding: bool = False,
) -> SafetyInput:
    """CAV1 from the south and a vehicle from the west who are at the crossing at 104 and 108 m."""
    told = order_of(*(order or (f"{who} CAV1",)), binding=binding)
    return junction.safety_input(
        car("CAV1", "south-north", mine, speed), car(who, "west-east", theirs, speed), order=told
    )


def removed(given: SafetyInput) -> set[Action]:
    return set(check_conflicts(given))


def test_the_second_must_be_able_to_stop_before_the_zone(junction: Junction) -> None:
    assert removed(crossing(junction, 60.0, 62.0)) == set()
    assert Action.FASTER in removed(crossing(junction, 94.0, 97.0))
    assert Action.SLOWER not in removed(crossing(junction, 94.0, 97.0))


def test_the_nearer_the_zone_the_more_is_removed(junction: Junction) -> None:
    found = [removed(crossing(junction, s, s + 4.0)) for s in (80.0, 88.0, 92.0, 96.0)]
    for farther, nearer in pairwise(found):
        assert farther <= nearer
    assert not found[0]
    assert found[-1]


def test_reasons_name_layer_action_and_vehicle(junction: Junction) -> None:
    (reason,) = check_conflicts(crossing(junction, 94.0, 97.0))[Action.FASTER]
    assert reason.startswith("conflict lane: FASTER intensifies the crossing conflict with CAV2")
    assert "danger" in reason


def test_the_first_is_free_over_a_cav_that_agrees(junction: Junction) -> None:
    assert removed(crossing(junction, 94.0, 90.0, 6.0, "CAV1 CAV2")) == set()
    assert removed(crossing(junction, 94.0, 90.0, 6.0, "CAV2 CAV1"))


def test_a_human_driver_does_not_agree(junction: Junction) -> None:
    # The human driver from the west has the right of way and is as near.
    assert Action.FASTER in removed(crossing(junction, 94.0, 97.0, 6.0, "CAV1 HDV1", who="HDV1"))


def test_a_human_driver_who_stands_for_long_is_relied_on(junction: Junction) -> None:
    given = junction.safety_input(
        car("CAV1", "south-north", 94.0, 6.0), car("HDV1", "west-east", 95.0, 0.0), order=order_of("CAV1 HDV1")
    )
    assert removed(standing(given, "HDV1", 60.0)) == set()


def test_advice_may_be_overtaken_by_events_but_an_instruction_not(junction: Junction) -> None:
    advised = crossing(junction, 98.0, 40.0, 6.0, "CAV2 CAV1")
    bound = crossing(junction, 98.0, 40.0, 6.0, "CAV2 CAV1", binding=True)
    assert Action.FASTER not in removed(advised)
    assert Action.FASTER in removed(bound)


def test_no_cav_is_bound_to_human_drivers(junction: Junction) -> None:
    far = 66.0
    advised = crossing(junction, 101.0, far, 6.0, "HDV1 CAV1", who="HDV1")
    bound = crossing(junction, 101.0, far, 6.0, "HDV1 CAV1", who="HDV1", binding=True)
    assert Action.FASTER not in removed(advised)
    assert removed(advised) == removed(bound)


def test_without_conflicts_nothing_is_removed(junction: Junction) -> None:
    assert removed(junction.safety_input(car("CAV1", "south-north", 98.0, 9.0))) == set()
    oncoming = car("CAV2", "north-south", 98.0, 9.0)
    assert removed(junction.safety_input(car("CAV1", "south-north", 98.0, 9.0), oncoming)) == set()


@settings(max_examples=60, deadline=None)
@given(
    st.sampled_from(["west-east", "east-west", "north-east", "east-south"]),
    st.floats(70.0, 103.0),
    st.floats(65.0, 112.0),
    st.floats(0.0, 9.0),
    st.floats(0.0, 9.0),
    st.sampled_from(["least", "steady", "most"]),
)
def test_what_is_left_keeps_clear_of_a_human_driver_whatever_it_does(
    junction: Junction, route: str, s: float, t: float, v: float, w: float, does: str
) -> None:
    given = junction.safety_input(
        car("CAV1", "south-north", s, v), car("HDV1", route, t, w), order=order_of("HDV1 CAV1")
    )
    found = check_conflicts(given)
    for c in given.conflicts:
        other = c.places[1] + getattr(given.forecast.reach(w, False), does)
        if does == "most" and c.ttcp[0] < c.ttcp[1]:
            continue  # a CAV that is in the zone first is braked for
        for k, action in enumerate(given.actions):
            if action in found:
                continue
            clear = [
                all(
                    first_overlap(z, motion, other)[0] == motion.shape[1]
                    for z in junction.road_map.zones(*c.routes, TRUE)
                )
                for motion in (given.stops[k : k + 1], given.goes[k : k + 1])
            ]
            assert any(clear), f"after {action} it can neither stop nor go"


@pytest.mark.parametrize("speed", [3.0, 6.0, 9.0])
def test_a_human_driver_too_far_to_come_in_time_is_passed(speed: float, junction: Junction) -> None:
    given = junction.safety_input(
        car("CAV1", "south-north", 103.0, 6.0), car("HDV1", "west-east", 62.0, speed), order=order_of("HDV1 CAV1")
    )
    assert np.array_equal(given.actions, sorted(ALL, key=given.actions.index))
    assert Action.FASTER not in removed(given)


def in_the_way(given: SafetyInput) -> set[str]:
    """Reasons that speak of stopping in another vehicle's way."""
    return {r for reasons in check_conflicts(given).values() for r in reasons if "stop in the way of" in r}


def test_a_cav_does_not_enter_the_way_of_a_human_driver_in_which_it_might_have_to_stop(junction: Junction) -> None:
    given = junction.safety_input(car("CAV1", "south-north", 101.0, 9.0), car("HDV1", "west-east", 107.0, 0.0))
    assert in_the_way(given) == {"conflict lane: after SLOWER the CAV might have to stop in the way of HDV1"}
    among_cavs = junction.safety_input(car("CAV1", "south-north", 101.0, 9.0), car("CAV2", "west-east", 107.0, 0.0))
    assert not in_the_way(among_cavs)


def test_where_ways_merge_no_vehicle_is_caught_in_between(junction: Junction) -> None:
    given = junction.safety_input(
        car("CAV1", "south-north", 103.0, 6.0),
        car("HDV1", "west-north", 108.0, 8.0),
        car("HDV2", "north-south", 117.0, 3.0),
    )
    assert {c.relation for c in given.conflicts if c.other == "HDV1"} == {Relation.CONVERGING}
    assert not in_the_way(given)


@pytest.mark.parametrize(
    ("mine", "other", "leaves_it"),
    [
        (("ramp", 240.0), ("CAV2", "main-1", 230.0), True),
        (("main-1", 230.0), ("CAV2", "ramp", 240.0), True),
        (("ramp", 240.0), ("HDV1", "main-1", 230.0), True),
        (("main-1", 230.0), ("HDV1", "ramp", 240.0), False),
    ],
)
def test_a_zone_that_is_reached_by_a_lane_change_is_left_to_the_second_layer(
    mine: tuple[str, float], other: tuple[str, str, float], leaves_it: bool, merge: Junction
) -> None:
    given = merge.safety_input(car("CAV1", *mine, 15.0), car(*other, 15.0))
    assert given.conflicts
    assert {changes_before(given, c) for c in given.conflicts if c.routes[1] in ("ramp", "main-1")} == {leaves_it}
    if leaves_it:
        assert removed(given) == set()
    if mine[0] == "ramp":
        assert Action.LANE_LEFT in check_adjacent(given)


def test_who_has_begun_to_change_lanes_is_no_longer_left_to_it(merge: Junction) -> None:
    ramp = car("HDV1", "ramp", 200.0, 10.0)
    for mine, leaves_it in (
        (car("CAV1", "ramp", 260.0, 10.0), True),
        (car("CAV1", "main-1", 260.0, 10.0, offset=3.0), False),
    ):
        given = merge.safety_input(mine, car("CAV2", "main-1", 200.0, 10.0), ramp)
        assert any(changes_before(given, c) for c in given.conflicts) is leaves_it
