"""In which order each vehicle is planned."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest
from driven import moment_of, ordering_of, planned
from hypothesis import given
from hypothesis import strategies as st
from worlds import Car, Junction, car

from codriving.datatypes.situation import TrackedVehicle
from codriving.datatypes.world import Action, Kind
from codriving.reasoning.execution.joint_planner import EarlyPassing, Joint, JointPlans, drives_ahead
from codriving.reasoning.prediction.expectation import planning_order

NAMES = [f"CAV{k}" for k in range(1, 8)]


def tracked(name: str, place: float) -> TrackedVehicle:
    return TrackedVehicle(name, Kind.CAV, 0.0, 0.0, 5.0, None, None, None, 5.0, (("east", place),))


def everybody(places: list[float]) -> dict[str, TrackedVehicle]:
    return {name: tracked(name, place) for name, place in zip(NAMES, places, strict=False)}


vehicles = st.lists(st.floats(0.0, 100.0), min_size=1, max_size=7).map(everybody)
links = st.sets(st.tuples(st.sampled_from(NAMES), st.sampled_from(NAMES)).filter(lambda p: p[0] != p[1]))


@st.composite
def orders(draw: st.DrawFn) -> tuple[dict[str, TrackedVehicle], list[str]]:
    """Some vehicles, and the passing order of some of them."""
    some = draw(vehicles)
    return some, draw(st.lists(st.sampled_from(sorted(some)), unique=True))


@given(orders())
def test_where_no_vehicle_drives_ahead_the_passing_order_is_kept(
    drawn: tuple[dict[str, TrackedVehicle], list[str]],
) -> None:
    some, sequence = drawn
    order = planning_order(sequence, some, set())
    assert order[: len(sequence)] == sequence
    rest = order[len(sequence) :]
    assert [some[n].routes[0][1] for n in rest] == sorted((some[n].routes[0][1] for n in rest), reverse=True)
    assert sorted(order) == sorted(some)


@given(orders(), st.permutations(NAMES), links)
def test_a_vehicle_that_drives_ahead_is_planned_before_those_behind(
    drawn: tuple[dict[str, TrackedVehicle], list[str]], lane: list[str], some_links: set[tuple[str, str]]
) -> None:
    some, sequence = drawn
    rank = {name: k for k, name in enumerate(lane)}
    ahead = {(a, b) for a, b in some_links if rank[a] < rank[b] and {a, b} <= some.keys()}
    order = planning_order(sequence, some, ahead)
    assert sorted(order) == sorted(some)
    assert all(order.index(a) < order.index(b) for a, b in ahead)
    # No vehicle is drawn forward for nothing: what goes before an earlier one is waited for by one behind.
    free = [n for n in sequence if all(n not in pair for pair in ahead)]
    assert [n for n in order if n in free] == free


@given(orders(), links)
def test_every_vehicle_is_planned_once_even_if_they_follow_one_another_in_a_circle(
    drawn: tuple[dict[str, TrackedVehicle], list[str]], some_links: set[tuple[str, str]]
) -> None:
    some, sequence = drawn
    ahead = {pair for pair in some_links if set(pair) <= some.keys()}
    order = planning_order(sequence, some, ahead)
    assert sorted(order) == sorted(some)
    same: set[tuple[str, str]] = set()
    for pair in sorted(ahead, reverse=True):
        same.add(pair)
    assert order == planning_order(sequence, some, same), "however the pairs came together"


def test_the_order_of_those_who_have_gone_is_of_no_interest() -> None:
    some = everybody([10.0, 20.0])
    assert planning_order(["CAV7", "CAV1", "CAV9", "CAV2"], some, set()) == ["CAV1", "CAV2"]


def ahead_of(junction: Junction, *routes: tuple[str, float]) -> set[tuple[str, str]]:
    thoughts = junction.thoughts(*[car(f"CAV{k}", route, place, 5.0) for k, (route, place) in enumerate(routes, 1)])
    moment = moment_of(thoughts)
    return drives_ahead(moment, {name: known[name] for name, known in sorted(moment.vehicles.items())})


def test_who_drives_ahead(junction: Junction) -> None:
    assert ahead_of(junction, ("south-north", 60.0), ("south-north", 70.0)) == {("CAV2", "CAV1")}
    assert ahead_of(junction, ("south-north", 60.0), ("south-west", 50.0)) == {("CAV1", "CAV2")}, "of one lane"
    assert ahead_of(junction, ("south-north", 60.0), ("west-east", 70.0)) == set()
    assert ahead_of(junction, ("south-north", 60.0), ("west-north", 70.0)) == set(), "not yet on the same lane"
    past = junction.road_map.routes["south-north"].goal - 10.0
    assert ahead_of(junction, ("south-north", past - 8.0), ("west-north", past)) in (
        {("CAV2", "CAV1")},
        {("CAV1", "CAV2")},
    ), "behind the junction they are"


# The first of the order is far away, the second near: it is out of the way in time.
FAR, NEAR = car("CAV1", "south-north", 30.0, 8.0), car("CAV2", "west-east", 85.0, 8.0)
ORDER = ("CAV1", "CAV2")


def plans(junction: Junction, *cars: Car, by_zone: bool, kept: tuple[EarlyPassing, ...] = ()) -> JointPlans:
    """Plans of a moment in which CAV2 has planned to keep its speed."""
    moment = replace(moment_of(junction.thoughts(*cars)), by_zone=by_zone)
    return JointPlans(moment, {"CAV2": (Action.IDLE,)}, 0.6, 1.0, 0.8, None, kept)


def first_actions(made: JointPlans, joint: Joint) -> list[Action]:
    return [made.plan_of(name, joint.chosen[name])[0] for name in ORDER]


def test_by_zone_a_cav_passes_before_one_that_precedes_it_if_it_is_out_of_its_way_in_time(junction: Junction) -> None:
    one_order, by_zone = (plans(junction, FAR, NEAR, by_zone=by_zone) for by_zone in (False, True))
    assert first_actions(one_order, one_order.joint(ORDER)) == [Action.FASTER, Action.SLOWER]
    assert one_order.passages(one_order.joint(ORDER)) == []
    joint = by_zone.joint(ORDER)
    assert [by_zone.plan_of(name, joint.chosen[name]) for name in ORDER] == [(Action.FASTER,) * 2] * 2
    assert joint.stuck == ()
    (passage,) = by_zone.passages(joint)
    assert (passage.first, passage.second) == ("CAV2", "CAV1")
    assert passage.entries == pytest.approx((108.4, 104.4), abs=0.1)


def test_who_passes_first_has_a_metre_of_room_when_the_other_one_is_in_the_zone(junction: Junction) -> None:
    (meeting,) = plans(junction, FAR, NEAR, by_zone=True).open_meetings(*ORDER)
    first = np.full(21, 110.0 - 30.0)
    reach = float(meeting.zones[0][0].front(110.0)) - 85.0
    travels = np.outer([reach + 0.9, reach + 1.1], np.ones(21))
    assert meeting.steps_ahead(travels, first).tolist() == [0, 21]


def test_by_zone_a_cav_that_is_not_out_of_the_way_in_time_waits_all_the_same(junction: Junction) -> None:
    cars = car("CAV1", "south-north", 70.0, 8.0), car("CAV2", "west-east", 70.0, 8.0)
    chosen = [plans(junction, *cars, by_zone=by_zone).joint(ORDER).chosen for by_zone in (False, True)]
    assert chosen[0] == chosen[1]
    assert chosen[1]["CAV2"] > 0


def test_a_cav_that_precedes_lets_one_pass_that_means_to_pass_before_it(junction: Junction) -> None:
    """CAV2 rolls on at 6 m/s, as it has planned: CAV1 could be there before it, and does not go."""
    cars = car("CAV1", "south-north", 70.0, 8.0), car("CAV2", "west-east", 88.0, 6.0)
    passage = EarlyPassing("CAV2", "CAV1", (108.4, 104.4))
    free, bound = (plans(junction, *cars, by_zone=True, kept=kept) for kept in ((), (passage,)))
    assert first_actions(free, free.joint(ORDER)) == [Action.FASTER, Action.SLOWER]
    joint = bound.joint(ORDER)
    assert first_actions(bound, joint) == [Action.SLOWER, Action.FASTER]
    assert [(p.first, p.second) for p in bound.passages(joint)] == [("CAV2", "CAV1")]
    assert joint.stuck == ()


@pytest.mark.parametrize(
    ("sequence", "entries"),
    [
        (ORDER, (109.2, 104.4)),  # Where no zone of the two begins
        (ORDER, (108.4, 105.2)),
        (ORDER[::-1], (108.4, 104.4)),  # CAV2 is planned first, and CAV1 minds what it does now
    ],
)
def test_a_cav_lets_pass_at_that_zone_alone_and_only_whom_it_precedes(
    sequence: tuple[str, ...], entries: tuple[float, float], junction: Junction
) -> None:
    cars = car("CAV1", "south-north", 70.0, 8.0), car("CAV2", "west-east", 88.0, 6.0)
    passage = EarlyPassing("CAV2", "CAV1", entries)
    free, told = (plans(junction, *cars, by_zone=True, kept=kept).joint(sequence) for kept in ((), (passage,)))
    assert {name: flags.tolist() for name, flags in told.works.items()} == {
        name: flags.tolist() for name, flags in free.works.items()
    }


def test_a_cav_without_a_plan_goes_first_if_that_leaves_it_one(junction: Junction) -> None:
    """CAV2 can no longer stop, so with CAV1 planned before it there is nothing that it could do."""
    cars = car("CAV1", "south-north", 80.0, 8.0), car("CAV2", "west-east", 103.0, 8.0)
    made = plans(junction, *cars, by_zone=False)
    assert made.joint(ORDER).stuck == ("CAV2",)
    assert made.rescued(ORDER).stuck == ()
    lost = plans(junction, car("CAV1", "south-north", 96.0, 8.0), cars[1], by_zone=False)
    assert lost.rescued(ORDER).stuck == ("CAV2",)
    # It is neither behind CAV1 nor out of its way in time: CAV1 is not to wait for it.
    assert lost.passages(lost.rescued(ORDER)) == []


def test_a_cav_begins_with_what_it_is_told_and_is_stuck_if_no_plan_that_works_does(junction: Junction) -> None:
    cars = car("CAV1", "south-north", 70.0, 8.0), car("CAV2", "west-east", 96.0, 6.0)
    made = plans(junction, *cars, by_zone=False)
    joint = made.joint(ORDER)
    assert (first_actions(made, joint), joint.stuck) == ([Action.FASTER, Action.SLOWER], ())
    slowly, fast = (
        made.beginning(joint, {name: told}) for name, told in (("CAV1", Action.IDLE), ("CAV2", Action.FASTER))
    )
    assert (first_actions(made, slowly), slowly.stuck) == ([Action.IDLE, Action.SLOWER], ())
    assert (first_actions(made, fast), fast.stuck) == ([Action.FASTER, Action.FASTER], ("CAV2",))


def test_a_cav_that_was_held_back_is_not_let_pass(junction: Junction) -> None:
    def then(*held_back: str) -> Mapping[str, Action]:
        executor = planned()
        steps = (FAR, NEAR), (car("CAV1", "south-north", 70.0, 8.0), car("CAV2", "west-east", 88.0, 6.0))
        first, second = (replace(moment_of(junction.thoughts(*cars)), by_zone=True) for cars in steps)
        executor.drive(first, ordering_of(*ORDER))
        executor.not_driven(held_back)
        return executor.drive(second, ordering_of(*ORDER)).actions

    assert then() == {"CAV1": Action.IDLE, "CAV2": Action.FASTER}
    assert then("CAV2") == {"CAV1": Action.FASTER, "CAV2": Action.SLOWER}
