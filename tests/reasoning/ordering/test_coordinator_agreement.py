"""From a schedule to the passing order that each vehicle is told."""

from collections.abc import Callable
from graphlib import TopologicalSorter

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from worlds import Junction, Thoughts, car

from codriving.datatypes.order import PassingOrder
from codriving.environment.environment import Environment
from codriving.reasoning.ordering.coordinator import agreement
from codriving.reasoning.ordering.problem import Problem, pose
from codriving.reasoning.ordering.schedule import repaired, timed

ROUTES = tuple(
    f"{a}-{b}" for a in ("south", "west", "north", "east") for b in ("south", "west", "north", "east") if a != b
)
cars_of = st.lists(st.tuples(st.sampled_from(ROUTES), st.floats(20.0, 112.0), st.floats(0.0, 9.0)), max_size=6)


def why(first: str, second: str) -> str:
    return f"{first} before {second}"


def agree(
    thoughts: Thoughts, times: dict[str, float] | None = None, binding: bool = True
) -> tuple[Problem, PassingOrder, dict[str, float]]:
    problem = pose(thoughts.moment(), 0.6)
    if times is None:
        ranking = sorted(problem.instance.vehicles, key=lambda n: (problem.instance.vehicles[n].eta, n))
        times = timed(problem.instance, repaired(problem.instance, ranking))
    return problem, agreement(thoughts.moment(), problem, times, why, binding), times


@settings(max_examples=50, deadline=None)
@given(cars_of, cars_of)
def test_no_chain_of_precedences_leads_back(
    junction: Junction, some: list[tuple[str, float, float]], others: list[tuple[str, float, float]]
) -> None:
    cars = [car(f"CAV{k}", *c) for k, c in enumerate(some)] + [car(f"HDV{k}", *c) for k, c in enumerate(others[:4])]
    thoughts = junction.thoughts(*cars)
    problem, order, times = agree(thoughts)
    graph: dict[str, set[str]] = {}
    for p in order.precedences:
        graph.setdefault(p.second, set()).add(p.first)
    list(TopologicalSorter(graph).static_order())
    rank = {name: k for k, name in enumerate(order.sequence)}
    assert all(rank[p.first] < rank[p.second] for p in order.precedences)
    in_conflict = {frozenset((c.ego, c.other)) for cs in thoughts.conflicts.values() for c in cs}
    decided = [frozenset((p.first, p.second)) for p in order.precedences]
    assert len(set(decided)) == len(decided)
    assert set(decided) <= in_conflict
    assert set(rank) == {name for pair in in_conflict for name in pair}
    # Two CAVs are decided, in the order in which they are scheduled.
    place = {name: k for k, name in enumerate(times)}
    for p in order.precedences:
        if p.first in place and p.second in place:
            assert place[p.first] < place[p.second]
            assert p.reason == why(p.first, p.second)
        else:
            begin, _ = problem.passages[p.first if p.first in place else p.second][
                p.second if p.first in place else p.first
            ]
            ego = p.first if p.first in place else p.second
            assert (p.second == ego) == (times[ego] > begin)
    alone = {pair for pair in in_conflict if pair <= set(times)}
    if not others:
        assert alone == set(decided)


def test_a_human_driver_goes_first_unless_the_cav_is_through_before(junction: Junction) -> None:
    thoughts = junction.thoughts(car("CAV1", "south-north", 82.0, 8.0), car("HDV1", "west-east", 82.0, 8.0))
    problem, _, _ = agree(thoughts)
    begin, end = problem.passages["CAV1"]["HDV1"]
    for time, first in ((begin - 0.1, "CAV1"), (begin + 0.1, "HDV1"), (end + 1.0, "HDV1")):
        _, order, _ = agree(thoughts, {"CAV1": time})
        assert order.first_of("CAV1", "HDV1") == first
        (p,) = order.precedences
        assert "human driver" in p.reason
        assert order.sequence == (first, "HDV1" if first == "CAV1" else "CAV1")


def test_a_driver_who_gives_way_goes_last(junction: Junction) -> None:
    entry = junction.road_map.routes["south-north"].entry
    thoughts = junction.thoughts(car("CAV1", "west-east", 88.0, 8.0), car("HDV1", "south-north", entry - 20.0, 5.0))
    _, order, _ = agree(thoughts)
    assert order.first_of("CAV1", "HDV1") == "CAV1"
    assert "gives way" in order.precedences[0].reason


@pytest.mark.parametrize("binding", [False, True])
def test_it_is_said_whether_the_order_binds(binding: bool, junction: Junction) -> None:
    thoughts = junction.thoughts(car("CAV1", "south-north", 70.0, 8.0), car("CAV2", "west-east", 70.0, 8.0))
    assert agree(thoughts, binding=binding)[1].binding is binding


def test_the_times_decide_between_two_cavs(junction: Junction) -> None:
    thoughts = junction.thoughts(car("CAV1", "south-north", 70.0, 8.0), car("CAV2", "west-east", 70.0, 8.0))
    for times in ({"CAV1": 3.0, "CAV2": 6.0}, {"CAV2": 3.0, "CAV1": 6.0}):
        first, second = times
        _, order, _ = agree(thoughts, times)
        assert order.sequence == (first, second)
        assert [(p.first, p.second) for p in order.precedences] == [(first, second)]


@pytest.mark.parametrize("scenario", ["roundabout", "merge", "highway"])
def test_at_the_start_of_an_episode_in_every_scenario(scenario: str, configured: Callable[..., Environment]) -> None:
    environment = configured(f"scenario={scenario}")
    thoughts = Junction(environment).think(environment.reset(10_000))
    _, order, times = agree(thoughts)
    rank = {name: k for k, name in enumerate(order.sequence)}
    assert all(rank[p.first] < rank[p.second] for p in order.precedences)
    assert set(times) <= set(rank)
