"""What is taken in the place of an action that the safety check removes."""

import pytest

from codriving.datatypes.situation import ActionAssessment
from codriving.datatypes.world import Action
from codriving.reasoning.safety.nearest import nearest

NAMES = {"S": "SLOWER", "I": "IDLE", "H": "HOLD", "F": "FASTER", "L": "LANE_LEFT", "R": "LANE_RIGHT"}

# The CAV drives at 6 m/s: SLOWER sets 3 m/s, HOLD 6, FASTER 9, and IDLE keeps the target.
# What is wanted, the target, what is allowed, and what is taken; of several the least dangerous.
TABLE = [
    ("F", 6, "SIHF", "F"),
    ("L", 6, "SIHFL", "L"),
    ("F", 9, "SIH", "I"),  # IDLE accelerates, too
    ("F", 6, "SIH", "I"),  # Nothing else accelerates: the nearest slower one; HOLD is as near
    ("F", 3, "SIH", "H"),  # IDLE slows down by more
    ("F", 3, "SI", "I"),
    ("F", 6, "S", "S"),
    ("I", 6, "SHF", "H"),  # Both keep the speed
    ("I", 9, "SHF", "F"),  # Both accelerate
    ("I", 3, "SHF", "S"),  # Both slow down
    ("I", 3, "HF", "HF"),  # All that is left is faster
    ("H", 6, "SF", "S"),
    ("S", 3, "IHF", "I"),
    ("S", 6, "IHF", "IHF"),
    ("S", 6, "F", "F"),
    ("S", 6, "FHL", "HF"),  # Nor is a lane changed to slow down
    ("L", 6, "SIHF", "I"),  # A lane change keeps the speed
    ("L", 9, "SHF", "F"),
    ("L", 6, "SR", "S"),  # No other lane change takes its place
    ("L", 6, "R", "R"),
    ("S", 6, "LR", "LR"),
]


@pytest.mark.parametrize(("wanted", "target", "allowed", "taken"), TABLE)
def test_the_nearest_allowed_action(wanted: str, target: float, allowed: str, taken: str) -> None:
    sets = {"S": 3.0, "I": target, "H": 6.0, "F": 9.0, "L": None, "R": None}
    assessments = [ActionAssessment(Action(NAMES[a]), a in allowed, (), (), None, to) for a, to in sets.items()]
    assert nearest(Action(NAMES[wanted]), assessments, 6.0, target) == tuple(Action(NAMES[a]) for a in taken)


def test_a_speed_that_is_all_but_kept_is_kept() -> None:
    sets = {Action.SLOWER: 3.0, Action.IDLE: 6.0, Action.FASTER: 9.0}
    assessments = [ActionAssessment(action, action is not Action.IDLE, (), (), None, to) for action, to in sets.items()]
    assert nearest(Action.IDLE, assessments, 5.995, 6.0) == (Action.SLOWER,)
    assert nearest(Action.IDLE, assessments, 5.985, 6.0) == (Action.FASTER,)
