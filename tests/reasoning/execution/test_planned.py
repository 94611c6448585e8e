"""The planned executor: one moment, and CAVs that do exactly what is predicted."""

from itertools import permutations

import numpy as np
import pytest
from driven import moment_of, ordered, ordering_of, planned, puppets
from hypothesis import given, settings
from hypothesis import strategies as st
from worlds import Car, Junction, car

from codriving.datatypes.world import Action
from codriving.errors import ConfigError
from codriving.geometry.box import TRUE, corners, overlap
from codriving.reasoning.execution.planned import Drive
from codriving.reasoning.ordering.protocol import Ordering

ROUTES = tuple(
    f"{a}-{b}" for a in ("south", "west", "north", "east") for b in ("south", "west", "north", "east") if a != b
)
CROSSING = (car("CAV1", "south-north", 70.0, 8.0), car("CAV2", "west-east", 70.0, 8.0))
LEGS = ("south", "west", "north", "east")


def moment(junction: Junction, *cars: Car, order: tuple[str, ...] = ()) -> Drive:
    moment = moment_of(junction.thoughts(*cars))
    return planned().drive(moment, ordering_of(*order))


def passes(junction: Junction, drive: Drive, name: str, other: str) -> float:
    """When a vehicle is expected at the conflict point with another one [s]."""
    mine, theirs = drive.expected[name][0], drive.expected[other][0]
    (zone,) = junction.road_map.zones(mine.route, theirs.route)
    return float(np.argmax(mine.places > zone.point_i))


@pytest.mark.parametrize("order", list(permutations(("CAV1", "CAV2"))))
def test_the_first_goes_and_the_second_arrives_after_it(order: tuple[str, ...], junction: Junction) -> None:
    drive = moment(junction, *CROSSING, order=order)
    first, second = order
    assert drive.actions[first] is Action.FASTER
    assert drive.expected[first][0].free
    assert not drive.expected[second][0].free
    assert 0 < passes(junction, drive, first, second) < passes(junction, drive, second, first)
    assert first in drive.reasons[second]
    assert drive.counts["plans_infeasible"] == 0


@pytest.mark.parametrize("order", [("CAV1", "CAV2"), ("CAV2", "CAV1")])
def test_the_plan_asked_for_is_the_one_that_is_driven(order: tuple[str, ...], junction: Junction) -> None:
    moment = moment_of(junction.thoughts(*CROSSING))
    executor = planned()
    planner = executor.planner(moment)
    plan = planner.plan(order)
    drive = executor.drive(moment, ordering_of(*order))
    assert plan.feasible
    for name in order:
        places = drive.expected[name][0].places
        assert np.allclose(places - places[0], plan.travels[name])
    gap = planner.gap_time(plan, *order)
    assert gap == planner.gap_time(plan, *reversed(order))
    assert 0.5 < gap < 10.0


@settings(max_examples=25, deadline=None)
@given(
    st.lists(st.tuples(st.sampled_from(ROUTES), st.floats(20.0, 90.0), st.floats(0.0, 9.0)), min_size=1, max_size=6),
    st.randoms(use_true_random=False),
)
def test_every_moment_has_one_answer_that_the_road_allows(
    junction: Junction, some: list[tuple[str, float, float]], draw: object
) -> None:
    cars = [car(f"CAV{k}", *c) for k, c in enumerate(some)]
    thoughts = junction.thoughts(*cars)
    order = sorted(name for name, cs in thoughts.conflicts.items() if cs)
    draw.shuffle(order)  # type: ignore[attr-defined]
    moment = moment_of(thoughts)
    first, second = (planned().drive(moment, ordering_of(*order)) for _ in range(2))
    assert first.actions == second.actions
    assert first.reasons == second.reasons
    assert set(first.actions) == set(moment.available)
    assert all(action in moment.available[name] for name, action in first.actions.items())
    top = junction.model.target_speeds[-1]
    for name in first.actions:
        assert first.reasons[name]
        # Actions after which there is a plan; the one that is taken is among them unless nothing works.
        assert first.counts["plans_infeasible"] or first.actions[name] in first.progress[name]
        steps = np.diff(first.expected[name][0].places)
        assert steps.min() >= -1e-9
        assert steps.max() <= top * moment.forecast.sample + 1e-9


