"""The conflict coordinator: who goes first, and that it stays so."""

from collections.abc import Callable
from dataclasses import replace
from graphlib import TopologicalSorter

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from worlds import Car, Junction, Thoughts, car

from codriving.datatypes.order import PassingOrder
from codriving.environment.environment import Environment
from codriving.reasoning.ordering.coordinator import RuleCoordinator
from codriving.reasoning.ordering.negotiation import AgreedOrder
from codriving.reasoning.ordering.problem import pose

ROUTES = tuple(
    f"{a}-{b}" for a in ("south", "west", "north", "east") for b in ("south", "west", "north", "east") if a != b
)

cavs = st.lists(st.tuples(st.sampled_from(ROUTES), st.floats(20.0, 125.0), st.floats(0.0, 9.0)), min_size=2, max_size=8)
humans = st.lists(st.tuples(st.sampled_from(ROUTES), st.floats(20.0, 125.0), st.floats(0.0, 9.0)), max_size=4)


def negotiated(junction: Junction, *cars: Car) -> PassingOrder:
    return junction.thoughts(*cars).negotiate()


def check_order(thoughts: Thoughts, order: PassingOrder) -> None:
    """Every pair of CAVs in conflict is decided once, with a reason, and no chain of precedences leads back."""
    pairs = [frozenset((p.first, p.second)) for p in order.precedences]
    conflicts = {frozenset((c.ego, c.other)) for cs in thoughts.conflicts.values() for c in cs}
    assert set(pairs) <= conflicts
    assert len(set(pairs)) == len(pairs)
    # With a human driver it may stay open who goes first: then the CAV must be able to wait.
    assert {pair for pair in conflicts if pair <= set(thoughts.scenes)} <= set(pairs)
    assert all(p.reason for p in order.precedences)
    graph: dict[str, set[str]] = {}
    for p in order.precedences:
        graph.setdefault(p.second, set()).add(p.first)
    list(TopologicalSorter(graph).static_order())
    rank = {name: k for k, name in enumerate(order.sequence)}
    assert len(rank) == len(order.sequence)
    assert set(rank) == {name for pair in conflicts for name in pair}
    assert all(rank[p.first] < rank[p.second] for p in order.precedences)


@settings(max_examples=30, deadline=None)
@given(cavs, humans)
def test_an_order_has_no_cycles_wherever_every_vehicle_is(
    junction: Junction, some: list[tuple[str, float, float]], others: list[tuple[str, float, float]]
) -> None:
    cars = [car(f"CAV{k}", *c) for k, c in enumerate(some)] + [car(f"HDV{k}", *c) for k, c in enumerate(others)]
    thoughts = junction.thoughts(*cars)
    check_order(thoughts, thoughts.negotiate())


@pytest.mark.parametrize(("scenario", "cavs"), [("intersection", 4), ("intersection", 8), ("merge", 6), ("highway", 6)])
def test_an_order_has_no_cycles_at_the_start_of_any_episode(
    scenario: str, cavs: int, configured: Callable[..., Environment]
) -> None:
    environment = configured(f"scenario={scenario}", f"scenario.cavs={cavs}")
    junction = Junction(environment)
    for seed in range(300, 310):
        thoughts = junction.think(environment.reset(seed))
        check_order(thoughts, thoughts.negotiate())


@settings(max_examples=30, deadline=None)
@given(
    st.lists(st.tuples(st.sampled_from(ROUTES), st.floats(20.0, 150.0), st.floats(0.0, 9.0)), min_size=3, max_size=8)
)
def test_cavs_alone_never_contradict_one_another(roundabout: Junction, some: list[tuple[str, float, float]]) -> None:
    # On the ring each may wait for the next one in turn; still no pair of them has to be dropped.
    thoughts = roundabout.thoughts(*[car(f"CAV{k}", *c) for k, c in enumerate(some)])
    check_order(thoughts, thoughts.negotiate())


