"""What controls take of what is allowed, and what tells what is drawn."""

from collections import Counter
from dataclasses import replace

import pytest
from worlds import Junction, car

from codriving.datatypes.order import PassingOrder
from codriving.datatypes.situation import ActionAssessment, LaneChange, Situation
from codriving.datatypes.world import Action
from codriving.reasoning.decision.control_deciders import FastestDecider, RandomDecider

LETTERS = {"S": "SLOWER", "I": "IDLE", "H": "HOLD", "F": "FASTER", "L": "LANE_LEFT", "R": "LANE_RIGHT"}


def told(junction: Junction, allowed: str, ego: str = "CAV1", target: float = 6.0, must: str = "") -> Situation:
    """What a CAV is told at 6 m/s; of the six actions those of the letters are allowed."""
    scene = junction.thoughts(car(ego, "south-north", 60.0, 6.0, target)).scenes[ego]
    if must:
        scene = replace(scene, must_change=LaneChange(("a", "b", 0), 50.0, Action(LETTERS[must])))
    made = tuple(
        ActionAssessment(Action(name), letter in allowed, () if letter in allowed else ("same lane: no",), (), None)
        for letter, name in LETTERS.items()
    )
    return Situation(scene, (), PassingOrder((), ()), (), made)


@pytest.mark.parametrize(
    ("allowed", "target", "must", "taken"),
    [
        ("SIHFLR", 6.0, "", "F"),
        ("SIH", 6.0, "", "I"),  # As fast as HOLD
        ("SIH", 9.0, "", "I"),  # It accelerates, so HOLD is slower
        ("SIH", 3.0, "", "H"),  # It slows down, so HOLD is faster
        ("SH", 9.0, "", "H"),
        ("SLR", 6.0, "", "S"),  # Lanes are not changed to be faster
        ("R", 6.0, "", "R"),
        ("SIHFLR", 6.0, "R", "R"),
        ("SIHFL", 6.0, "R", "F"),  # The change that the route asks for is not allowed
    ],
)
def test_fastest_of_what_is_allowed(allowed: str, target: float, must: str, taken: str, junction: Junction) -> None:
    (decision,) = FastestDecider().decide([told(junction, allowed, target=target, must=must)])
    assert (decision.ego, decision.action) == ("CAV1", LETTERS[taken])


def begun(seed: int) -> RandomDecider:
    """Return the decider at the beginning of an episode."""
    decider = RandomDecider()
    decider.reset(seed)
    return decider


def test_each_allowed_action_is_drawn_as_often(junction: Junction) -> None:
    situation, decider = told(junction, "SFL"), begun(7)
    found = Counter(decider.decide([situation])[0].action for _ in range(600))
    assert set(found) == {"SLOWER", "FASTER", "LANE_LEFT"}
    assert min(found.values()) >= 160


def test_what_is_drawn_for_a_cav_does_not_depend_on_the_others(junction: Junction) -> None:
    one, other, third = (told(junction, "SIHF", name) for name in ("CAV1", "CAV2", "CAV3"))
    plain, turned, differs = begun(7), begun(7), begun(8)
    drawn, again, others = [], [], []
    for _ in range(20):
        drawn.append([d.action for d in plain.decide([one, other])])
        again.append([d.action for d in turned.decide([third, other, one])][:0:-1])
        others.append([d.action for d in differs.decide([one, other])])
    assert drawn == again
    assert drawn != others
    assert [a for a, _ in drawn] != [b for _, b in drawn], "each CAV has draws of its own"
    plain.reset(7)
    assert [plain.decide([one, other])[0].action for _ in range(20)] == [a for a, _ in drawn], "an episode begins anew"
