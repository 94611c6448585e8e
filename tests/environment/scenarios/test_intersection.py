"""The intersection: seeded scenes that can be driven, and settings that are refused."""

import re
from collections.abc import Iterable
from itertools import combinations
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from codriving.datatypes.road import Turn
from codriving.datatypes.world import Kind
from codriving.environment.scenarios.intersection import Intersection
from codriving.environment.scenarios.placement import LENGTH, braking_gap
from codriving.errors import ConfigError, ScenarioError
from codriving.geometry.road_map import road_map

DEFAULT: dict[str, Any] = {
    "cavs": 4,
    "hdvs": (2, 4),
    "leg_length": 100.0,
    "start": (20.0, 75.0),
    "cav_speed": (5.0, 9.0),
    "hdv_speed": (6.0, 9.0),
    "spacing": 10.0,
    "exit_distance": 25.0,
    "pattern": "random",
    "row_gap": 14.0,
    "turns": ("left", "straight", "right"),
    "blocked_exit": 0.0,
    "blocked_room": 7.0,
    "blind": None,
    "simulation_frequency": 10.0,
    "decision_frequency": 2.0,
    "time_limit": 50.0,
    "target_speeds": (0.0, 3.0, 6.0, 9.0),
    "detection_range": 50.0,
}


def test_same_seed_same_scene_and_other_seeds_others() -> None:
    one, other = Intersection(**DEFAULT), Intersection(**DEFAULT)
    scenes = [one.scene(seed) for seed in range(20)]
    assert scenes == [other.scene(seed) for seed in range(20)]
    assert len({scene.starts for scene in scenes}) == 20


def test_order_of_asking_does_not_matter() -> None:
    scenario = Intersection(**DEFAULT)
    first = scenario.scene(3)
    scenario.scene(4)
    assert scenario.scene(3) == first


def test_seeds_cover_every_route_and_number_of_drivers() -> None:
    scenes = [Intersection(**DEFAULT).scene(seed) for seed in range(60)]
    assert len({start.route for scene in scenes for start in scene.starts}) == 12
    assert {sum(start.kind is Kind.HDV for start in scene.starts) for scene in scenes} == {2, 3, 4}


@settings(max_examples=40, deadline=None)
@given(
    seed=st.integers(0, 2**31 - 1),
    cavs=st.integers(2, 12),
    hdvs=st.integers(0, 6),
    near=st.floats(0, 20),
    spacing=st.floats(6, 14),
    speed=st.floats(0, 10),
)
def test_every_vehicle_can_brake(seed: int, cavs: int, hdvs: int, near: float, spacing: float, speed: float) -> None:
    change = {"cavs": cavs, "hdvs": (0, hdvs), "start": (near, 85.0), "spacing": spacing, "cav_speed": (0.0, speed)}
    scenario = Intersection(**{**DEFAULT, **change})
    try:
        scene = scenario.scene(seed)
    except ScenarioError:
        assert cavs + hdvs > 10, "so few always fit"
        return
    names = [start.id for start in scene.starts]
    assert len(set(names)) == len(names)
    assert [s.id for s in scene.starts if s.kind is Kind.CAV] == [f"CAV{i + 1}" for i in range(cavs)]
    assert sum(s.kind is Kind.HDV for s in scene.starts) <= hdvs
    for start in scene.starts:
        low, high = scenario.crowd.cav_speed if start.kind is Kind.CAV else scenario.crowd.hdv_speed
        assert low <= start.speed <= high
        assert near <= start.position <= 85.0
    for one, other in combinations(scene.starts, 2):
        if one.route.split("-")[0] == other.route.split("-")[0]:
            ahead, behind = (one, other) if one.position > other.position else (other, one)
            distance = ahead.position - behind.position
            assert distance >= spacing
            assert distance - LENGTH >= braking_gap(behind.speed, ahead.speed)