@settings(max_examples=20, deadline=None)
@given(cavs, humans)
def test_who_cannot_stop_any_more_or_drives_ahead_goes_first_whatever_is_saved(
    junction: Junction, some: list[tuple[str, float, float]], others: list[tuple[str, float, float]]
) -> None:
    cars = [car(f"CAV{k}", *c) for k, c in enumerate(some)] + [car(f"HDV{k}", *c) for k, c in enumerate(others)]
    thoughts = junction.thoughts(*cars)
    coordinator = RuleCoordinator(False)
    order = thoughts.negotiate(coordinator)
    fixed = pose(thoughts.moment()).instance.before
    for one, other in fixed:
        if (other, one) not in fixed:
            assert order.first_of(one, other) != other


@pytest.mark.parametrize("turning", ["CAV1", "CAV2"])
@pytest.mark.parametrize(("place", "yields"), [(56.0, True), (57.0, True), (59.0, False)])
def test_turning_yields_to_straight_unless_all_together_would_wait_longer(
    place: float, yields: bool, turning: str, junction: Junction
) -> None:
    # From 56.3 m on the turning CAV could be there a little earlier; from 58 m on its waiting would cost too much.
    straight = "CAV2" if turning == "CAV1" else "CAV1"
    order = negotiated(junction, car(turning, "south-west", place, 8.0), car(straight, "north-south", 60.0, 8.0))
    (p,) = order.precedences
    assert (p.first == straight) is yields
    assert ("turns and yields" in p.reason) is yields


def test_where_ways_only_merge_turning_is_no_reason_to_yield(junction: Junction) -> None:
    for place in (53.0, 54.0, 55.0, 56.0, 57.0):
        turns, straight = car("CAV1", "south-east", place, 8.0), car("CAV2", "west-east", 60.0, 8.0)
        (p,) = negotiated(junction, turns, straight).precedences
        assert "turns and yields" not in p.reason
        assert "earlier" in p.reason


def test_earlier_arrival_goes_first_when_they_are_far_apart(junction: Junction) -> None:
    order = negotiated(junction, car("CAV1", "south-west", 80.0, 8.0), car("CAV2", "north-south", 40.0, 8.0))
    (p,) = order.precedences
    assert p.first == "CAV1"
    assert "earlier" in p.reason


def test_who_can_no_longer_stop_goes_first(junction: Junction) -> None:
    # The turning CAV is in the junction; the other one is nearly there, yet could still stop.
    order = negotiated(junction, car("CAV1", "south-west", 106.0, 6.0), car("CAV2", "north-south", 88.0, 6.0))
    (p,) = order.precedences
    assert p.first == "CAV1"
    assert "can no longer stop" in p.reason


def test_the_leader_on_a_lane_goes_before_its_follower(junction: Junction) -> None:
    # The follower goes straight and the leader turns, and yet it cannot be overtaken.
    order = negotiated(
        junction,
        car("CAV1", "south-north", 59.0, 9.0),
        car("CAV2", "south-west", 66.0, 0.0),
        car("CAV3", "north-south", 20.0, 5.0),
        car("CAV4", "west-east", 30.0, 5.0),
    )
    assert order.sequence.index("CAV2") < order.sequence.index("CAV1")


def test_the_order_stays_while_nothing_changes(junction: Junction) -> None:
    def ahead(gain: float) -> Thoughts:
        return junction.thoughts(car("CAV1", "south-north", 60.0 + gain, 8.0), car("CAV2", "west-east", 64.0, 8.0))

    for first, gain in (("CAV1", 6.0), ("CAV2", -6.0)):
        thoughts = ahead(gain)
        coordinator = RuleCoordinator(False)
        assert thoughts.negotiate(coordinator).first_of("CAV1", "CAV2") == first
        # Now the other one is a little ahead: it would be first if the order were new.
        assert ahead(-gain / 3).negotiate().first_of("CAV1", "CAV2") != first
        assert ahead(-gain / 3).negotiate(coordinator).first_of("CAV1", "CAV2") == first
        # If it is far ahead, agreement or not, it goes.
        assert ahead(-5 * gain).negotiate(coordinator).first_of("CAV1", "CAV2") != first


