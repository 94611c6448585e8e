"""The authors' definitions on trajectories of ours."""

from collections.abc import Callable

import numpy as np
import pytest

from codriving.datatypes.parts import Metric
from codriving.datatypes.record import Ending, Outcome, Track, Trajectory
from codriving.datatypes.world import Kind
from codriving.errors import ConfigError
from codriving.geometry.road_map import RoadMap
from codriving.metrics.authors import AuthorsMetrics, Log, LoggedEncounter, encounters, entry_arm

Drive = Callable[..., Track]

OUTCOME = Outcome(Ending.SUCCESS, 30.0, {})


def _track(name: str, x: np.ndarray, y: np.ndarray, first_step: int = 0, kind: Kind = Kind.HDV) -> Track:
    speed = np.linspace(1, 9, len(x))
    zeros = np.zeros(len(x))
    return Track(name, kind, "east", first_step, x, y, zeros, speed, zeros, ("",) * len(x), None)


def _crossing(step: float, first_step: int = 0) -> Trajectory:
    """Two human drivers cross the middle at 4 s and at 6 s."""
    time = np.arange(0, 20, step)
    a = _track("a", 10 * (time - 4), 0 * time)
    b = _track("b", 0 * time, 10 * (time + first_step * step - 6), first_step)
    return Trajectory(step, (a, b))


@pytest.mark.parametrize("step", [0.05, 0.1, 0.2])
@pytest.mark.parametrize("first_step", [0, 3, 4])
def test_rows_of_a_fifth_of_a_second_are_compared(road: RoadMap, step: float, first_step: int) -> None:
    metrics: Metric = AuthorsMetrics()
    (pet,) = metrics.score(_crossing(step, first_step), OUTCOME, road).pets
    # Rows are 2 m apart: only the rows in the very middle are less than 1 m apart.
    assert (pet.first, pet.second) == ("a", "b")
    assert pet.value == pytest.approx(2.0)


def test_the_one_that_was_there_earlier_is_first(road: RoadMap) -> None:
    a, b = _crossing(0.1).tracks
    (pet,) = AuthorsMetrics().score(Trajectory(0.1, (b, a)), OUTCOME, road).pets
    assert (pet.first, pet.second) == ("a", "b")


def test_velocity_is_the_mean_of_the_first_rows_or_of_all(road: RoadMap) -> None:
    trajectory = _crossing(0.1)
    speed = trajectory.tracks[0].speed[::2]
    first = AuthorsMetrics().score(trajectory, OUTCOME, road).travels
    whole = AuthorsMetrics(rows=None).score(trajectory, OUTCOME, road).travels
    assert first[0].velocity == pytest.approx(speed[:60].mean())
    assert whole[0].velocity == pytest.approx(speed.mean())
    assert [travel.id for travel in first] == ["a", "b"], "human drivers count"
    assert first[0].delay is None
    assert first[0].time == pytest.approx(19.8)


def test_a_track_without_a_logged_row_is_left_out(road: RoadMap) -> None:
    short = _track("c", np.zeros(1), np.ones(1), first_step=1)
    trajectory = Trajectory(0.1, (*_crossing(0.1).tracks, short))
    assert [travel.id for travel in AuthorsMetrics().score(trajectory, OUTCOME, road).travels] == ["a", "b"]


def test_success_is_the_ending(road: RoadMap) -> None:
    assert AuthorsMetrics().score(_crossing(0.1), OUTCOME, road).success
    assert not AuthorsMetrics().score(_crossing(0.1), Outcome(Ending.TIMEOUT, 30.0, {}), road).success


@pytest.mark.parametrize("key", ["row_interval", "box", "distance", "rows"])
def test_numbers_must_be_positive(key: str) -> None:
    with pytest.raises(ConfigError, match=rf"metrics\.{key} must be > 0, got 0"):
        AuthorsMetrics(**{key: 0})


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
    assert encounters([a, c], box=10, distance=1) == (LoggedEncounter("a", "c", 1, 2),)
    assert encounters([c, a], box=10, distance=1) == (LoggedEncounter("c", "a", 1, 3),)


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
    assert encounters([a, b], box=10, distance=1) == (LoggedEncounter("a", "b", 6, 1),)
