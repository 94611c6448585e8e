"""Starts leave room to brake, and a scene that is too full is refused."""

import re
from collections.abc import Hashable

import numpy as np
import pytest

from codriving.datatypes.road import Lane, Road, Route, Straight, Turn
from codriving.datatypes.scene import Start
from codriving.datatypes.vehicle import Kind
from codriving.environment.scenarios.placement import Crowd, braking_gap, leaves_room, place
from codriving.errors import ScenarioError


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
    assert Crowd(2, (0, 0), (20.0, 20.0), (5.0, 9.0), (5.0, 9.0), 10.0).room == 1
    assert Crowd(2, (0, 0), (20.0, 75.0), (5.0, 9.0), (6.0, 9.0), 10.0).room == 6, "11 m apart: 5 m of car, gap of 6 m"
    assert Crowd(2, (0, 0), (20.0, 75.0), (0.0, 9.0), (6.0, 9.0), 20.0).room == 3


LANES = tuple(Lane((name, "end", 0), Straight((0, y), (100, y))) for name, y in (("r", 0.0), ("q", 50.0)))
ROAD = Road("street", LANES, tuple(Route(lane.id[0], (lane.id,), Turn.STRAIGHT, 100, 90) for lane in LANES))


def crowd(cavs: int, hdvs: tuple[int, int], start: tuple[float, float]) -> Crowd:
    return Crowd(cavs, hdvs, start, (5.0, 5.0), (5.0, 5.0), 10.0)


def test_scene_that_is_too_full_is_refused_with_the_reason() -> None:
    full = crowd(4, (1, 1), (0.0, 20.0))
    message = (
        "street with starts 0 to 20 m: 4 CAVs and 1 HDVs do not fit with 10 m and a braking gap between them (seed 7); "
        "use fewer"
    )
    with pytest.raises(ScenarioError, match=re.escape(message)):
        place(7, full, ROAD, lambda rng, name, kind: full.start_on(rng, name, kind, "r"))


def test_lanes_that_begin_apart_are_filled_apart() -> None:
    some = crowd(2, (2, 2), (0.0, 12.0))

    def draw(rng: np.random.Generator, name: str, kind: Kind) -> Start:
        return some.start_on(rng, name, kind, "r" if rng.random() < 0.5 else "q")

    for seed in range(10):
        starts = place(seed, some, ROAD, draw).starts
        assert sorted(start.route for start in starts) == ["q", "q", "r", "r"]
        for name in ("q", "r"):
            one, other = (start.position for start in starts if start.route == name)
            assert abs(one - other) >= 10.0


@pytest.mark.parametrize(("loops", "farthest"), [(None, 30.0), ({"ring": 32.0}, 32.0 - 11.0)])
def test_a_lane_in_a_circle_has_no_end(loops: dict[Hashable, float] | None, farthest: float) -> None:
    two = crowd(2, (0, 0), (0.0, 30.0))

    def draw(rng: np.random.Generator, name: str, kind: Kind) -> Start:
        return two.start_on(rng, name, kind, "r")

    scenes = [place(seed, two, ROAD, draw, lambda start: ("ring", start.position), loops) for seed in range(200)]
    distances = [abs(scene.starts[0].position - scene.starts[1].position) for scene in scenes]
    assert farthest - 3.0 < max(distances) <= farthest
