"""The first decision that differs."""

from dataclasses import replace

import numpy as np

from codriving.datatypes.record import Track, Trajectory
from codriving.datatypes.world import Kind
from codriving.pages.parting import choices_in, parting, same_start


def line(time: float, **actions: str) -> dict[str, object]:
    return {"time": time, "cavs": [{"id": name, "action": action} for name, action in actions.items()]}


def test_the_first_difference_and_no_later_one() -> None:
    one = choices_in([line(0.0, CAV1="IDLE", CAV2="HOLD"), line(0.5, CAV1="IDLE", CAV2="HOLD"), line(1.0, CAV1="HOLD")])
    other = choices_in([line(0.0, CAV1="IDLE", CAV2="HOLD"), line(0.5, CAV1="IDLE", CAV2="SLOWER"), line(1.0)])
    found = parting(one, other)
    assert found is not None
    assert found.time == 0.5
    assert found.changes == (("CAV2", "HOLD", "SLOWER"),)


def test_a_cav_that_is_there_in_one_alone() -> None:
    found = parting(choices_in([line(0.0, CAV1="IDLE")]), choices_in([line(0.0, CAV1="IDLE", CAV2="HOLD")]))
    assert found is not None
    assert found.changes == (("CAV2", "-", "HOLD"),)


def test_the_same_decisions_part_nowhere_even_if_one_lasts_longer() -> None:
    one = choices_in([line(0.0, CAV1="IDLE")])
    assert parting(one, [*one, *choices_in([line(0.5, CAV1="HOLD")])]) is None


def track(name: str, x: float, first: int = 0) -> Track:
    xs, zeros = np.array([x, x + 1.0]), np.zeros(2)
    return Track(name, Kind.CAV, "a-b", first, xs, zeros, zeros, zeros + 5, zeros, ("", ""), None)


def test_a_start_is_the_vehicles_that_are_there_at_once() -> None:
    scene = Trajectory(0.1, (track("CAV1", 3.0),))
    assert same_start(scene, replace(scene, tracks=(*scene.tracks, track("HDV9", 0.0, first=30))))
    assert not same_start(scene, Trajectory(0.1, (track("CAV1", 3.1),)))
    assert not same_start(scene, Trajectory(0.1, (track("CAV2", 3.0),)))
