"""A plan that takes back what was begun is worth less, by a metre at once and by half of that later."""

import pytest

from codriving.datatypes.world import Action
from codriving.reasoning.prediction.reversals import price, reverses

SLOWER, IDLE, FASTER, HOLD = Action.SLOWER, Action.IDLE, Action.FASTER, Action.HOLD


@pytest.mark.parametrize(
    ("plan", "metres"),
    [
        ((FASTER,), 0.0),
        ((HOLD, IDLE, FASTER), 0.0),
        ((SLOWER, SLOWER, FASTER), 1.0),
        ((FASTER, SLOWER, FASTER), 2.0),
        ((SLOWER, HOLD, FASTER), 0.5),
        ((FASTER, SLOWER, IDLE, HOLD, FASTER), 1.5),
    ],
)
def test_reversals_within_a_plan(plan: tuple[Action, ...], metres: float) -> None:
    assert price(6.0, 6.0, (plan,)).tolist() == [metres]


@pytest.mark.parametrize(
    ("speed", "target", "action", "back"),
    [
        (6.0, 9.0, SLOWER, True),
        (6.0, 9.0, FASTER, False),
        (6.0, 3.0, FASTER, True),
        (6.0, 3.0, SLOWER, False),
        (6.0, 3.0, HOLD, False),
        (6.0, 9.0, IDLE, False),
        (6.0, 6.29, SLOWER, False),
        (6.0, 6.31, SLOWER, True),
        (6.0, 5.69, FASTER, True),
        (6.0, 5.71, FASTER, False),
    ],
)
def test_the_target_tells_what_a_vehicle_is_doing(speed: float, target: float, action: Action, back: bool) -> None:
    assert reverses(action, speed, target) is back
    assert price(speed, target, ((action,), (IDLE,))).tolist() == [1.0 if back else 0.0, 0.0]