def test_how_much_earlier_the_other_one_has_to_be_there_before_an_order_is_changed(junction: Junction) -> None:
    # At 8 m/s CAV1 would be first from 63.9 m on if nothing were agreed, and turns the agreement round at 65.9 m.
    for place, first in ((63.9, "CAV1"), (65.8, "CAV2"), (66.0, "CAV1")):
        coordinator = RuleCoordinator(False)
        other = car("CAV2", "west-east", 64.0, 8.0)
        if place > 64:
            agreed = junction.thoughts(car("CAV1", "south-north", 58.0, 8.0), other).negotiate(coordinator)
            assert agreed.first_of("CAV1", "CAV2") == "CAV2"
        thoughts = junction.thoughts(car("CAV1", "south-north", place, 8.0), other)
        assert thoughts.negotiate(coordinator).first_of("CAV1", "CAV2") == first


def test_no_vehicle_in_conflict_gives_an_empty_order(junction: Junction) -> None:
    order = negotiated(junction, car("CAV1", "south-north", 60.0, 8.0), car("CAV2", "north-south", 60.0, 8.0))
    assert order.sequence == order.precedences == ()


def test_every_vehicle_gets_the_same_order_and_is_told_if_it_binds(junction: Junction) -> None:
    thoughts = junction.thoughts(car("CAV1", "south-north", 60.0, 8.0), car("CAV2", "west-east", 55.0, 8.0))
    for binding in (False, True):
        agreed = AgreedOrder(RuleCoordinator(binding))
        orders = agreed.orders(thoughts.moment())
        assert orders["CAV1"] is orders["CAV2"]
        assert orders["CAV1"].binding is binding


def test_human_drivers_are_in_the_order_as_well(junction: Junction) -> None:
    order = negotiated(junction, car("CAV1", "south-north", 80.0, 8.0), car("HDV1", "west-east", 80.0, 8.0))
    (p,) = order.precedences
    assert (p.first, p.second) == ("HDV1", "CAV1")
    assert "human driver" in p.reason
    assert order.sequence == ("HDV1", "CAV1")


def test_no_cav_is_told_to_pass_in_front_of_a_human_driver_who_may_be_there_first(junction: Junction) -> None:
    for place in range(70, 104, 4):
        thoughts = junction.thoughts(car("CAV1", "south-north", 85.0, 8.0), car("HDV1", "west-east", float(place), 8.0))
        order = thoughts.negotiate()
        if order.first_of("CAV1", "HDV1") == "CAV1":
            mine = thoughts.forecast.reach(8.0, True).most
            for c in thoughts.conflicts["CAV1"]:
                worst = thoughts.forecast.reach(8.0, False).most
                enters = thoughts.forecast.time_to(c.distances[1], worst)
                assert thoughts.forecast.time_to(c.distances[0], mine) < enters


def test_zone_by_zone_who_is_scheduled_first_is_told_to_go_first(junction: Junction) -> None:
    coordinator, firsts = RuleCoordinator(binding=False), []
    # Keeping the order of before costs nothing: CAV2, now near, passes in time before CAV1, which is far away.
    for near, far in ((85.0, 30.0), (30.0, 85.0)):
        cars = car("CAV1", "south-north", near, 8.0), car("CAV2", "west-east", far, 8.0)
        order = coordinator.negotiate(replace(junction.thoughts(*cars).moment(), by_zone=True))
        firsts.append((order.first_of("CAV1", "CAV2"), order.sequence))
    assert firsts == [("CAV1", ("CAV1", "CAV2")), ("CAV2", ("CAV2", "CAV1"))]
