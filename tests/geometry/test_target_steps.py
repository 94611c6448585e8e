"""FASTER and SLOWER step from the speed that is driven to the next allowed target; bounds are between no two plans."""

from math import nan

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from codriving.datatypes.world import DrivingModel
from codriving.geometry.target_steps import TargetSteps

MODEL = DrivingModel((2.0, 5.0, 8.0, 11.0), 1.6, 0.1, 0.5, 50.0)
CHANGES = np.array([[1.0, -1.0, 0.0, nan]])
speeds, targets = st.floats(-3.0, 20.0), st.sampled_from(MODEL.target_speeds)


def stepped(speed: float, change: int) -> float:
    """The target after a step, one state at a time."""
    index = min(max(round((speed - 2.0) / 9.0 * 3), 0), 3) + change
    return 2.0 + 3.0 * min(max(index, 0), 3)


@given(st.lists(st.tuples(speeds, targets), min_size=1, max_size=4), st.sampled_from([None, 0.1, 2.0]))
def test_every_state_takes_every_step(states: list[tuple[float, float]], scale: float | None) -> None:
    times = scale or 1.0
    now, kept = (np.repeat(np.array(each)[:, None], 6, axis=1) for each in zip(*states, strict=True))
    steps, goal = TargetSteps(MODEL, CHANGES, len(states), bounds=True), np.empty((len(states), 6))
    assert steps.shape == goal.shape
    steps.apply(0, now, goal, kept * times, now * times, None if scale is None else np.array(scale))
    for (speed, target), found in zip(states, goal.tolist(), strict=True):
        faster, slower = stepped(speed, 1) * times, stepped(speed, -1) * times
        bounds = min(target * times, slower), max(target * times, faster)
        assert found == [faster, slower, target * times, speed * times, *bounds]


def test_paired_states_take_a_step_each() -> None:
    steps, goal = TargetSteps(MODEL, CHANGES, 4, paired=True), np.empty(4)
    now, kept = np.array([5.1, 5.1, 5.1, 5.1]), np.array([8.0, 8.0, 8.0, 8.0])
    steps.apply(0, now, goal, kept, now)
    assert goal.tolist() == [8.0, 2.0, 8.0, 5.1]
