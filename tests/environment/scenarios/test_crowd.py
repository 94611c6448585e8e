"""Who drives: ranges, room on the lanes, and draws that depend on nothing but the generator."""

import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from codriving.errors import ConfigError, ScenarioError
from codriving.scenarios import Crowd, Kind

CROWD = Crowd(4, (2, 4), (20.0, 75.0), (5.0, 9.0), (6.0, 8.0), 10.0)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"cavs": 1}, "cavs must be 2 to 6, got 1"),
        ({"cavs": 7}, "cavs must be 2 to 6, got 7"),
        ({"hdvs": (4, 9)}, "hdvs must be [smallest, largest] within 0 to 8, got [4, 9]"),
        (
            {"start": (20.0, 86.0)},
            "start must be [smallest, largest] within 0 to 85 m (before it), got [20, 86]",
        ),
        ({"cav_speed": (5.0, 11.0)}, "cav_speed must be [smallest, largest] within 0 to 10 m/s, got [5, 11]"),
        ({"hdv_speed": (0.5, 8.0)}, "hdv_speed must be [smallest, largest] within 1 to 10 m/s, got [0.5, 8]"),
        ({"spacing": 5.0}, "spacing must be 6 to 200 m, got 5"),
    ],
)
def test_settings_out_of_range_are_refused(change: dict[str, Any], message: str) -> None:
    with pytest.raises(ConfigError, match=re.escape(message)):
        replace(CROWD, **change).check(6, 8, 85, "before it", 10)


def test_ends_of_the_ranges_are_in_them() -> None:
    CROWD.check(4, 4, 75, "", 9)


def test_room_counts_cars_with_a_gap_to_brake_in() -> None:
    assert CROWD.room == 6, "55 m, and 5 m of car with a gap of 6 m"
    CROWD.require_room(2, "2 legs")
    CROWD.require_room(1, "the ramp", cavs=2)
    message = (
        "4 CAVs and up to 4 HDVs cannot start within 20 to 75 m along 1 leg, where 6 vehicles have 10 m and a braking "
        "gap between them at most; use fewer vehicles or a longer start interval"
    )
    with pytest.raises(ScenarioError, match=re.escape(message)):
        CROWD.require_room(1, "1 leg")


def test_draws_stay_within_the_intervals() -> None:
    rng = np.random.default_rng(0)
    for kind, low, high in ((Kind.CAV, 5.0, 9.0), (Kind.HDV, 6.0, 8.0)):
        starts = [CROWD.start_on(rng, "A", kind, "r") for _ in range(200)]
        speeds, places = [start.speed for start in starts], [start.position for start in starts]
        assert low <= min(speeds) < low + 0.2 < high - 0.2 < max(speeds) <= high
        assert 20.0 <= min(places) < 22.0 < 73.0 < max(places) <= 75.0
    elsewhere = [CROWD.start_on(rng, "A", Kind.HDV, "r", (100.0, 110.0)).position for _ in range(50)]
    assert min(elsewhere) >= 100.0
    assert max(elsewhere) <= 110.0
