"""What a CAV cannot do of a proposal."""

import pytest
from agreeing import proposal
from worlds import Car, Junction, car

from codriving.protocol.refusal import not_in, refused, with_given, without_circles
from codriving.reasoning.ordering.problem import Problem, pose

FIRST, SECOND = car("CAV1", "south-north", 70.0, 8.0), car("CAV2", "west-east", 72.0, 8.0)


def problem(junction: Junction, *cars: Car) -> Problem:
    """The ordering problem of a world."""
    return pose(junction.thoughts(*cars).moment())


def test_who_is_behind_cannot_go_first(junction: Junction) -> None:
    posed = problem(junction, FIRST, car("CAV2", "south-west", 85.0, 8.0), car("CAV3", "west-east", 40.0, 8.0))
    found = refused(proposal("CAV1 CAV2"), "CAV2", posed)
    assert [(p.first, p.second, p.reason) for p in found] == [
        ("CAV2", "CAV1", "CAV2 drives ahead of CAV1 on the same lane")
    ]
    # That is none of the others' business.
    assert refused(proposal("CAV1 CAV2"), "CAV3", posed) == []


@pytest.mark.parametrize(("known", "says"), [((), 1), (("HDV1",), 0)])
def test_a_human_driver_whom_the_proposal_does_not_know(junction: Junction, known: tuple[str, ...], says: int) -> None:
    # The driver is at the zone together with CAV1, and then CAV1 has to wait.
    posed = problem(junction, FIRST, SECOND, car("HDV1", "east-west", 84.0, 8.0))
    found = refused(proposal("CAV1 CAV2", humans=known), "CAV1", posed)
    assert [(p.first, p.second) for p in found] == [("CAV2", "CAV1")] * says
    assert [p.reason for p in found] == [
        "CAV1 has to let HDV1 pass, a human driver whom the proposal does not know"
    ] * says


def test_a_human_driver_who_comes_much_later_holds_up_nobody(junction: Junction) -> None:
    posed = problem(junction, FIRST, SECOND, car("HDV1", "east-west", 76.0, 0.6))
    assert refused(proposal("CAV1 CAV2"), "CAV1", posed) == []


def test_who_goes_second_is_not_held_up(junction: Junction) -> None:
    posed = problem(junction, FIRST, SECOND, car("HDV1", "east-west", 84.0, 8.0))
    assert refused(proposal("CAV2 CAV1"), "CAV1", posed) == []


def test_given_pairs_are_fixed(junction: Junction) -> None:
    posed = problem(junction, FIRST, SECOND)
    assert with_given(posed, ()) is posed
    assert with_given(posed, {("CAV2", "CAV1"): "so"}).instance.before == {("CAV2", "CAV1")}
    assert posed.instance.before == frozenset()


def test_circles_are_broken_where_it_is_not_dear(junction: Junction) -> None:
    posed = problem(junction, FIRST, SECOND, car("CAV3", "north-south", 40.0, 8.0))
    circle = {("CAV1", "CAV2"): "a", ("CAV2", "CAV3"): "b", ("CAV3", "CAV1"): "c"}
    kept = without_circles(circle, posed.instance, not_in({("CAV1", "CAV2"), ("CAV2", "CAV3")}))
    assert kept.keys() == {("CAV1", "CAV2"), ("CAV2", "CAV3")}
    fixed = with_given(posed, [("CAV2", "CAV1")]).instance
    # What contradicts what is physical is left out whatever it is worth.
    assert without_circles(circle, fixed, not_in(circle)).keys() == {("CAV2", "CAV3"), ("CAV3", "CAV1")}
