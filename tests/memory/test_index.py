"""The index: exact, ties by age, and clear about what it cannot take."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from remembered import noise

from codriving.memory.index import Index


def index(vectors: np.ndarray, first: int = 1) -> Index:
    made = Index(vectors.shape[1])
    made.add(range(first, first + len(vectors)), vectors)
    return made


@settings(deadline=None, max_examples=25)
@given(st.integers(0, 1000), st.integers(1, 60), st.integers(1, 70))
def test_it_finds_what_a_full_search_finds(seed: int, n: int, k: int) -> None:
    vectors, query = noise(seed, n), noise(seed + 1, 1)
    (hits,) = index(vectors).search(query, k)
    scores = np.round(vectors.astype(np.float64) @ query[0].astype(np.float64), 5)
    assert len(hits) == min(k, n)
    assert [round(score, 5) for _, score in hits] == pytest.approx(sorted(scores, reverse=True)[:k], abs=2e-5)


@pytest.mark.parametrize("copies", [2, 9, 40])
def test_of_equals_the_oldest_comes_first_however_many_there_are(copies: int) -> None:
    one, rest = noise(0, 1), noise(1, 20)
    vectors = np.concatenate([rest[:10], np.repeat(one, copies, axis=0), rest[10:]])
    (hits,) = index(vectors).search(one, 3)
    assert [number for number, _ in hits] == [11, 12, 13][: min(3, copies)] + ([hits[2][0]] if copies == 2 else [])


def test_the_order_of_adding_makes_no_difference() -> None:
    vectors, query = noise(3, 30), noise(4, 1)
    whole, parts = index(vectors), Index(8)
    for k in range(0, 30, 7):
        parts.add(range(k + 1, min(k + 7, 30) + 1), vectors[k : k + 7])
    assert whole.search(query, 5) == parts.search(query, 5)


def test_nothing_is_found_where_nothing_is() -> None:
    assert Index(8).search(noise(0, 2), 3) == [[], []]
    assert index(noise(0, 3)).search(noise(1, 1), 0) == [[]]
    assert index(noise(0, 3)).search(noise(1, 1)[:0], 3) == []


@pytest.mark.parametrize("wrong", [noise(0, 2, 7), noise(0, 3, 8)])
def test_vectors_of_another_shape_are_refused(wrong: np.ndarray) -> None:
    with pytest.raises(ValueError, match=r"vectors must be \(2, 8\)"):
        Index(8).add([1, 2], wrong)


def test_what_is_no_number_is_refused() -> None:
    broken = noise(0, 2)
    broken[1, 3] = np.nan
    with pytest.raises(ValueError, match="not finite"):
        Index(8).add([1, 2], broken)
    with pytest.raises(ValueError, match="not finite"):
        index(noise(0, 2)).search(broken, 1)
    with pytest.raises(ValueError, match=r"queries must be \(n, 8\)"):
        index(noise(0, 2)).search(noise(0, 1, 9), 1)
