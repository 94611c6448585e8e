"""Where a model has something to judge, and where not, each bound on both sides."""

from dataclasses import replace

import pytest
from asked import reasoned, sensible
from worlds import Junction, car

from codriving.briefing.judging import nothing_to_judge
from codriving.datatypes.situation import LaneChange, Situation
from codriving.datatypes.world import Action

CARS = (car("CAV1", "south-north", 80, 8, 9), car("CAV2", "west-east", 82, 8, 9), car("HDV1", "east-south", 76, 8))


@pytest.fixture(scope="module")
def met(junction: Junction) -> tuple[Situation, Situation]:
    """What CAV1 is told in conflict with a human driver, and what it is told with a CAV alone."""
    found = [reasoned(junction, sensible).method.act(junction.world(*cars)) for cars in (CARS[::2], CARS[:2])]
    return found[0].situations[0], found[1].situations[0]


def gaining(situation: Situation, *gains: float | None) -> Situation:
    """The same with other gains; the actions left over are removed."""
    known = (*gains, *[-1.0] * len(situation.assessments))
    pairs = zip(situation.assessments, known, strict=False)
    return replace(situation, assessments=tuple(replace(a, safe=gain != -1.0, progress=gain) for a, gain in pairs))


def test_one_action_leaves_no_choice(met: tuple[Situation, Situation]) -> None:
    assert nothing_to_judge(gaining(met[0], 40.0))
    assert not nothing_to_judge(gaining(met[0], 40.0, 40.0))


def test_actions_are_alike_within_three_metres(met: tuple[Situation, Situation]) -> None:
    assert nothing_to_judge(gaining(met[1], 40.0, 42.9))
    assert not nothing_to_judge(gaining(met[1], 40.0, 43.0))
    assert not nothing_to_judge(gaining(met[1], 40.0, None)), "with one of them the order cannot be kept"


def test_a_human_driver_ahead_is_to_be_judged(met: tuple[Situation, Situation]) -> None:
    assert not nothing_to_judge(gaining(met[0], 40.0, 40.0))


def test_zones_that_were_entered_are_past(met: tuple[Situation, Situation]) -> None:
    inside = [replace(c, distances=(0.0, c.distances[1])) for c in met[0].conflicts]
    assert nothing_to_judge(replace(gaining(met[0], 40.0, 60.0), conflicts=tuple(inside)))


def test_a_lane_change_that_the_route_needs_is_to_be_judged(met: tuple[Situation, Situation]) -> None:
    change = LaneChange(("a", "b", 1), 50.0, Action.LANE_RIGHT)
    needs = replace(met[1], scene=replace(met[1].scene, must_change=change))
    assert not nothing_to_judge(gaining(needs, 40.0, 40.0))
    assert nothing_to_judge(gaining(needs, 40.0))
