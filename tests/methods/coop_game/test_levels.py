"""Every allocation of levels that makes a difference, each once."""

from itertools import combinations, permutations, product

import pytest
from coalitions import everybody, instance, problems, vehicle
from hypothesis import given
from hypothesis import strategies as st

from codriving.datatypes.order import Instance
from codriving.methods.coop_game.levels import FewLevels, OwnLevels, find_streams, is_free, layered, levels_of

Graph = tuple[int, list[tuple[int, int]]]


def complete(n: int) -> list[tuple[int, int]]:
    return list(combinations(range(n), 2))


def relation(levels: tuple[int, ...], edges: list[tuple[int, int]]) -> tuple[int, ...]:
    return tuple((levels[i] > levels[j]) - (levels[i] < levels[j]) for i, j in edges)


@st.composite
def graphs(draw: st.DrawFn) -> Graph:
    n = draw(st.integers(1, 5))
    return n, [edge for edge in complete(n) if draw(st.booleans())]


@pytest.mark.parametrize(("streams", "count"), [(1, 1), (2, 2), (3, 6), (4, 24), (5, 120)])
def test_streams_that_all_conflict_have_every_strict_order(streams: int, count: int) -> None:
    found = list(OwnLevels(streams, complete(streams)).allocations())
    assert sorted(found) == sorted(permutations(range(streams)))
    assert len(found) == count


def test_first_allocation_is_that_by_index() -> None:
    assert next(OwnLevels(4, complete(4)).allocations()) == (0, 1, 2, 3)


@pytest.mark.parametrize(
    ("edges", "count"),
    [
        ([], 1),
        ([(0, 1)], 2),
        ([(0, 1), (2, 3)], 4),
        ([(0, 1), (1, 2), (2, 3)], 8),
        ([(0, 1), (1, 2), (2, 3), (0, 3)], 14),
    ],
)
def test_streams_without_conflict_add_no_allocation(edges: list[tuple[int, int]], count: int) -> None:
    assert len(list(OwnLevels(4, edges).allocations())) == count


@given(graphs())
def test_own_levels_are_all_strict_relations_and_each_once(graph: Graph) -> None:
    n, edges = graph
    found = [relation(levels, edges) for levels in OwnLevels(n, edges).allocations()]
    wanted = {relation(levels, edges) for levels in permutations(range(n))}
    assert len(found) == len(wanted)
    assert set(found) == wanted


@given(graphs(), st.integers(1, 2))
def test_few_levels_are_all_relations_and_each_once(graph: Graph, highest: int) -> None:
    n, edges = graph
    levels = list(FewLevels(n, edges, highest).allocations())
    found = [relation(one, edges) for one in levels]
    assert len(found) == len(set(found))
    assert set(found) == {relation(one, edges) for one in product(range(highest + 1), repeat=n)}
    assert all(max(one) <= highest for one in levels)


@given(graphs(), st.data())
def test_levels_are_the_least_that_keep_the_ranks(graph: Graph, data: st.DataObject) -> None:
    n, edges = graph
    ranks = data.draw(st.permutations(range(n)))
    levels = layered(ranks, edges)
    assert all((levels[i] < levels[j]) == (ranks[i] < ranks[j]) for i, j in edges)
    for k, level in enumerate(levels):
        below = [levels[i + j - k] for i, j in edges if k in (i, j) and levels[i + j - k] < level]
        assert level == (max(below) + 1 if below else 0)


@given(graphs(), st.data())
def test_a_stream_can_be_moved_to_any_place(graph: Graph, data: st.DataObject) -> None:
    n, edges = graph
    start = layered(data.draw(st.permutations(range(n))), edges)
    stream = data.draw(st.integers(0, n - 1))
    mine = [edge for edge in edges if stream in edge]
    rest = [edge for edge in edges if stream not in edge]
    moved = list(OwnLevels(n, edges).moves(start, stream))
    assert start in moved
    assert all(relation(levels, rest) == relation(start, rest) for levels in moved)
    assert {relation(levels, mine) for levels in moved} >= {tuple(-1 if stream == i else 1 for i, _ in mine)}
    assert {relation(levels, mine) for levels in moved} >= {tuple(1 if stream == i else -1 for i, _ in mine)}


