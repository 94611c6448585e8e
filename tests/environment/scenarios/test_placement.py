"""Starts leave room to brake, and a scene that is too full is refused."""

import re
from collections.abc import Hashable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from codriving.datatypes.road import Lane, Road, Route, Straight, Turn
from codriving.datatypes.world import Kind, Start
from codriving.environment.scenarios.placement import Crowd, braking_gap, leaves_room, place
from codriving.errors import ConfigError, ScenarioError


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


CROWD = Crowd(4, (2, 4), (20.0, 75.0), (5.0, 9.0), (6.0, 8.0), 10.0)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"cavs": 1}, "cavs must be 2 to 6, got 1"),
        ({"cavs": 7}, "cavs must be 2 to 6, got 7"),
        ({"hdvs": (4, 9)}, "hdvs must be [smallest, largest] within 0 to 8, got [4, 9]"),
        (
            {"start": (20.0, 86.0)},
            "start must be [smallest, largest] within 0 to 85 m (before it), got [20, 86]",
        ),
        ({"cav_speed": (5.0, 11.0)}, "cav_speed must be [smallest, largest] within 0 to 10 m/s, got [5, 11]"),
        ({"hdv_speed": (0.5, 8.0)}, "hdv_speed must be [smallest, largest] within 1 to 10 m/s, got [0.5, 8]"),
        ({"spacing": 5.0}, "spacing must be 6 to 200 m, got 5"),
    ],
)
def test_settings_out_of_range_are_refused(change: dict[str, Any], message: str) -> None:
    with pytest.raises(ConfigError, match=re.escape(message)):
        replace(CROWD, **change).check(6, 8, 85, "before it", 10)


def test_ends_of_the_ranges_are_in_them() -> None:
    CROWD.check(4, 4, 75, "", 9)


def test_room_counts_cars_with_a_gap_to_brake_in() -> None:
    assert CROWD.room == 6, "55 m, and 5 m of car with a gap of 6 m"
    CROWD.require_room(2, "2 legs")
    CROWD.require_room(1, "the ramp", cavs=2)
    message = (
        "4 CAVs and up to 4 HDVs cannot start within 20 to 75 m along 1 leg, where 6 vehicles have 10 m and a braking "
        "gap between them at most; use fewer vehicles or a longer start interval"
    )
    with pytest.raises(ScenarioError, match=re.escape(message)):
        CROWD.require_room(1, "1 leg")


def test_draws_stay_within_the_intervals() -> None:
    rng = np.random.default_rng(0)
    for kind, low, high in ((Kind.CAV, 5.0, 9.0), (Kind.HDV, 6.0, 8.0)):
        starts = [CROWD.start_on(rng, "A", kind, "r") for _ in range(200)]
        speeds, places = [start.speed for start in starts], [start.position for start in starts]
        assert low <= min(speeds) < low + 0.2 < high - 0.2 < max(speeds) <= high
        assert 20.0 <= min(places) < 22.0 < 73.0 < max(places) <= 75.0
    elsewhere = [CROWD.start_on(rng, "A", Kind.HDV, "r", (100.0, 110.0)).position for _ in range(50)]
    assert min(elsewhere) >= 100.0
    assert max(elsewhere) <= 110.0


def test_a_scene_that_does_not_suit_is_drawn_again_and_at_last_refused() -> None:
    some, asked = crowd(2, (0, 0), (0.0, 30.0)), []

    def draw(rng: np.random.Generator, name: str, kind: Kind) -> Start:
        return some.start_on(rng, name, kind, "r")

    def suits(starts: Sequence[Start]) -> bool:
        asked.append(starts)
        return len(asked) == 3

    assert place(7, some, ROAD, draw, suits=suits).starts == tuple(asked[2])
    message = "street: of 200 scenes drawn for seed 7 none has what the settings ask of all starts together, such as"
    with pytest.raises(ScenarioError, match=message):
        place(7, some, ROAD, draw, suits=suits)
