"""The ordering problem of one moment: who, when at the earliest, how far apart, and what is fixed."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from worlds import Car, Junction, car

from codriving.geometry.box import TRUE
from codriving.geometry.zone import ConflictZone
from codriving.reasoning.ordering.coordinator import reason_between
from codriving.reasoning.ordering.problem import COMMITTED, Problem, pose
from codriving.reasoning.ordering.schedule import repaired, schedule
from codriving.reasoning.sharing.tracking import Tracking

FOLLOWS = (7.0, 0.5)
FOREVER = 1000.0

ROUTES = tuple(
    f"{a}-{b}" for a in ("south", "west", "north", "east") for b in ("south", "west", "north", "east") if a != b
)
GAP = 0.6
some_cars = st.lists(st.tuples(st.sampled_from(ROUTES), st.floats(20.0, 112.0), st.floats(0.0, 9.0)), max_size=7)


def posed(junction: Junction, *cars: Car, gap: float = GAP) -> Problem:
    return pose(junction.thoughts(*cars).moment(), gap)


def furthest(zone: ConflictZone) -> float:
    """The largest difference of i's arc length and j's at which the two still touch, tried out [m]."""
    b = np.arange(zone.entry_j, zone.exit_j + 0.05, 0.05)
    front = np.asarray(zone.front(b))
    inside = np.isfinite(front)
    return float((front[inside] - b[inside]).max())


@pytest.mark.parametrize("gap", [0.6, 1.0])
@pytest.mark.parametrize(
    "routes", [("south-north", "west-east"), ("south-west", "north-south"), ("south-north", "west-north")]
)
def test_how_far_apart_two_must_be(routes: tuple[str, str], gap: float, junction: Junction) -> None:
    # w_ij = (max_b [hi_ij(b) - b] - r_i + r_j) / v_c + tau_g.
    problem = posed(junction, car("CAV1", routes[0], 60.0, 8.0), car("CAV2", routes[1], 62.0, 8.0), gap=gap).instance
    (zone,) = junction.road_map.zones(*routes)
    top = junction.model.target_speeds[-1]
    r1, r2 = (problem.vehicles[name].reference for name in ("CAV1", "CAV2"))
    assert (r1, r2) == (zone.entry_i, zone.entry_j)
    for pair, seen, shift in ((("CAV1", "CAV2"), zone, r2 - r1), (("CAV2", "CAV1"), zone.mirrored(), r1 - r2)):
        assert problem.separation[pair] == pytest.approx((furthest(seen) + shift) / top + gap, abs=0.5 / top)
        assert problem.separation[pair] > gap
    assert problem.conflict("CAV1", "CAV2")


def test_a_vehicle_that_passes_that_much_later_does_not_touch_the_first(junction: Junction) -> None:
    problem = posed(junction, car("CAV1", "south-north", 60.0, 9.0), car("CAV2", "west-east", 60.0, 9.0), gap=0.0)
    (zone,) = junction.road_map.zones("south-north", "west-east")
    apart, top = problem.instance.separation["CAV1", "CAV2"], junction.model.target_speeds[-1]
    t = np.arange(-3.0, 6.0, 0.02)
    first = zone.entry_i + top * t

    def touch(later: float) -> bool:
        second = zone.entry_j + top * (t - later)
        return bool(((first <= zone.front(second)) & (first >= zone.back(second))).any())

    assert not touch(apart + 0.1)
    assert touch(apart - 0.3), "and not more than that"


def test_those_without_a_conflict_are_not_ordered(junction: Junction) -> None:
    problem = posed(junction, car("CAV1", "south-north", 60.0, 8.0), car("CAV2", "north-south", 60.0, 8.0)).instance
    assert problem.vehicles == {}
    cars = car("CAV1", "south-north", 60.0, 8.0), car("CAV2", "north-south", 60.0, 8.0)
    third = posed(junction, *cars, car("CAV3", "west-east", 60.0, 8.0)).instance
    assert list(third.vehicles) == ["CAV1", "CAV2", "CAV3"]
    assert not third.conflict("CAV1", "CAV2")


def test_they_are_ordered_by_name_whatever_the_order_in_which_they_are_seen(junction: Junction) -> None:
    moment = junction.thoughts(
        car("CAV1", "south-north", 60.0, 8.0), car("CAV2", "west-east", 60.0, 8.0), car("CAV3", "east-west", 60.0, 8.0)
    ).moment()
    turned = replace(moment, scenes=dict(reversed(moment.scenes.items())))
    assert list(pose(turned).instance.vehicles) == ["CAV1", "CAV2", "CAV3"]


def test_one_arrives_as_early_as_it_can(junction: Junction) -> None:
    top = junction.model.target_speeds[-1]
    cars = car("CAV1", "south-north", 60.0, top), car("CAV2", "west-east", 60.0, 0.0)
    vehicles = posed(junction, *cars).instance.vehicles
    assert vehicles["CAV1"].eta == pytest.approx(vehicles["CAV1"].distance / top, abs=0.01)
    assert vehicles["CAV2"].eta > vehicles["CAV2"].distance / top + 1.0, "it has to get going"
    assert (vehicles["CAV1"].speed, vehicles["CAV2"].speed) == (top, 0.0)
    assert vehicles["CAV1"].remaining == pytest.approx(junction.road_map.routes["south-north"].goal - 60.0, abs=0.01)
    assert vehicles["CAV1"].crossing > 0


def test_past_the_reference_point_the_time_is_gone(junction: Junction) -> None:
    (zone,) = junction.road_map.zones("south-north", "west-east")
    inside = car("CAV1", "south-north", zone.entry_i + 2.0, 5.0)
    vehicles = posed(junction, inside, car("CAV2", "west-east", 80.0, 8.0)).instance.vehicles
    assert vehicles["CAV1"].eta < 0
    assert vehicles["CAV1"].distance == 0
    assert vehicles["CAV1"].committed
    assert not vehicles["CAV2"].committed


@pytest.mark.parametrize(("before", "committed"), [(4.0, True), (30.0, False)])
def test_who_cannot_stop_any_more_goes_first(before: float, committed: bool, junction: Junction) -> None:
    (zone,) = junction.road_map.zones("south-north", "west-east")
    problem = posed(
        junction, car("CAV1", "south-north", zone.entry_i - before, 9.0), car("CAV2", "west-east", 60.0, 9.0)
    ).instance
    assert problem.vehicles["CAV1"].committed is committed
    assert (("CAV1", "CAV2") in problem.before) is committed
    assert ("CAV2", "CAV1") not in problem.before


def test_a_vehicle_that_drives_ahead_is_the_leader_and_goes_first(junction: Junction) -> None:
    problem = posed(
        junction,
        car("CAV1", "south-north", 60.0, 8.0),
        car("CAV2", "south-west", 75.0, 8.0),
        car("CAV3", "west-east", 40.0, 8.0),
    ).instance
    leaders = {name: e.leader for name, e in problem.vehicles.items()}
    assert leaders == {"CAV1": "CAV2", "CAV2": None, "CAV3": None}
    assert ("CAV2", "CAV1") in problem.before
    distance, time = FOLLOWS
    assert problem.separation["CAV2", "CAV1"] == pytest.approx(distance / junction.model.target_speeds[-1] + time)
    assert problem.vehicles["CAV1"].lane == problem.vehicles["CAV2"].lane
    assert problem.vehicles["CAV1"].stream != problem.vehicles["CAV2"].stream


def test_turning_matters_where_ways_cross(junction: Junction) -> None:
    def turning(route: str, other: str) -> bool:
        problem = posed(junction, car("CAV1", route, 60.0, 8.0), car("CAV2", other, 60.0, 8.0)).instance
        return problem.vehicles["CAV1"].turning

    assert turning("south-west", "north-south")
    assert not turning("south-east", "west-east"), "they only merge"
    assert not turning("south-north", "west-east")


def test_human_drivers_block_the_times_at_which_they_may_pass(junction: Junction) -> None:
    human = car("HDV1", "west-east", 82.0, 8.0)
    problem = posed(junction, car("CAV1", "south-north", 82.0, 8.0), human)
    ((begin, end),) = problem.passages["CAV1"].values()
    windows = problem.instance.vehicles["CAV1"].windows
    assert windows
    assert all(begin <= b < e <= end for b, e in windows)
    (zone,) = junction.road_map.zones("south-north", "west-east")
    steady = (zone.point_j - 82.0) / 8.0
    assert begin < steady < end, "when it comes at its speed, it is in the way"
    assert "HDV1" not in problem.instance.vehicles
    assert problem.instance.separation == {}


def test_a_driver_who_stands_in_the_way_blocks_for_ever(junction: Junction) -> None:
    (zone,) = junction.road_map.zones("south-north", "west-east")
    cars = car("CAV1", "south-north", 82.0, 8.0), car("HDV1", "west-east", (zone.entry_j + zone.exit_j) / 2, 0.0)
    tracking = Tracking(junction.road_map)
    for time in (0.0, 1.0):
        thoughts = junction.think(junction.world(*cars, time=time), tracking=tracking)
    problem = pose(thoughts.moment(), GAP)
    assert (-FOREVER, FOREVER) in problem.instance.vehicles["CAV1"].windows
    assert problem.passages["CAV1"]["HDV1"] == (-FOREVER, FOREVER)


@settings(max_examples=40, deadline=None)
@given(some_cars, some_cars)
def test_every_moment_is_a_problem_that_can_be_solved(
    junction: Junction, some: list[tuple[str, float, float]], others: list[tuple[str, float, float]]
) -> None:
    cars = [car(f"CAV{k}", *c) for k, c in enumerate(some)] + [car(f"HDV{k}", *c) for k, c in enumerate(others[:3])]
    thoughts = junction.thoughts(*cars)
    problem = pose(thoughts.moment(), GAP)
    instance = problem.instance
    assert set(instance.vehicles) == {name for name, cs in thoughts.conflicts.items() if cs}
    assert list(instance.vehicles) == sorted(instance.vehicles)
    assert set(problem.passages) == set(instance.vehicles)
    named = {name for pair in (*instance.separation, *instance.before) for name in pair}
    assert named <= set(instance.vehicles)
    for name, cs in thoughts.conflicts.items():
        for c in cs:
            if c.other in instance.vehicles:
                assert {(name, c.other), (c.other, name)} <= set(instance.separation)
    assert all(np.isfinite(w) for w in instance.separation.values())
    assert all(np.isfinite(e.eta) for e in instance.vehicles.values())
    order = repaired(instance, sorted(instance.vehicles, key=lambda n: (instance.vehicles[n].eta, n)))
    assert sorted(order) == sorted(instance.vehicles)
    circle = any((b, a) in instance.before for a, b in instance.before)
    times = schedule(instance, order)
    if times is not None:
        assert all(times[n] >= instance.vehicles[n].eta for n in order)
    else:
        assert circle or len(instance.before) > 2


def test_who_can_only_stop_where_the_other_cuts_the_corner_goes_first(junction: Junction) -> None:
    # Far enough in for a turning car to brush it, though on the centre lines the bodies would not touch.
    routes = ("south-north", "west-east")
    (reach,), (body,) = (junction.road_map.zones(*routes, size) for size in (COMMITTED, TRUE))
    assert reach.entry_i < body.entry_i
    for place, fixed in ((reach.entry_i - 0.3, False), ((reach.entry_i + body.entry_i) / 2, True)):
        before = posed(junction, car("CAV1", routes[0], place, 0.0), car("CAV2", routes[1], 40.0, 8.0)).instance.before
        assert (("CAV1", "CAV2") in before) is fixed


def test_each_pair_has_distance_time_and_stopping_of_its_own_zone(junction: Junction) -> None:
    # CAV1 meets CAV2 on the near side of the junction and CAV3 on its far side, before which it can still stop.
    cars = [car(name, route, 75.0, 8.0) for name, route in (("CAV2", "west-east"), ("CAV3", "east-west"))]
    thoughts = junction.thoughts(car("CAV1", "south-north", 96.0, 8.0), *cars)
    problem = pose(thoughts.moment()).instance
    for c in thoughts.conflicts["CAV1"]:
        assert problem.approach("CAV1", c.other).distance == c.distances[0]
        assert problem.approach(c.other, "CAV1").distance == c.distances[1]
    near, far = problem.approach("CAV1", "CAV2"), problem.approach("CAV1", "CAV3")
    assert (near.distance, far.distance) == (pytest.approx(8.4, abs=0.1), pytest.approx(12.4, abs=0.1))
    assert near.earliest < far.earliest
    assert (near.can_stop, far.can_stop) == (False, True)
    assert problem.vehicles["CAV1"].committed
    assert "can no longer stop" in reason_between(problem, "CAV1", "CAV2")
    assert "can be there earlier (1.4 s against" in reason_between(problem, "CAV1", "CAV3")