def test_moves_of_few_levels_change_one_level() -> None:
    assert list(FewLevels(3, complete(3), 1).moves((0, 1, 0), 2)) == [(0, 1, 0), (0, 1, 1)]


@pytest.mark.parametrize(("streams", "highest", "kind"), [(4, None, OwnLevels), (4, 3, OwnLevels), (4, 2, FewLevels)])
def test_levels_are_bounded_only_if_that_is_less_than_one_each(streams: int, highest: int | None, kind: type) -> None:
    assert isinstance(levels_of(streams, complete(streams), highest), kind)


def test_with_three_levels_two_of_four_streams_share_one() -> None:
    """The strawman of the source's highest level 2: it is there only for those who ask for it."""
    few = list(levels_of(4, complete(4), 2).allocations())
    own = list(levels_of(4, complete(4), None).allocations())
    assert len(few) == 51
    assert all(len(set(levels)) < 4 for levels in few)
    assert all(len(set(levels)) == 4 for levels in own)


def test_ranks_become_levels_as_far_as_there_are_some() -> None:
    assert OwnLevels(4, complete(4)).of([3, 1, 0, 2]) == (3, 1, 0, 2)
    assert FewLevels(4, complete(4), 2).of([3, 1, 0, 2]) == (2, 1, 0, 2)


def test_streams_come_as_their_first_vehicles_came() -> None:
    cars = [vehicle("a", 4, stream="south"), vehicle("b", 1, stream="west"), vehicle("c", 2, stream="south")]
    streams = find_streams(instance(*cars, conflicts=[("a", "b")], before=[("c", "a")]), ["b", "c", "a"])
    assert streams.names == ("west", "south")
    assert streams.members == {"west": ("b",), "south": ("c", "a")}
    assert streams.conflicts == {(0, 1)}


def test_a_vehicle_that_has_no_stream_is_one_of_its_own() -> None:
    streams = find_streams(instance(vehicle("a", 1, stream=""), vehicle("b", 2, stream="")), ["a", "b"])
    assert streams.names == ("a", "b")
    assert not streams.conflicts


def test_streams_whose_order_is_fixed_do_not_conflict() -> None:
    """One lane, two movements: who drives ahead goes first, whatever the levels."""
    cars = [vehicle("a", 1), vehicle("b", 2)]
    problem = instance(*cars, before=[("a", "b")])
    assert problem.conflict("a", "b")
    assert not is_free(problem, "a", "b")
    assert not find_streams(problem, ["a", "b"]).conflicts


def test_vehicles_are_ranked_by_level_and_then_as_they_came() -> None:
    cars = [vehicle("a", 1, stream="s"), vehicle("b", 2, stream="t"), vehicle("c", 3, stream="s"), vehicle("d", 4)]
    streams = find_streams(instance(*cars, conflicts=everybody("abcd")), ["a", "b", "c", "d"])
    assert streams.names == ("s", "t", "d")
    assert streams.ranked([1, 0, 1], ["a", "b", "c", "d"]) == ["b", "a", "c", "d"]
    assert streams.by_vehicle([1, 0, 2]) == {"a": 1, "c": 1, "b": 0, "d": 2}


@given(problems())
def test_every_vehicle_is_in_one_stream(problem: Instance) -> None:
    streams = find_streams(problem, sorted(problem.vehicles))
    assert sorted(name for members in streams.members.values() for name in members) == sorted(problem.vehicles)
    for i, j in streams.conflicts:
        pairs = [(a, b) for a in streams.members[streams.names[i]] for b in streams.members[streams.names[j]]]
        assert i < j
        assert any(problem.conflict(a, b) for a, b in pairs)
