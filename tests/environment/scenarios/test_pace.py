"""Time, speeds and perception: what is refused, and that the message says why."""

import math
import re
from typing import Any

import pytest

from codriving.environment.scenarios.pace import Pace
from codriving.errors import ConfigError, require_interval, require_range

GOOD: dict[str, Any] = {
    "simulation_frequency": 10.0,
    "decision_frequency": 2.0,
    "time_limit": 50.0,
    "target_speeds": (0.0, 3.0, 6.0, 9.0),
    "detection_range": 50.0,
}


def test_good_settings_are_taken() -> None:
    assert Pace(**GOOD).target_speeds == (0.0, 3.0, 6.0, 9.0)


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("simulation_frequency", 4.0, "simulation_frequency must be 5 to 50 Hz, got 4"),
        (
            "simulation_frequency",
            11.0,
            "simulation_frequency must be a multiple of decision_frequency (2 Hz), got 11 Hz",
        ),
        ("simulation_frequency", math.nan, "simulation_frequency must be 5 to 50 Hz, got nan"),
        ("decision_frequency", 10.0, "decision_frequency must be 0.5 to 5 Hz, got 10"),
        ("time_limit", 0.0, "time_limit must be 1 to 600 s, got 0"),
        ("detection_range", 1.0, "detection_range must be 5 to 500 m, got 1"),
        ("target_speeds", (0.0, 3.0, 7.0), "evenly spaced"),
        ("target_speeds", (6.0, 3.0, 0.0), "rising"),
        ("target_speeds", (5.0,), "two or more"),
        ("target_speeds", (-3.0, 0.0, 3.0), "0 to 40 m/s"),
        ("target_speeds", (0.0, 30.0, 60.0), "0 to 40 m/s"),
        ("target_speeds", (0.0, 3.0, math.nan), "got [0.0, 3.0, nan]"),
    ],
)
def test_bad_settings_are_refused(key: str, value: object, message: str) -> None:
    with pytest.raises(ConfigError, match=re.escape(message)):
        Pace(**{**GOOD, key: value})


@pytest.mark.parametrize("value", [(9.0, 5.0), (-1.0, 5.0), (5.0, 11.0), (math.nan, 5.0), (5.0,), (1.0, 2.0, 3.0)])
def test_bad_intervals_are_refused(value: Any) -> None:
    with pytest.raises(ConfigError, match=r"speed must be \[smallest, largest\] within 0 to 10 m/s, got \["):
        require_interval("speed", value, 0, 10, " m/s")


def test_ends_of_a_range_are_in_it() -> None:
    require_range("x", 1, 1, 2)
    require_range("x", 2, 1, 2)
    require_interval("x", (1, 1), 1, 1)
