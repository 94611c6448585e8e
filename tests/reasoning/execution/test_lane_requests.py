"""Who asks for a lane change: MOBIL's incentive, the shared gap test, and whose requests are in each other's way."""

from itertools import combinations, pairwise
from math import inf

import pytest
from driven import drive, moment_of, ordered, planned
from hypothesis import given, settings
from hypothesis import strategies as st
from worlds import Car, Junction, car

from codriving.datatypes.order import PassingOrder
from codriving.datatypes.world import Action, Kind, Start
from codriving.methods.fcfs import FirstComeFirstServed
from codriving.reasoning.execution.lane_requests import LaneRequests, incentive
from codriving.reasoning.ordering.protocol import Ordering, Request, best_subset, in_order
from codriving.reasoning.safety.adjacent_lane import check_adjacent

COOL_DOWN = 2.0
POLITENESS = 0.3
THRESHOLD = 0.2

LEFT, RIGHT = Action.LANE_LEFT, Action.LANE_RIGHT
NOBODY = PassingOrder((), ())


def ask(world: Junction, *cars: Car, requests: LaneRequests | None = None, time: float = 0.0) -> list[Request]:
    """What is asked for on a road without conflicts."""
    moment = moment_of(world.thoughts(*cars), time)
    driven = planned().drive(moment, Ordering((), {}))
    return (requests or LaneRequests()).gather(moment, NOBODY, driven.expected, 8)


def gain(world: Junction, *cars: Car, action: Action = LEFT) -> float:
    """The incentive of CAV1."""
    thoughts = world.thoughts(*cars)
    there = thoughts.safety_input("CAV1", NOBODY).beside(action)
    assert there is not None
    return incentive(thoughts.scenes["CAV1"], there.scene, moment_of(thoughts))


ME = car("CAV1", "lane-1", 300.0, 25.0)
SLOW = car("HDV1", "lane-1", 335.0, 15.0)


def test_a_free_lane_beside_a_slow_leader_is_worth_something(highway: Junction) -> None:
    assert gain(highway, ME) == pytest.approx(0.0)
    assert gain(highway, ME, SLOW) > THRESHOLD
    assert gain(highway, ME, car("HDV1", "lane-0", 335.0, 15.0)) < 0, "and the lane of a slow one is not"
    free = gain(highway, ME, SLOW)
    assert gain(highway, ME, SLOW, car("HDV2", "lane-0", 345.0, 15.0)) < free


def test_those_behind_count_for_less_than_oneself(highway: Junction) -> None:
    free = gain(highway, ME, SLOW)
    held_up = gain(highway, ME, SLOW, car("HDV2", "lane-0", 275.0, 30.0))
    set_free = gain(highway, car("CAV1", "lane-1", 300.0, 15.0), SLOW, car("HDV2", "lane-1", 285.0, 25.0))
    alone = gain(highway, car("CAV1", "lane-1", 300.0, 15.0), SLOW)
    assert held_up < free, "a fast one behind on the lane beside would have to brake"
    assert set_free != alone, "and one behind on its own lane gets a new leader"
    assert POLITENESS < 1
    # The loss of the vehicle that is behind counts with the weight of politeness: no more than the hardest braking.
    assert free - held_up <= POLITENESS * (8.0 + 2.0) + 1e-9


def test_a_slow_leader_makes_it_ask_for_the_lane_beside(highway: Junction) -> None:
    (request,) = ask(highway, ME, SLOW)
    assert (request.ego, request.action, request.since, request.excludes) == ("CAV1", LEFT, 0.0, frozenset())
    assert THRESHOLD < request.incentive < inf
    assert ask(highway, ME) == []
    assert ask(highway, ME, car("HDV1", "lane-1", 440.0, 25.0)) == [], "as fast as itself, and far away"


@pytest.mark.parametrize("speed", [0.0, 2.9])
def test_a_vehicle_that_hardly_moves_does_not_ask(speed: float, highway: Junction) -> None:
    assert ask(highway, car("CAV1", "lane-1", 300.0, speed), car("HDV1", "lane-1", 308.0, 0.0)) == []


