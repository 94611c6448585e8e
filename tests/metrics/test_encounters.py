"""The authors' encounters of logged vehicles."""

import numpy as np
import pytest

from codriving.metrics.encounters import Encounter, Log, encounters, entry_arm


def _log(name: str, points: list[tuple[float, float]], first_row: int = 0) -> Log:
    x, y = np.array(points).T
    return Log(name, x, y, np.ones(len(x)), first_row)


@pytest.mark.parametrize(
    ("start", "arm"), [((2, 60), "+y"), ((-2, -60), "-y"), ((50, -2), "+x"), ((-50, 2), "-x"), ((-2, -10.6), "-y")]
)
def test_the_entry_arm_is_that_of_the_first_row(start: tuple[float, float], arm: str) -> None:
    assert entry_arm(_log("a", [start, (0, 0)])) == arm


def test_the_first_encounter_is_the_lexicographic_one() -> None:
    # a is near c's first place in row 3 and near c's last place in row 1: row 1 of a comes first.
    a = _log("a", [(-20, 0), (0, 0), (3, 0), (6, 0)])
    c = _log("c", [(6, 20), (6, 0.5), (0, 0.5), (0.5, 0)])
    assert encounters([a, c], box=10, distance=1) == (Encounter("a", "c", 1, 2),)
    assert encounters([c, a], box=10, distance=1) == (Encounter("c", "a", 1, 3),)


def test_only_the_middle_counts_and_only_less_than_the_distance() -> None:
    a, b = _log("a", [(-20, 0), (9.5, 0)]), _log("b", [(9.5, 30), (9.5, 0.99)])
    assert len(encounters([a, b], box=10, distance=1)) == 1
    assert encounters([a, b], box=9.5, distance=1) == ()
    assert encounters([a, b], box=10, distance=0.99) == ()


def test_vehicles_of_one_arm_never_meet() -> None:
    a, b = _log("a", [(-20, 0), (0, 0)]), _log("b", [(-30, 0), (0, 0)])
    assert encounters([a, b], box=10, distance=1) == ()


def test_rows_are_those_of_the_whole_recording() -> None:
    a, b = _log("a", [(-20, 0), (0, 0)], first_row=5), _log("b", [(0, 30), (0, 0)])
    assert encounters([a, b], box=10, distance=1) == (Encounter("a", "b", 6, 1),)
