"""Reasons without the times that rot."""

import pytest

from codriving.llm.prompts.told import timeless


@pytest.mark.parametrize(
    ("reason", "told"),
    [
        ("CAV1 can be there earlier (3.1 s against 4.2 s)", "CAV1 can be there earlier"),
        ("a human driver may use the zone until 6.3 s from now", "a human driver may use the zone"),
        ("CAV1 arrives in 3.2 s, earlier than CAV3 at 4.0 seconds", "CAV1 arrives, earlier than CAV3"),
        ("the CAV is through (-0.3 s) before it can be there", "the CAV is through before it can be there"),
        ("CAV2 (a truck) drives 8 m/s and cannot stop", "CAV2 (a truck) drives 8 m/s and cannot stop"),
        ("own estimate: 3.1 s against 4.0 s for CAV2", "own estimate: 3.1 s against 4.0 s for CAV2"),
        ("", ""),
    ],
)
def test_times_are_left_out(reason: str, told: str) -> None:
    assert timeless(reason) == told
