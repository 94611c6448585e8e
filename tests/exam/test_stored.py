"""What is acceptable: on both sides of each threshold."""

import pytest

from codriving.exam.stored import Consequence, PairInQuestion


@pytest.mark.parametrize(
    ("collisions", "near_misses", "loss", "safe", "acceptable"),
    [
        (0, 0, 0.0, True, True),
        (0, 0, 0.5, True, True),
        (0, 0, 0.501, True, False),
        (0, 1, 0.0, True, False),
        (1, 0, 0.0, False, False),
    ],
)
def test_safe_and_acceptable(collisions: int, near_misses: int, loss: float, safe: bool, acceptable: bool) -> None:
    one = Consequence(10, collisions, near_misses, loss)
    assert (one.safe, one.acceptable) == (safe, acceptable)


def test_a_pair_has_a_consequence_a_way() -> None:
    one, other = Consequence(10, 0, 0, 0.0), Consequence(10, 0, 0, 2.0)
    pair = PairInQuestion("a", "b", "b", one, other)
    assert pair.consequence("a") is one
    assert pair.consequence("b") is other
