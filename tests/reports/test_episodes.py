"""episodes.csv: fixed columns first, undefined is empty."""

import csv
import io
from collections.abc import Callable

from codriving.datatypes.record import Ending, EpisodeRecord
from tests.reports.making import episodes_of


def rows_of(records: list[EpisodeRecord]) -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(episodes_of(records).csv())))


def test_the_columns_that_users_rely_on_come_first(make: Callable[..., EpisodeRecord]) -> None:
    expected = "scenario, method, variant, reasoner, seed, outcome, pet_mean, pet_min, velocity_mean, duration"
    assert list(episodes_of([make(0)]).keys)[:10] == expected.split(", ")


def test_swept_keys_follow_them(make: Callable[..., EpisodeRecord]) -> None:
    table = episodes_of([make(0)], {"scenario.cavs": "8"})
    assert table.keys[10:12] == ("scenario.cavs", "pet_count")
    (row,) = table.rows
    assert (row["scenario.cavs"], row["cavs"]) == ("8", 1)


def test_a_row_says_how_it_went(make: Callable[..., EpisodeRecord]) -> None:
    (row,) = rows_of([make(3, Ending.COLLISION, pets=(1.0, 2.0), velocities=(7.0, 8.0), counts={"fallbacks": 4})])
    assert row["outcome"] == "collision"
    assert (row["pet_mean"], row["pet_min"], row["velocity_mean"], row["duration"]) == ("1.5", "1", "7.5", "12")
    assert (row["collision_pair"], row["striker"], row["struck"]) == ("CAV-HDV", "CAV0", "HDV0")
    assert (row["cavs"], row["hdvs"], row["decisions"], row["fallbacks"]) == ("1", "1", "12", "4")


def test_what_is_not_defined_is_empty_and_not_zero(make: Callable[..., EpisodeRecord]) -> None:
    quiet, broken = rows_of([make(0), make(1, Ending.ERROR)])
    assert (quiet["pet_mean"], quiet["pet_count"], quiet["velocity_mean"]) == ("", "0", "")
    assert (broken["pet_count"], broken["duration"], broken["message"]) == ("", "", "RuntimeError: x")


def test_a_counter_that_only_some_report_is_empty_for_the_others(make: Callable[..., EpisodeRecord]) -> None:
    first, second = rows_of([make(0, counts={"repaired": 1}), make(1)])
    assert (first["repaired"], second["repaired"]) == ("1", "")


def test_a_counter_never_takes_the_place_of_a_column(make: Callable[..., EpisodeRecord]) -> None:
    records = [make(0, counts={"seed": 99, "decisions": 99})]
    assert len(set(episodes_of(records).keys)) == len(episodes_of(records).keys)
    assert rows_of(records)[0]["seed"] == "0"
