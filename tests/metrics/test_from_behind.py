"""Human drivers who run into a CAV that has been ahead of them are reported apart."""

import numpy as np
import pytest

from codriving.datatypes.record import Collision, Ending, Outcome, Track, Trajectory
from codriving.datatypes.world import Kind
from codriving.geometry.road_map import RoadMap
from codriving.metrics.standard import StandardMetrics

TIME = np.arange(0, 4.01, 0.1)
STILL = np.zeros_like(TIME)


def track(name: str, x: np.ndarray, y: np.ndarray, heading: float = 0.0) -> Track:
    kind = Kind.CAV if name.startswith("CAV") else Kind.HDV
    n = len(TIME)
    return Track(name, kind, "east", 0, x, y, np.full(n, heading), STILL, STILL, ("",) * n, None)


CHASER = track("HDV1", 10 * TIME - 44.9, STILL)
"""Ends with its front at x = -2.4."""

AHEAD = track("CAV1", STILL, STILL)


APART = ("struck_from_behind", "success_forgiving")


def numbers(striker: Track, struck: Track, road: RoadMap, ending: Ending = Ending.COLLISION) -> dict[str, float | None]:
    hit = Collision(4.0, striker.id, struck.id, "CAV-HDV") if ending is Ending.COLLISION else None
    score = StandardMetrics().score(Trajectory(0.1, (striker, struck)), Outcome(ending, 4.0, {}, hit), road)
    assert score.success is (ending is Ending.SUCCESS)
    return {number.name: number.value for number in score.numbers if number.name in APART}


def test_a_driver_who_hits_who_stands_ahead_is_forgiven(road: RoadMap) -> None:
    assert numbers(CHASER, AHEAD, road) == {"struck_from_behind": 1.0, "success_forgiving": 1.0}


CUTS_IN = track("CAV1", 8 * TIME - 32, np.where(TIME < 3.0, 4.0, np.maximum(4.0 - 4 * (TIME - 3.0), 0.0)))
CROSSES = track("CAV1", STILL, 5 * TIME - 20, np.pi / 2)


@pytest.mark.parametrize(
    ("striker", "struck"),
    [
        (CHASER, CUTS_IN),
        (CHASER, CROSSES),
        (track("CAV1", CHASER.x, STILL), track("HDV1", STILL, STILL)),
        (track("CAV2", CHASER.x, STILL), AHEAD),
        (CHASER, track("CAV1", STILL, STILL, np.pi)),
    ],
    ids=["cut in", "crossing", "CAV into HDV", "CAV into CAV", "head on"],
)
def test_other_collisions_are_not(striker: Track, struck: Track, road: RoadMap) -> None:
    assert numbers(striker, struck, road) == {"struck_from_behind": 0.0, "success_forgiving": 0.0}


@pytest.mark.parametrize(("ending", "value"), [(Ending.SUCCESS, 1.0), (Ending.TIMEOUT, 0.0)])
def test_other_endings_stay_what_they_are(ending: Ending, value: float, road: RoadMap) -> None:
    assert numbers(CHASER, AHEAD, road, ending) == {"struck_from_behind": 0.0, "success_forgiving": value}
