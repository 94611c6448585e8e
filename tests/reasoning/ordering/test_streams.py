"""Vehicles in streams, and which streams conflict."""

from coalitions import entrant, everybody, instance, problems
from hypothesis import given

from codriving.datatypes.ordering_problem import Instance
from codriving.methods.coop_game.streams import find_streams, is_free


def test_streams_come_as_their_first_vehicles_came() -> None:
    cars = [entrant("a", 4, stream="south"), entrant("b", 1, stream="west"), entrant("c", 2, stream="south")]
    streams = find_streams(instance(*cars, conflicts=[("a", "b")], before=[("c", "a")]), ["b", "c", "a"])
    assert streams.names == ("west", "south")
    assert streams.members == {"west": ("b",), "south": ("c", "a")}
    assert streams.conflicts == {(0, 1)}


def test_whoever_has_no_stream_is_one_of_its_own() -> None:
    streams = find_streams(instance(entrant("a", 1, stream=""), entrant("b", 2, stream="")), ["a", "b"])
    assert streams.names == ("a", "b")
    assert not streams.conflicts


def test_streams_whose_order_is_fixed_do_not_conflict() -> None:
    """One lane, two movements: who drives ahead goes first, whatever the levels."""
    cars = [entrant("a", 1), entrant("b", 2)]
    problem = instance(*cars, before=[("a", "b")])
    assert problem.conflict("a", "b")
    assert not is_free(problem, "a", "b")
    assert not find_streams(problem, ["a", "b"]).conflicts


def test_vehicles_are_ranked_by_level_and_then_as_they_came() -> None:
    cars = [entrant("a", 1, stream="s"), entrant("b", 2, stream="t"), entrant("c", 3, stream="s"), entrant("d", 4)]
    streams = find_streams(instance(*cars, conflicts=everybody("abcd")), ["a", "b", "c", "d"])
    assert streams.names == ("s", "t", "d")
    assert streams.ranked([1, 0, 1], ["a", "b", "c", "d"]) == ["b", "a", "c", "d"]
    assert streams.by_vehicle([1, 0, 2]) == {"a": 1, "c": 1, "b": 0, "d": 2}


@given(problems())
def test_everybody_is_in_one_stream(problem: Instance) -> None:
    streams = find_streams(problem, sorted(problem.entrants))
    assert sorted(name for members in streams.members.values() for name in members) == sorted(problem.entrants)
    for i, j in streams.conflicts:
        pairs = [(a, b) for a in streams.members[streams.names[i]] for b in streams.members[streams.names[j]]]
        assert i < j
        assert any(problem.conflict(a, b) for a, b in pairs)
