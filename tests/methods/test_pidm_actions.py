"""A wished acceleration becomes an action."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from worlds import Junction

from codriving.datatypes.world import Action
from codriving.methods.pidm import closest_action, mean_accelerations

MEANS = (-1.5, 0.0, 1.5)


@pytest.mark.parametrize(
    ("wished", "action"),
    [
        (2.0, Action.FASTER),
        (0.8, Action.FASTER),
        (0.7, Action.IDLE),
        (0.0, Action.IDLE),
        (-0.7, Action.IDLE),
        (-0.8, Action.SLOWER),
        (-2.0, Action.SLOWER),
        (-8.0, Action.SLOWER),
    ],
)
def test_the_closest_action_is_taken(wished: float, action: Action) -> None:
    assert closest_action(wished, MEANS, 2.0) is action


def test_who_brakes_hard_slows_down_even_if_another_action_brakes_as_well() -> None:
    assert closest_action(-2.5, (-1.0, -2.5, -0.5), 2.0) is Action.SLOWER
    assert closest_action(-1.9, (-1.0, -1.9, -0.5), 2.0) is Action.IDLE


@given(st.floats(0.0, 5.0), st.tuples(*[st.floats(-5.0, 5.0)] * 3))
def test_who_wants_to_accelerate_never_slows_down(wished: float, means: tuple[float, float, float]) -> None:
    assert closest_action(wished, means, 2.0) is not Action.SLOWER


def test_means_are_those_of_the_vehicle_model(junction: Junction) -> None:
    forecast = junction.forecast()
    slower, idle, faster = mean_accelerations(forecast, 6.0, 6.0, ("", 0.0), 2.0)
    assert (slower, idle, faster) == pytest.approx((-1.5, 0.0, 1.5), abs=0.05)
    assert mean_accelerations(forecast, 0.0, 0.0, ("", 0.0), 2.0)[0] == 0.0
    assert mean_accelerations(forecast, 3.0, 6.0, ("", 0.0), 2.0)[1] == pytest.approx(1.5, abs=0.05), (
        "IDLE goes on to the target"
    )
