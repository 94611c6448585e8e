"""Starts leave room to brake, and a scene that is too full is refused."""

import re

import numpy as np
import pytest

from codriving.datatypes.scene import Start
from codriving.datatypes.vehicle import Kind
from codriving.errors import ScenarioError
from codriving.scenarios.placement import braking_gap, leaves_room, place, room_on_lane


def _start(position: float, speed: float, name: str = "CAV1") -> Start:
    return Start(name, Kind.CAV, "r", position, speed)


def _spot(start: Start) -> tuple[str, float]:
    return start.route, start.position


def test_braking_gap_is_reaction_and_difference_of_stopping_distances() -> None:
    assert braking_gap(10.0, 6.0) == pytest.approx(2.0 + 8.0 + (100 - 36) / (2 * 4))
    assert braking_gap(6.0, 10.0) == pytest.approx(2.0 + 4.8), "a faster leader is no reason to come closer"


def test_the_one_behind_needs_the_room() -> None:
    fast_behind = _start(20.0, 10.0), [_start(40.0, 2.0)]
    fast_ahead = _start(40.0, 10.0), [_start(20.0, 2.0)]
    assert not leaves_room(*fast_behind, _spot, spacing=10.0)
    assert leaves_room(*fast_ahead, _spot, spacing=10.0)


def test_spacing_holds_whatever_the_speeds() -> None:
    assert not leaves_room(_start(20.0, 0.0), [_start(29.9, 0.0)], _spot, spacing=10.0)
    assert leaves_room(_start(20.0, 0.0), [_start(30.1, 0.0)], _spot, spacing=10.0)


def test_room_on_a_lane() -> None:
    assert room_on_lane(0.0, 5.0, 10.0) == 1
    assert room_on_lane(55.0, 5.0, 10.0) == 6, "11 m apart: 5 m of car and a gap of 6 m"
    assert room_on_lane(55.0, 0.0, 20.0) == 3


def test_scene_that_is_too_full_is_refused_with_the_reason() -> None:
    def draw(rng: np.random.Generator, name: str, kind: Kind) -> Start:
        return Start(name, kind, "r", float(rng.uniform(0, 20)), 5.0)

    message = (
        "road with 20 m: 4 CAVs and 1 HDVs do not fit with 10 m and a braking gap between them (seed 7); use fewer"
    )
    with pytest.raises(ScenarioError, match=re.escape(message)):
        place(7, 4, (1, 1), draw, _spot, 10.0, "road with 20 m")
