"""Precedences without circles."""

from graphlib import TopologicalSorter

from hypothesis import given
from hypothesis import strategies as st

from codriving.datatypes.order import Precedence
from codriving.reasoning.ordering.coordinator import without_cycles

NAMES = "abcdef"
TIMES = st.fixed_dictionaries({name: st.floats(0.0, 20.0) for name in NAMES})
PAIRS = st.lists(
    st.tuples(st.sampled_from(NAMES), st.sampled_from(NAMES)).filter(lambda pair: pair[0] != pair[1]),
    unique_by=frozenset,
    max_size=12,
)


def links(*pairs: tuple[str, str]) -> list[Precedence]:
    return [Precedence(first, second, "told so") for first, second in pairs]


@given(PAIRS, TIMES)
def test_no_circle_is_left_and_the_sequence_keeps_what_is(
    pairs: list[tuple[str, str]], times: dict[str, float]
) -> None:
    kept, sequence = without_cycles(links(*pairs), times)
    assert set(kept) <= set(links(*pairs))
    assert sorted(sequence) == sorted(times)
    assert all(sequence.index(p.first) < sequence.index(p.second) for p in kept)


@given(PAIRS, TIMES)
def test_what_has_no_circles_is_kept_as_it_is(pairs: list[tuple[str, str]], times: dict[str, float]) -> None:
    straight = links(*[(min(pair), max(pair)) for pair in pairs])
    kept, sequence = without_cycles(straight, times)
    assert list(kept) == straight
    graph = {p.second: {q.first for q in straight if q.second == p.second} for p in straight}
    assert set(TopologicalSorter(graph).static_order()) <= set(sequence)


def test_the_link_that_the_times_contradict_most_is_dropped() -> None:
    times = {"a": 1.0, "b": 2.0, "c": 9.0}
    kept, sequence = without_cycles(links(("a", "b"), ("b", "c"), ("c", "a")), times)
    assert [(p.first, p.second) for p in kept] == [("a", "b"), ("b", "c")]
    assert sequence == ("a", "b", "c")


def test_times_settle_what_the_pairs_leave_open() -> None:
    assert without_cycles([], {"a": 3.0, "b": 1.0, "c": 2.0}) == ((), ("b", "c", "a"))