def test_onto_a_vehicle_beside_or_in_front_of_a_fast_one_no_vehicle_asks_to_go(highway: Junction) -> None:
    def sides(*cars: Car) -> set[Action]:
        return {r.action for r in ask(highway, ME, SLOW, *cars)}

    assert sides(car("HDV2", "lane-0", 299.0, 25.0)) == {RIGHT}
    assert sides(car("HDV2", "lane-2", 301.0, 25.0)) == {LEFT}
    assert sides(car("HDV2", "lane-0", 299.0, 25.0), car("HDV3", "lane-2", 301.0, 25.0)) == set()
    assert sides(car("HDV2", "lane-0", 280.0, 32.0), car("HDV3", "lane-2", 280.0, 32.0)) == set()


cars_of = st.lists(
    st.tuples(st.integers(0, 3), st.integers(0, 12), st.sampled_from([15.0, 20.0, 25.0, 30.0]), st.booleans()),
    min_size=3,
    max_size=10,
    unique_by=lambda c: c[:2],
)


@settings(max_examples=30, deadline=None)
@given(cars_of)
def test_every_request_passes_the_gap_test_of_all_methods_and_overlaps_are_mutual(
    highway: Junction, some: list[tuple[int, int, float, bool]]
) -> None:
    cars = [
        car(f"{'CAV' if cav else 'HDV'}{k}", f"lane-{lane}", 300.0 + 9.0 * place, speed)
        for k, (lane, place, speed, cav) in enumerate(some)
    ]
    thoughts = highway.thoughts(*cars)
    requests = ask(highway, *cars)
    assert len({r.ego for r in requests}) == len(requests)
    assert [(r.since, r.ego) for r in requests] == sorted((r.since, r.ego) for r in requests)
    by_name = {r.ego: r for r in requests}
    for r in requests:
        assert r.action in thoughts.available[r.ego]
        assert r.incentive > THRESHOLD
        assert r.action not in check_adjacent(thoughts.safety_input(r.ego, NOBODY))
        assert r.ego not in r.excludes
        assert all(r.ego in by_name[other].excludes for other in r.excludes)


def test_two_that_want_the_lane_between_them_are_in_each_others_way(highway: Junction) -> None:
    ahead = [car(f"HDV{k}", f"lane-{k}", 345.0, 15.0) for k in (0, 2, 3)]
    near = ask(highway, car("CAV1", "lane-0", 300.0, 25.0), car("CAV2", "lane-2", 309.0, 25.0), *ahead)
    behind = [car(f"HDV{k + 4}", f"lane-{k}", 260.0, 15.0) for k in (2, 3)]
    far = ask(highway, car("CAV1", "lane-0", 300.0, 25.0), car("CAV2", "lane-2", 230.0, 25.0), *ahead, *behind)
    assert {r.ego: r.excludes for r in near} == {"CAV1": {"CAV2"}, "CAV2": {"CAV1"}}
    assert {r.action for r in near} == {LEFT, RIGHT}
    assert {r.ego: r.excludes for r in far} == {"CAV1": set(), "CAV2": set()}
    assert len(in_order(near)) == 1
    assert len(in_order(far)) == 2


def test_it_asks_since_it_first_did_and_not_again_too_soon(highway: Junction) -> None:
    requests = LaneRequests()
    for time in (0.0, 1.0):
        (request,) = ask(highway, ME, SLOW, requests=requests, time=time)
        assert request.since == 0.0
    requests.granted(frozenset({"CAV1"}), 1.0)
    assert ask(highway, ME, SLOW, requests=requests, time=1.0 + COOL_DOWN - 0.1) == []
    (request,) = ask(highway, ME, SLOW, requests=requests, time=1.0 + COOL_DOWN)
    assert request.since == 1.0 + COOL_DOWN, "a new wish"


def on_ramp(merge: Junction, *others: Car, before_end: float = 60.0, speed: float = 15.0) -> list[Request]:
    change = merge.road_map.changes.ahead("ramp", 0.0)
    assert change is not None
    return ask(merge, car("CAV1", "ramp", change[1] - before_end, speed), *others)


def test_who_has_to_change_asks_whatever_it_gains(merge: Junction) -> None:
    for speed in (15.0, 2.0):
        (request,) = on_ramp(merge, speed=speed)
        assert (request.action, request.incentive) == (LEFT, inf)


