"""The page of the paper: which start is a case, and the signs that say whether ours is as the paper says."""

from types import SimpleNamespace
from typing import Any

import pytest

from codriving.pages import paper
from codriving.pages.parting import Parting


def row(*endings: str) -> Any:
    """A row whose seeds 0, 1, ... end so."""
    ended = [SimpleNamespace(record=SimpleNamespace(outcome=SimpleNamespace(ending=_ending(e)))) for e in endings]
    return SimpleNamespace(seeds=dict(enumerate(ended)))


def _ending(name: str) -> Any:
    return SimpleNamespace(value=name)


@pytest.mark.parametrize(
    ("good", "bad", "seed", "differing"),
    [
        (("success", "collision", "success"), ("success", "success", "timeout"), 2, 2),
        (("success", "timeout"), ("success", "collision"), 1, 1),
        (("success", "success", "success"), ("success", "success", "success"), 1, 0),
    ],
    ids=["it ends well in one alone", "it ends otherwise", "the decisions part"],
)
def test_the_start_of_a_case_is_the_first_that_shows_it(
    monkeypatch: pytest.MonkeyPatch, good: tuple[str, ...], bad: tuple[str, ...], seed: int, differing: int
) -> None:
    parted = Parting(2.5, (("CAV1", "FASTER", "SLOWER"),))
    monkeypatch.setattr(paper, "_parted", lambda _one, _other, seed: parted if seed else None)
    case = paper.find_case(row(*good), row(*bad), ("with", "without"))
    assert (case.seed, case.differing, case.starts) == (seed, differing, len(good))
    assert (case.time, case.change) == (2.5, "CAV1: FASTER and SLOWER")


@pytest.mark.parametrize(
    ("low", "high", "theirs", "within", "holds"),
    [
        ("0.50", "1.00", "0.90", True, True),
        ("0.00", "0.15", "0.15", False, False),
        ("0.70", "0.70", "", True, None),
        ("", "", "0.96", None, False),
    ],
)
def test_signs_compare_a_rate_with_bounds_and_with_our_interval(
    low: str, high: str, theirs: str, within: bool | None, holds: bool | None
) -> None:
    cell: Any = SimpleNamespace(success=(0.7, 0.4, 0.95))
    assert paper._within(cell, low, high) is within
    assert paper._holds(cell, theirs) is holds
