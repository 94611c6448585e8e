"""Shapley values: the axioms, and a game worked out by hand."""

from itertools import combinations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from codriving.methods.coop_game_fuzzy.shapley import shapley

Worths = dict[frozenset[str], float]


@st.composite
def games(draw: st.DrawFn) -> tuple[list[str], Worths]:
    players = list("abcdef"[: draw(st.integers(1, 5))])
    coalitions = [frozenset(m) for size in range(1, len(players) + 1) for m in combinations(players, size)]
    return players, {frozenset(): 0.0} | {c: draw(st.floats(-10, 10)) for c in coalitions}


@given(games())
def test_shares_add_up_to_the_worth_of_all(game: tuple[list[str], Worths]) -> None:
    players, worths = game
    assert sum(shapley(players, worths.__getitem__).values()) == pytest.approx(worths[frozenset(players)], abs=1e-9)


@given(games())
def test_who_adds_the_same_gets_the_same(game: tuple[list[str], Worths]) -> None:
    players, worths = game
    if len(players) < 2:
        return
    swap = {players[0]: players[1], players[1]: players[0]}

    def worth(members: frozenset[str]) -> float:
        return worths[members] + worths[frozenset(swap.get(p, p) for p in members)]

    shares = shapley(players, worth)
    assert shares[players[0]] == pytest.approx(shares[players[1]], abs=1e-9)


@given(games(), st.floats(-5, 5))
def test_who_adds_nothing_to_anybody_gets_its_own_worth(game: tuple[list[str], Worths], own: float) -> None:
    players, worths = game

    def worth(members: frozenset[str]) -> float:
        return worths[members - {"dummy"}] + (own if "dummy" in members else 0.0)

    shares = shapley([*players, "dummy"], worth)
    assert shares["dummy"] == pytest.approx(own, abs=1e-9)
    assert shares[players[0]] == pytest.approx(shapley(players, worths.__getitem__)[players[0]], abs=1e-9)


def test_one_left_and_two_right_gloves() -> None:
    """A pair is worth 1: whoever has the left glove, which is scarce, gets two thirds of it."""
    shares = shapley(["left", "right", "other"], lambda c: float("left" in c and len(c) > 1))
    assert shares == pytest.approx({"left": 2 / 3, "right": 1 / 6, "other": 1 / 6})


def test_every_coalition_is_asked_once() -> None:
    asked: list[frozenset[str]] = []
    shapley(list("abcdef"), lambda c: asked.append(c) or 0.0)  # type: ignore[func-returns-value]
    assert len(asked) == len(set(asked)) == 64


def test_too_many_players_are_refused() -> None:
    with pytest.raises(ValueError, match="6 players at most, got 7"):
        shapley(list("abcdefg"), lambda c: 0.0)
