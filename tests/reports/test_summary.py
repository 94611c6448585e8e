"""summary.csv: rates over what was completed, quality over what succeeded."""

from collections.abc import Callable

import pytest

from codriving.datatypes.record import Ending, EpisodeRecord
from tests.reports.making import summary_of, summary_row


def test_the_columns_are_those_of_the_product_in_their_order(make: Callable[..., EpisodeRecord]) -> None:
    expected = (
        "scenario, method, variant, reasoner, episodes, completed, success_rate, success_low, success_high, "
        "collision_rate, timeout_rate, error_rate, pet_mean, pet_max, pet_min, pet_below_1_5, velocity_mean, "
        "velocity_max, velocity_min"
    )
    assert list(summary_of([make(0)]).keys)[:19] == expected.split(", ")


def test_swept_keys_follow_the_columns_that_users_rely_on(make: Callable[..., EpisodeRecord]) -> None:
    swept = {"scenario.cavs": "4", "metrics": "authors"}
    columns = summary_of([make(0, counts={"fallbacks": 1, "metrics": 2})], swept).keys
    assert columns[18] == "velocity_min"
    assert columns[19:21] == ("scenario.cavs", "metrics")
    assert columns[-1] == "fallbacks"
    row = summary_row([make(0)], swept)
    assert (row["scenario.cavs"], row["metrics"], row["scenario"]) == ("4", "authors", "intersection")


def test_errors_are_not_driving(make: Callable[..., EpisodeRecord]) -> None:
    endings = [Ending.SUCCESS] * 3 + [Ending.COLLISION, Ending.TIMEOUT, Ending.OFF_ROAD] + [Ending.ERROR] * 2
    row = summary_row([make(seed, ending) for seed, ending in enumerate(endings)])
    assert (row["episodes"], row["completed"]) == (8, 6)
    assert row["success_rate"] == 0.5
    assert row["success_planned"] == 3 / 8
    assert row["collision_rate"] == row["timeout_rate"] == row["off_road_rate"] == 1 / 6
    assert row["error_rate"] == 2 / 8
    assert (row["collision_cav_cav"], row["collision_cav_hdv"]) == (0, 1)


def test_the_interval_of_18_of_20_is_70_to_97_percent(make: Callable[..., EpisodeRecord]) -> None:
    row = summary_row([make(seed, Ending.SUCCESS if seed < 18 else Ending.TIMEOUT) for seed in range(20)])
    assert row["success_low"] == pytest.approx(0.70, abs=0.005)
    assert row["success_high"] == pytest.approx(0.97, abs=0.005)


def test_quality_is_over_successful_episodes_and_every_pair_counts_once(make: Callable[..., EpisodeRecord]) -> None:
    row = summary_row(
        [
            make(0, pets=(1.0, 2.0, 3.0), velocities=(6.0, 8.0)),
            make(1, pets=(10.0,), velocities=(7.0,)),
            make(2, Ending.COLLISION, pets=(0.1,), velocities=(20.0,)),
        ]
    )
    assert (row["pet_mean"], row["pet_median"], row["pet_max"], row["pet_min"]) == (4.0, 2.5, 10.0, 1.0)
    assert (row["pet_count"], row["pet_below_1_5"]) == (4, 0.25)
    assert (row["velocity_mean"], row["velocity_max"], row["velocity_min"]) == (7.0, 8.0, 6.0)
    assert (row["travel_time_mean"], row["delay_mean"]) == (10.0, 1.0)


def test_nothing_measured_is_not_zero(make: Callable[..., EpisodeRecord]) -> None:
    row = summary_row([make(0, Ending.ERROR)])
    undefined = ["success_rate", "success_low", "success_high", "collision_rate", "pet_mean", "pet_below_1_5"]
    assert [row[name] for name in undefined] == [None] * 6
    assert (row["success_planned"], row["error_rate"], row["velocity_mean"]) == (0.0, 1.0, None)
    assert summary_row([make(0, velocities=(5.0,), delay=None)])["delay_mean"] is None


def test_counters_are_summed(make: Callable[..., EpisodeRecord]) -> None:
    row = summary_row([make(0, counts={"fallbacks": 1}), make(1, counts={"fallbacks": 2})])
    assert row["fallbacks"] == 3
    assert row["decisions"] == 24
