"""What an agreed order rests on, and what is open at all."""

from dataclasses import replace
from itertools import pairwise

import pytest

from codriving.datatypes.order import ApproachingVehicle, Instance
from codriving.reasoning.ordering.premise import Premise, find_circle, open_pairs, premise


def instance(before: frozenset[tuple[str, str]] = frozenset(), **etas: float) -> Instance:
    return Instance(0.0, {name: ApproachingVehicle(name, 0.0, eta) for name, eta in etas.items()}, {}, before)


THEN = premise(instance(A=3.0, B=3.5, C=9.0), [("A", "B"), ("B", "C")])


def later(*pairs: tuple[str, str], **etas: float) -> Premise:
    return premise(instance(**etas), pairs or [("A", "B"), ("B", "C")])


def test_premise_holds_while_nothing_changes() -> None:
    assert THEN.still_holds(THEN)


@pytest.mark.parametrize(
    ("now", "holds"),
    [
        (later(A=2.0, B=2.5, C=8.0), True),
        (later(A=3.0, B=2.1, C=9.0), True),
        (later(A=3.0, B=1.9, C=9.0), False),
        (later(A=1.0, B=8.0, C=9.0), True),
        (later(("A", "B"), A=3.0, B=3.5), True),
        (later(("A", "B"), ("A", "C"), A=3.0, B=3.5, C=9.0), False),
    ],
    ids=["all nearer", "a little earlier", "clearly earlier", "more clearly later", "a pair less", "a new pair"],
)
def test_premise_is_about_open_pairs_and_who_is_earlier(now: Premise, holds: bool) -> None:
    assert THEN.still_holds(now) is holds


def test_premise_is_about_human_drivers_and_who_can_stop() -> None:
    assert not THEN.still_holds(replace(THEN, held=frozenset({"A"})))
    assert not THEN.still_holds(replace(THEN, cannot_stop=frozenset({("B", "A")})))
    # C has left; that it was held up does not matter any more.
    held = replace(THEN, held=frozenset({"C"}))
    assert held.still_holds(later(("A", "B"), A=3.0, B=3.5))


def test_human_drivers_count_only_where_they_hold_a_cav_up() -> None:
    world = instance(A=3.0, B=3.5)
    world.vehicles["A"].windows.append((1.0, 4.0))
    world.vehicles["B"].windows.append((4.0, 9.0))
    assert premise(world, [("A", "B")]).held == {"A"}


def test_pairs_that_are_fixed_even_by_way_of_others_are_not_open() -> None:
    world = instance(frozenset({("A", "B"), ("B", "C")}), A=1.0, B=2.0, C=3.0, D=4.0)
    assert open_pairs(world, [("A", "B"), ("A", "C"), ("C", "A"), ("C", "D")]) == [("C", "D")]


def test_circle_is_found_with_every_vehicle_before_the_next() -> None:
    pairs = {("A", "B"), ("B", "C"), ("C", "A"), ("C", "D")}
    circle = find_circle(pairs)
    assert circle is not None
    assert set(pairwise(circle)) <= pairs
    assert find_circle(pairs - {("B", "C")}) is None


@pytest.mark.parametrize(
    ("etas", "holds"), [((3.0, 2.1), True), ((3.0, 3.9), True), ((3.0, 4.1), False), ((9.0, 2.0), True)]
)
def test_the_later_one_of_a_pair_may_become_the_earlier_one_by_a_second(etas: tuple[float, float], holds: bool) -> None:
    # Of the pair (A, B) B was the earlier one, by half a second.
    then = premise(instance(A=3.0, B=2.5), [("A", "B")])
    assert then.still_holds(premise(instance(A=etas[0], B=etas[1]), [("A", "B")])) is holds


STUCK_A, STUCK_B, STUCK_C = ("A", "B"), ("B", "A"), ("C", "B")
"""A can no longer stop before the zone that it shares with B, and so on."""


@pytest.mark.parametrize(
    ("then", "now", "holds"),
    [
        ({STUCK_A}, {STUCK_A}, True),
        # It counts of either vehicle of a pair, however the pair is named.
        ({STUCK_B}, {STUCK_B}, True),
        ({STUCK_B}, set(), False),
        (set(), {STUCK_B}, False),
        ({STUCK_A}, {STUCK_B}, False),
        # C is through: what it could no longer do does not matter.
        ({STUCK_A, STUCK_C}, {STUCK_A}, True),
        ({STUCK_C}, set(), True),
    ],
)
def test_who_can_no_longer_stop_counts_while_the_pair_is_open(
    then: set[tuple[str, str]], now: set[tuple[str, str]], holds: bool
) -> None:
    before = Premise({("A", "B"): 0.5, ("B", "C"): 5.5}, frozenset(), frozenset(then))
    assert before.still_holds(Premise({("A", "B"): 0.5}, frozenset(), frozenset(now))) is holds
