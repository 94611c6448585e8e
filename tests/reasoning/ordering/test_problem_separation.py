"""What must lie between two vehicles in a zone."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from worlds import Junction, car

from codriving.environment.environment import Environment
from codriving.geometry.zone import Band
from codriving.reasoning.ordering.problem import lag_length, pose


def test_lag_length_is_enough_room_anywhere_in_the_zone(junction: Junction) -> None:
    for zone in junction.road_map.zones("south-north", "west-north"):
        needed = lag_length(zone)
        for k in range(60):
            s = zone.entry_j + k * (zone.exit_j - zone.entry_j) / 60
            assert float(zone.front(s)) <= s + needed + 0.5


def test_lag_length_of_either_vehicle_is_that_of_the_mirrored_zone(junction: Junction) -> None:
    for zone in junction.road_map.zones("south-north", "west-north"):
        assert lag_length(zone, False) == lag_length(zone.mirrored())


def test_ways_that_block_each_other_nowhere_need_no_room(junction: Junction) -> None:
    zone = junction.road_map.zones("south-north", "west-east")[0]
    nowhere = Band(zone.entry_j, 0.5, np.array([]), np.array([]))
    assert (lag_length(replace(zone, over_j=nowhere)), lag_length(replace(zone, over_i=nowhere), False)) == (0.0, 0.0)


@pytest.mark.parametrize(
    ("limits", "other", "first", "second"),
    [
        # CAV1 goes straight on at 9 m/s, first or second; without limits CAV2 turns as fast as that, too.
        ("none", "west-north", 1.88, 1.62),
        ("road", "west-north", 1.88, 1.90),
        ("none", "north-east", 2.58, 2.54),
        ("road", "north-east", 2.58, 3.22),
    ],
)
def test_behind_one_that_turns_slowly_more_time_is_needed(
    limits: str, other: str, first: float, second: float, configured: Callable[..., Environment]
) -> None:
    junction = Junction(configured("scenario=intersection", f"limits={limits}"))
    cars = car("CAV1", "south-north", 60.0, 8.0), car("CAV2", other, 62.0, 8.0)
    separation = pose(junction.thoughts(*cars).moment()).instance.separation
    assert separation == {
        ("CAV1", "CAV2"): pytest.approx(first, abs=0.005),
        ("CAV2", "CAV1"): pytest.approx(second, abs=0.005),
    }
