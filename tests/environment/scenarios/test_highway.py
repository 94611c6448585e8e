"""The highway: parallel lanes that never meet, seeded scenes, and settings that are refused."""

import re
from collections.abc import Iterable
from itertools import combinations
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from starting import check_people, check_room, scenario

from codriving.datatypes.road import Straight
from codriving.datatypes.world import Kind
from codriving.environment.scenarios.highway import Highway
from codriving.errors import ConfigError, ScenarioError
from codriving.geometry.road_map import RoadMap, road_map


def highway(**change: Any) -> Highway:
    made = scenario("highway", **change)
    assert isinstance(made, Highway)
    return made


def test_same_seed_same_scene_and_other_seeds_others() -> None:
    one, other = highway(), highway()
    scenes = [one.scene(seed) for seed in range(20)]
    assert scenes == [other.scene(seed) for seed in reversed(range(20))][::-1]
    assert len({scene.starts for scene in scenes}) == 20


def test_seeds_cover_every_lane_and_number_of_drivers() -> None:
    of = highway(lanes=4, hdvs=(8, 12))
    scenes = [of.scene(seed) for seed in range(40)]
    assert {start.route for scene in scenes for start in scene.starts} == {f"lane-{k}" for k in range(4)}
    assert {sum(s.kind is Kind.HDV for s in scene.starts) for scene in scenes} == {8, 9, 10, 11, 12}


@settings(max_examples=40, deadline=None)
@given(
    seed=st.integers(0, 2**31 - 1),
    cavs=st.integers(2, 10),
    hdvs=st.integers(0, 20),
    lanes=st.integers(1, 6),
    spacing=st.floats(6, 40),
    far=st.floats(100, 400),
)
def test_every_vehicle_can_brake(seed: int, cavs: int, hdvs: int, lanes: int, spacing: float, far: float) -> None:
    speeds = {"cav_speed": (10.0, 30.0), "hdv_speed": (15.0, 24.0)}
    room = {"lanes": lanes, "spacing": spacing, "start": (20.0, far), "finish": 800.0}
    try:
        of = highway(cavs=cavs, hdvs=(0, hdvs), **speeds, **room)
        scene = of.scene(seed)
    except ScenarioError:
        assert (cavs + hdvs) * 140 > lanes * (far - 20.0), "with 140 m for each it always fits"
        return
    check_people(scene, cavs, (0, hdvs), {Kind.CAV: (10.0, 30.0), Kind.HDV: (15.0, 24.0)})
    assert all(20.0 <= start.position <= far for start in scene.starts)
    for lane in range(lanes):
        check_room([start for start in scene.starts if start.route == f"lane-{lane}"], spacing)


REFUSED = [
    ({"cavs": 11}, "cavs must be 2 to 10, got 11"),
    ({"hdvs": (0, 41)}, "hdvs must be [smallest, largest] within 0 to 40, got [0, 41]"),
    ({"lanes": 0}, "lanes must be 1 to 6, got 0"),
    ({"lanes": 7}, "lanes must be 1 to 6, got 7"),
    ({"finish": 100.0}, "finish must be 200 to 5000 m, got 100"),
    ({"finish": 300.0, "start": (20.0, 220.0)}, "within 0 to 200 m (100 m before the finish at the latest)"),
    ({"cav_speed": (20.0, 31.0)}, "cav_speed must be [smallest, largest] within 0 to 30 m/s, got [20, 31]"),
    ({"hdv_speed": (0.0, 24.0)}, "hdv_speed must be [smallest, largest] within 1 to 30 m/s, got [0, 24]"),
    ({"spacing": 300.0}, "spacing must be 6 to 200 m, got 300"),
    ({"target_speeds": (0.0, 50.0)}, "target_speeds must be"),
    ({"simulation_frequency": 4.0}, "simulation_frequency must be 5 to 50 Hz, got 4"),
]


@pytest.mark.parametrize(("change", "message"), REFUSED)
def test_settings_out_of_range_are_refused_in_one_line(change: dict[str, Any], message: str) -> None:
    with pytest.raises(ConfigError, match=re.escape(message)) as caught:
        highway(**change)
    assert "\n" not in str(caught.value)


def test_what_cannot_be_placed_is_refused_with_the_reason() -> None:
    with pytest.raises(ScenarioError, match=r"6 CAVs and up to 12 HDVs cannot start within 20 to 60 m .* 2 lanes"):
        highway(cavs=6, hdvs=(8, 12), lanes=2, start=(20.0, 60.0))
    # Where all would fit one behind the other, the draws may still not find it.
    with pytest.raises(ScenarioError, match=r"HDVs do not fit with .* \(seed 1\); use fewer vehicles"):
        highway(cavs=2, hdvs=(8, 8), lanes=1, start=(20.0, 220.0), hdv_speed=(18.0, 24.0)).scene(1)


def parallel(road: RoadMap, names: Iterable[str]) -> bool:
    """Whether no two of some routes are ever in each other's way."""
    return all(road.zones(a, b) == () for a, b in combinations(names, 2))


@settings(max_examples=15, deadline=None)
@given(lanes=st.integers(1, 6), finish=st.floats(400, 2000))
def test_lanes_are_parallel_and_never_conflict(lanes: int, finish: float) -> None:
    road = RoadMap(highway(lanes=lanes, finish=finish, cavs=2, hdvs=(0, 2)).road)
    assert not road.road.regulated
    assert len(road.routes) == len(road.lanes) == lanes
    for k, lane in enumerate(road.road.lanes):
        assert lane.id[2] == k, "counted from the left"
        assert isinstance(lane.shape, Straight)
        assert lane.shape.start[1] == lane.shape.end[1] == 4.0 * k
    for route in road.road.routes:
        assert route.goal == finish
        assert road.paths[route.id].length >= finish + 8.0
    assert parallel(road, road.paths)


def test_markings_separate_lanes_and_end_the_road() -> None:
    lanes = road_map(highway(lanes=3).road).road.lanes
    assert [[str(line) for line in lane.lines] for lane in lanes] == [
        ["continuous_line", "striped"],
        ["none", "striped"],
        ["none", "continuous_line"],
    ]


@pytest.mark.parametrize(("change", "hdvs"), [({}, 18), ({"cavs": 10, "start": (20.0, 400.0)}, 30)])
def test_more_human_drivers_fit(change: dict[str, Any], hdvs: int) -> None:
    of = scenario("highway", **change, hdvs=(hdvs, hdvs))
    for seed in range(15):
        scene = of.scene(seed)
        assert sum(start.kind is Kind.HDV for start in scene.starts) == hdvs
        for lane in {start.route for start in scene.starts}:
            check_room([start for start in scene.starts if start.route == lane], 10.0)