def test_who_has_to_change_asks_only_if_there_is_room(merge: Junction) -> None:
    change = merge.road_map.changes.ahead("ramp", 0.0)
    assert change is not None
    x, y = merge.road_map.paths["ramp"].position(change[1] - 60.0)
    sides = merge.road_map.changes.routes_beside("ramp", merge.road_map.lane_at("ramp", change[1] - 60.0))
    main = next(route for route, lane in sides if lane == change[0])
    place, _ = merge.road_map.project(main, float(x), float(y))
    assert on_ramp(merge, car("HDV1", main, place - 1.0, 15.0)) == []
    assert len(on_ramp(merge, car("HDV1", main, place - 80.0, 15.0))) == 1


def test_of_two_lane_changes_at_least_the_cool_down_lies_between(highway: Junction) -> None:
    environment = highway.drive(
        Start("CAV1", Kind.CAV, "lane-1", 100.0, 25.0),
        *[Start(f"HDV{k}", Kind.HDV, f"lane-{k % 3}", 150.0 + 25.0 * k, 15.0) for k in range(6)],
    )
    episode = drive(environment, ordered(highway), 0)
    changes = [step.time for step in episode.steps if step.actions.get("CAV1") in (LEFT, RIGHT)]
    assert changes
    assert all(b - a >= COOL_DOWN for a, b in pairwise(changes))


def test_on_the_highway_a_slow_driver_is_overtaken(highway: Junction) -> None:
    environment = highway.drive(
        Start("CAV1", Kind.CAV, "lane-1", 100.0, 25.0), Start("HDV1", Kind.HDV, "lane-1", 150.0, 15.0)
    )
    episode = drive(environment, ordered(highway), 0)
    assert episode.outcome is not None
    assert episode.outcome.arrivals["CAV1"] < 26.0


requests_of = st.integers(0, 7).flatmap(
    lambda n: st.tuples(
        st.lists(st.floats(0.2, 5.0) | st.just(inf), min_size=n, max_size=n),
        st.sets(st.sampled_from(list(combinations(range(n), 2))) if n > 1 else st.nothing()),
    )
)


def requests_from(gains: list[float], overlaps: set[tuple[int, int]]) -> list[Request]:
    found: list[set[str]] = [set() for _ in gains]
    for a, b in overlaps:
        found[a].add(f"v{b}")
        found[b].add(f"v{a}")
    return [Request(f"v{k}", LEFT, g, float(k), frozenset(found[k])) for k, g in enumerate(gains)]


def worth(chosen: tuple[Request, ...]) -> float:
    return sum(min(r.incentive, 1e6) for r in chosen)


@given(requests_of)
def test_the_best_subset_is_the_best_of_all(drawn: tuple[list[float], set[tuple[int, int]]]) -> None:
    requests = requests_from(*drawn)
    subsets = [s for size in range(len(requests) + 1) for s in combinations(requests, size)]
    apart = [s for s in subsets if not any(r.excludes & {o.ego for o in s} for r in s)]
    granted = best_subset(requests)
    chosen = tuple(r for r in requests if r.ego in granted)
    assert chosen in apart
    assert worth(chosen) == pytest.approx(max(worth(s) for s in apart))


@given(requests_of)
def test_in_order_no_later_vehicle_displaces_an_earlier_one(drawn: tuple[list[float], set[tuple[int, int]]]) -> None:
    requests = requests_from(*drawn)
    granted = in_order(requests)
    for k, r in enumerate(requests):
        earlier = granted & {o.ego for o in requests[:k]}
        assert (r.ego in granted) == (not r.excludes & earlier)
    assert (
        worth(tuple(r for r in requests if r.ego in granted))
        <= worth(tuple(r for r in requests if r.ego in best_subset(requests))) + 1e-6
    )


def test_the_best_subset_of_many_is_still_free_of_overlaps() -> None:
    requests = requests_from([float(k) for k in range(1, 16)], {(k, k + 1) for k in range(14)})
    granted = best_subset(requests)
    assert not any(r.excludes & granted for r in requests if r.ego in granted)
    assert "v14" in granted


def test_a_rule_grants_what_was_asked() -> None:
    requests = requests_from([1.0, 2.0, 3.0], {(0, 1), (1, 2)})
    assert FirstComeFirstServed().grant(requests) == {"v0", "v2"}