def test_only_what_keeps_the_order_is_worth_something(junction: Junction) -> None:
    cars = car("CAV1", "south-north", 92.0, 6.0), car("CAV2", "west-east", 99.0, 6.0)
    drive = moment(junction, *cars, order=("CAV1", "CAV2"))
    assert set(drive.progress["CAV1"]) == {Action.FASTER, Action.IDLE, Action.SLOWER}
    assert Action.FASTER not in drive.progress["CAV2"]
    assert drive.actions["CAV2"] is Action.SLOWER


def test_no_vehicle_reaches_its_zone_before_the_method_allows_it(junction: Junction) -> None:
    moment = moment_of(junction.thoughts(*CROSSING))
    times = moment.forecast.times
    at_once, later = (
        planned().drive(moment, Ordering(("CAV1", "CAV2"), {"CAV1": 0.0, "CAV2": 3.0}, not_before=held))
        for held in ({}, {"CAV1": 8.0})
    )
    (zone,) = junction.road_map.zones("south-north", "west-east")
    enters = [times[np.argmax(d.expected["CAV1"][0].places >= zone.entry_i)] for d in (at_once, later)]
    assert enters[0] < 6.0
    assert enters[1] >= 8.0
    assert later.counts["plans_infeasible"] == 0


def test_a_follower_keeps_behind_the_vehicle_ahead_whatever_the_order_says(junction: Junction) -> None:
    cars = car("CAV1", "south-north", 60.0, 9.0), car("CAV2", "south-north", 69.0, 3.0)
    for order in (("CAV1", "CAV2"), ("CAV2", "CAV1"), ()):
        drive = moment(junction, *cars, order=order)
        assert drive.actions["CAV1"] is Action.SLOWER
        assert drive.actions["CAV2"] is Action.FASTER
        gap = drive.expected["CAV2"][0].places - drive.expected["CAV1"][0].places
        assert gap.min() > 5.0


@pytest.mark.parametrize("key", ["gap", "margin", "pad", "headway"])
@pytest.mark.parametrize("value", [-0.1, 5.1])
def test_settings_out_of_range_are_refused(key: str, value: float) -> None:
    with pytest.raises(ConfigError, match=f"{key} must be 0 to 5"):
        planned(**{key: value})


def body(junction: Junction, route: str, s: float) -> np.ndarray:
    path = junction.road_map.paths[route]
    return corners(*path.position(s), path.heading(s), TRUE.length, TRUE.width)


@settings(max_examples=8, deadline=None)
@given(st.lists(st.tuples(st.sampled_from(ROUTES), st.floats(30.0, 80.0)), min_size=4, max_size=4))
def test_cavs_on_their_routes_never_touch_and_all_arrive(junction: Junction, some: list[tuple[str, float]]) -> None:
    # One on each leg, so that no vehicle starts on top of another; all of them as fast as they may.
    cars = [
        car(f"CAV{k}", f"{leg}-{_to(leg, route)}", place, 9.0)
        for k, (leg, (route, place)) in enumerate(zip(LEGS, some, strict=True), 1)
    ]
    show = puppets(junction, ordered(junction), cars, 30.0)
    assert all(show.arrived(c.id) for c in cars)
    assert sum(step.counts["plans_infeasible"] for step in show.steps) == 0
    for k in range(0, len(show.places["CAV1"]), 2):
        bodies = [body(junction, c.route, show.places[c.id][k]) for c in cars if np.isfinite(show.places[c.id][k])]
        assert not any(overlap(a, b) for i, a in enumerate(bodies) for b in bodies[:i])


def _to(leg: str, route: str) -> str:
    """Where a route leads, or straight on if it leads back."""
    goal = route.split("-")[1]
    return goal if goal != leg else LEGS[(LEGS.index(leg) + 2) % 4]