@pytest.mark.parametrize(("cavs", "seeds"), [(4, range(25)), (8, range(25)), (12, (*range(20), 119, 207))])
def test_default_density_always_fits(cavs: int, seeds: Iterable[int]) -> None:
    scenario = Intersection(**{**DEFAULT, "cavs": cavs})
    assert all(len(scenario.scene(seed).starts) >= cavs + 2 for seed in seeds)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"cavs": 99}, "cavs must be 2 to 12, got 99"),
        ({"cavs": 1}, "cavs must be 2 to 12, got 1"),
        ({"hdvs": (4, 2)}, "hdvs must be [smallest, largest] within 0 to 12, got [4, 2]"),
        ({"leg_length": 20.0}, "leg_length must be 40 to 500 m, got 20"),
        ({"start": (75.0, 20.0)}, "start must be [smallest, largest] within 0 to 85 m"),
        ({"start": (20.0, 99.0)}, "15 m before the junction at the latest"),
        ({"cav_speed": (9.0, 5.0)}, "cav_speed must be [smallest, largest] within 0 to 10 m/s, got [9, 5]"),
        ({"cav_speed": (5.0, 14.0)}, "cav_speed must be"),
        ({"hdv_speed": (0.0, 9.0)}, "hdv_speed must be [smallest, largest] within 1 to 10 m/s"),
        ({"spacing": 1.0}, "spacing must be 6 to 200 m, got 1"),
        ({"exit_distance": 95.0}, "exit_distance must be 5 to 90 m, got 95"),
        ({"target_speeds": (0.0, 5.0, 6.0)}, "evenly spaced"),
        ({"simulation_frequency": 15.0}, "simulation_frequency must be a multiple of decision_frequency"),
    ],
)
def test_settings_out_of_range_are_refused(change: dict[str, Any], message: str) -> None:
    with pytest.raises(ConfigError, match=re.escape(message)):
        Intersection(**{**DEFAULT, **change})


def test_vehicles_that_cannot_be_placed_are_refused_before_any_episode() -> None:
    message = "4 CAVs and up to 4 HDVs cannot start within 50 to 55 m along 4 legs, where 4 vehicles have 10 m"
    with pytest.raises(ScenarioError, match=re.escape(message)):
        Intersection(**{**DEFAULT, "start": (50.0, 55.0)})


def test_road_is_consistent_and_says_where_the_junction_begins() -> None:
    road = Intersection(**DEFAULT).road
    paths = road_map(road).paths
    assert road.regulated
    assert len(road.routes) == 12
    for route in road.routes:
        middle = paths[route.id].length - 200.0
        assert route.entry == 100.0
        assert route.goal == pytest.approx(100.0 + middle + 25.0, abs=1e-6)
        assert middle == pytest.approx({Turn.LEFT: 20.42, Turn.STRAIGHT: 22.0, Turn.RIGHT: 14.14}[route.turn], abs=0.01)


def test_turns_are_what_they_say() -> None:
    turns = {route.id: route.turn for route in Intersection(**DEFAULT).road.routes}
    assert turns["south-east"] is Turn.RIGHT
    assert turns["south-west"] is Turn.LEFT
    assert turns["south-north"] is Turn.STRAIGHT
    assert turns["east-north"] is Turn.RIGHT


def test_buildings_stand_at_the_corners_as_long_as_the_legs() -> None:
    assert Intersection(**DEFAULT).road.buildings == ()
    buildings = Intersection(**{**DEFAULT, "blind": 8.0}).road.buildings
    spans = {
        tuple(sorted((p - side / 2, p + side / 2)))
        for building in buildings
        for p, side in zip(building.position, (building.length, building.width), strict=True)
    }
    assert spans == {(8.0, 111.0), (-111.0, -8.0)}
    assert len({building.position for building in buildings}) == 4


@pytest.mark.parametrize("near", [7.0, 100.0])
def test_buildings_leave_the_lanes_free(near: float) -> None:
    assert road_map(Intersection(**{**DEFAULT, "blind": near}).road).sight is not None


@pytest.mark.parametrize("near", [6.9, 100.1])
def test_buildings_nearer_or_farther_are_refused(near: float) -> None:
    with pytest.raises(ConfigError, match=f"blind must be 7 to 100 m, got {near:g}"):
        Intersection(**{**DEFAULT, "blind": near})


def test_buildings_change_no_start() -> None:
    plain, blind = Intersection(**DEFAULT), Intersection(**{**DEFAULT, "blind": 8.0})
    assert [plain.scene(seed) for seed in range(10)] == [blind.scene(seed) for seed in range(10)]
