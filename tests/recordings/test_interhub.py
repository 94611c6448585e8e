"""Interactions in the columns of InterHub, worked out by hand."""

import numpy as np
import pytest

from codriving.datatypes.record import Pet, Track, Trajectory
from codriving.datatypes.world import Kind
from codriving.recordings.interhub import interhub_rows


def straight(name: str, x: np.ndarray, y: np.ndarray, heading: float, kind: Kind = Kind.CAV) -> Track:
    ones = np.ones(len(x))
    return Track(name, kind, "r", 0, x, y, heading * ones, 10 * ones, 0 * ones, ("",) * len(x), None)


def test_a_crossing_of_a_cav_and_a_human_driver() -> None:
    """A is in the middle at 4 s, B at 6 s; both are recorded for 20 s, every 0.1 s."""
    t = np.arange(0, 20.05, 0.1)
    a = straight("a", 10 * (t - 4), 0 * t, 0.0)
    b = straight("b", 0 * t, 10 * (t - 6), np.pi / 2, Kind.HDV)
    (row,) = interhub_rows(Trajectory(0.1, (a, b)), [Pet("a", "b", "crossing", 1.3)], "cell", 7)
    assert row == {
        "dataset": "codriving",
        "folder": "cell",
        "scenario_idx": 7,
        "track_id": "a;b",
        "start": 0,
        "end": 11,
        "intensity": None,
        "PET": 1.3,
        "two/multi": "two",
        "vehicle_type": "['AV', 'HV']",
        "AV_included": "AV",
        "key_agents": "a;b",
        "pre_int_i": 40,
        "post_int_i": 50,
        "pre_int_j": 50,
        "post_int_j": 50,
        "path_category": "CP",
        "path_relation": "C-C",
        "turn_label": "S-S",
        "priority_label": None,
    }


@pytest.mark.parametrize(("turned", "label"), [(np.pi / 2, "R"), (-np.pi / 2, "L"), (0.3, "S"), (3.0, "U")])
def test_turns_are_as_seen_from_above_with_y_to_the_south(turned: float, label: str) -> None:
    t = np.arange(0, 10, 0.1)
    heading = np.linspace(0, turned, len(t))
    x, y = np.cumsum(np.cos(heading)), np.cumsum(np.sin(heading))
    zeros = 0 * t
    a = Track("a", Kind.CAV, "r", 0, x, y, heading, zeros, zeros, ("",) * len(t), None)
    b = straight("b", x, zeros, 0.0)
    (row,) = interhub_rows(Trajectory(0.1, (a, b)), [Pet("a", "b", "crossing", 1.0)], "cell", 0)
    assert row["turn_label"] == f"{label}-S"


def test_a_merge_is_one_by_path_and_relation() -> None:
    t = np.arange(0, 10, 0.1)
    a, b = straight("a", 10 * t, 0 * t, 0.0), straight("b", 10 * (t - 3), np.where(t < 8, 4.0, 0.0), 0.0)
    (row,) = interhub_rows(Trajectory(0.1, (a, b)), [Pet("a", "b", "converging", 2.5)], "cell", 0)
    assert (row["path_category"], row["path_relation"], row["AV_included"]) == ("MP", "P-M", "AV")


def test_two_who_meet_head_on() -> None:
    t = np.arange(0, 10, 0.1)
    a, b = straight("a", 10 * t, 0 * t, 0.0, Kind.HDV), straight("b", 90 - 10 * t, 1 + 0 * t, np.pi, Kind.HDV)
    (row,) = interhub_rows(Trajectory(0.1, (a, b)), [Pet("a", "b", "crossing", -1.0)], "cell", 0)
    assert (row["path_category"], row["path_relation"], row["AV_included"]) == ("HO", "O-O", "all_HV")
