"""The merge: main lanes, a ramp that has to change onto them, seeded scenes, and settings that are refused."""

import re
from itertools import combinations
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from starting import check_people, check_room, scenario

from codriving.datatypes.order import Relation
from codriving.datatypes.world import Kind
from codriving.environment.scenarios.merge import Merge
from codriving.errors import ConfigError, ScenarioError
from codriving.geometry.box import PLANNING
from codriving.geometry.road_map import RoadMap, road_map

PAST_MERGE = 80.0
TAPER = 40.0


def merge(**change: Any) -> Merge:
    made = scenario("merge", **change)
    assert isinstance(made, Merge)
    return made


def test_same_seed_same_scene_and_other_seeds_others() -> None:
    one, other = merge(), merge()
    scenes = [one.scene(seed) for seed in range(20)]
    assert scenes == [other.scene(seed) for seed in reversed(range(20))][::-1]
    assert len({scene.starts for scene in scenes}) == 20


@pytest.mark.parametrize("cavs", [2, 3, 6, 9])
def test_half_of_the_cavs_start_on_the_ramp_the_others_on_the_main_road(cavs: int) -> None:
    of = merge(cavs=cavs, hdvs=(0, 2))
    for seed in range(10):
        routes = [start.route for start in of.scene(seed).starts if start.kind is Kind.CAV]
        assert routes[cavs - cavs // 2 :] == ["ramp"] * (cavs // 2)
        assert all(route.startswith("main-") for route in routes[: cavs - cavs // 2])


def test_seeds_cover_every_lane_and_number_of_drivers() -> None:
    of = merge(lanes=2, hdvs=(3, 5))
    scenes = [of.scene(seed) for seed in range(40)]
    assert {s.route for scene in scenes for s in scene.starts if s.kind is Kind.HDV} == {"main-0", "main-1", "ramp"}
    assert {s.route for scene in scenes for s in scene.starts if s.kind is Kind.CAV} == {"main-0", "main-1", "ramp"}
    assert {sum(s.kind is Kind.HDV for s in scene.starts) for scene in scenes} == {3, 4, 5}


@pytest.mark.parametrize(("share", "least", "most"), [(0.0, 0.0, 0.0), (0.3, 0.15, 0.4), (1.0, 1.0, 1.0)])
def test_some_drivers_start_on_the_ramp(share: float, least: float, most: float) -> None:
    of = merge(ramp_hdvs=share, cavs=2, hdvs=(3, 4))
    drivers = [s.route for seed in range(100) for s in of.scene(seed).starts if s.kind is Kind.HDV]
    assert least <= drivers.count("ramp") / len(drivers) <= most


@settings(max_examples=40, deadline=None)
@given(
    seed=st.integers(0, 2**31 - 1),
    cavs=st.integers(2, 10),
    hdvs=st.integers(0, 8),
    lanes=st.integers(1, 4),
    spacing=st.floats(6, 25),
    far=st.floats(100, 240),
)
def test_every_vehicle_can_brake(seed: int, cavs: int, hdvs: int, lanes: int, spacing: float, far: float) -> None:
    speeds = {"cav_speed": (5.0, 20.0), "hdv_speed": (10.0, 18.0)}
    room = {"lanes": lanes, "spacing": spacing, "start": (5.0, far), "before": 250.0}
    try:
        scene = merge(cavs=cavs, hdvs=(0, hdvs), **speeds, **room).scene(seed)
    except ScenarioError:
        assert (cavs + hdvs) * 80 > far - 5.0, "with 80 m for each it always fits"
        return
    check_people(scene, cavs, (0, hdvs), {Kind.CAV: (5.0, 20.0), Kind.HDV: (10.0, 18.0)})
    assert all(5.0 <= start.position <= far for start in scene.starts)
    for route in ("ramp", *(f"main-{k}" for k in range(lanes))):
        check_room([start for start in scene.starts if start.route == route], spacing)


REFUSED = [
    ({"cavs": 11}, "cavs must be 2 to 10, got 11"),
    ({"hdvs": (0, 21)}, "hdvs must be [smallest, largest] within 0 to 20, got [0, 21]"),
    ({"ramp_hdvs": -0.1}, "ramp_hdvs must be 0 to 1, got -0.1"),
    ({"lanes": 0}, "lanes must be 1 to 4, got 0"),
    ({"lanes": 5}, "lanes must be 1 to 4, got 5"),
    ({"before": 50.0}, "before must be 60 to 1000 m, got 50"),
    ({"converge": 30.0}, "converge must be 40 to 500 m, got 30"),
    ({"parallel": 50.0}, "parallel must be 60 to 1000 m, got 50"),
    ({"after": 90.0}, "after must be 100 to 1000 m, got 90"),
    ({"before": 150.0, "start": (5.0, 145.0)}, "within 0 to 140 m (10 m before the ramp converges at the latest)"),
    ({"cav_speed": (12.0, 21.0)}, "cav_speed must be [smallest, largest] within 0 to 20 m/s, got [12, 21]"),
    ({"hdv_speed": (0.5, 18.0)}, "hdv_speed must be [smallest, largest] within 1 to 20 m/s, got [0.5, 18]"),
    ({"spacing": 4.0}, "spacing must be 6 to 200 m, got 4"),
]


@pytest.mark.parametrize(("change", "message"), REFUSED)
def test_settings_out_of_range_are_refused_in_one_line(change: dict[str, Any], message: str) -> None:
    with pytest.raises(ConfigError, match=re.escape(message)) as caught:
        merge(**change)
    assert "\n" not in str(caught.value)


CROWDED = [
    ({"cavs": 10, "lanes": 4}, "5 CAVs and up to 0 HDVs cannot start within 5 to 60 m along the ramp"),
    ({"cavs": 3, "lanes": 1, "spacing": 60.0}, "2 CAVs and up to 0 HDVs cannot start within 5 to 60 m along 1 main"),
    ({"cavs": 4, "hdvs": (0, 20), "lanes": 1}, "4 CAVs and up to 20 HDVs cannot start within 5 to 60 m along 1 main"),
]


@pytest.mark.parametrize(("change", "message"), CROWDED)
def test_what_cannot_be_placed_is_refused_with_the_reason(change: dict[str, Any], message: str) -> None:
    with pytest.raises(ScenarioError, match=re.escape(message)):
        merge(**change, start=(5.0, 60.0))


def check_merge(road: RoadMap, lanes: int) -> None:
    """What holds for the road whatever its measures."""
    mains, last = [f"main-{k}" for k in range(lanes)], f"main-{lanes - 1}"
    assert set(road.paths) == {*mains, "ramp"}
    for a, b in combinations(mains, 2):
        assert road.zones(a, b, PLANNING) == ()
    assert all(road.zones("ramp", main, PLANNING) == () for main in mains[:-1])
    (zone,) = road.zones("ramp", last, PLANNING)
    assert zone.relation is Relation.CONVERGING
    changed = road.lane_start("ramp", ("b", "c", lanes - 1))
    assert changed - TAPER / 2 < zone.entry_i < changed, "they meet on the taper, no earlier"
    assert zone.exit_i >= road.paths["ramp"].length - 1.0
    assert all(route.entry < zone.entry_i for route in road.road.routes)
    for route in road.road.routes:
        assert road.paths[route.id].length - route.goal >= 8.0
    (x, y), (x2, y2) = road.paths["ramp"].points[-1], road.paths[last].points[-1]
    assert (x, y) == pytest.approx((x2, y2))
    (block,) = road.road.blocks
    ramp_lane = road.lanes["b", "c", lanes]
    assert block.position == ramp_lane.shape.end  # type: ignore[union-attr]
    assert all(road.lanes[k].forbidden == (k in (("j", "k", 0), ("k", "b", 0), ramp_lane.id)) for k in road.lanes)


def test_the_ramp_meets_the_lane_beside_it_and_no_other() -> None:
    check_merge(road_map(merge(lanes=2).road), 2)


@settings(max_examples=15, deadline=None)
@given(
    lanes=st.integers(1, 4),
    before=st.floats(60, 400),
    converge=st.floats(40, 300),
    parallel=st.floats(60, 300),
    after=st.floats(100, 300),
)
def test_so_it_does_whatever_the_measures(
    lanes: int, before: float, converge: float, parallel: float, after: float
) -> None:
    measures = {"before": before, "converge": converge, "parallel": parallel, "after": after}
    check_merge(RoadMap(merge(lanes=lanes, **measures, start=(0.0, before - 10.0), cavs=2, hdvs=(0, 0)).road), lanes)


@pytest.mark.parametrize(("converge", "parallel"), [(40.0, 60.0), (500.0, 60.0), (40.0, 1000.0)])
def test_so_it_does_at_the_ends_of_the_ranges(converge: float, parallel: float) -> None:
    check_merge(RoadMap(merge(lanes=1, converge=converge, parallel=parallel, after=100.0).road), 1)


def test_the_ramp_is_smooth_and_as_in_highway_env() -> None:
    road = road_map(merge(lanes=2).road)
    path = road.paths["ramp"]
    assert np.hypot(*np.diff(path.points, axis=0).T).max() <= path.spacing + 1e-3
    assert np.abs(np.diff(path.headings)).max() < 0.01
    assert path.points[0, 1] == pytest.approx(2 * 4.0 + 6.5), "two main lanes, and twice the amplitude of 3.25 m"
    assert (np.diff(path.points[:, 0]) > 0).all()


def test_arrival_is_on_the_main_road_past_the_end_of_the_ramp() -> None:
    of = merge()
    road = road_map(of.road)
    ends = of.before + of.converge + of.parallel
    for route in road.road.routes:
        x, y = road.paths[route.id].position(route.goal)
        assert x == pytest.approx(ends + PAST_MERGE, abs=2.0)
        assert 0.0 <= y <= 4.0 * (of.lanes - 1)


@pytest.mark.parametrize(
    ("change", "hdvs"),
    [
        ({"ramp_hdvs": 0.5}, 8),
        ({}, 10),
        ({"cavs": 10, "before": 400.0, "start": (5.0, 390.0)}, 20),
    ],
)
def test_more_human_drivers_fit(change: dict[str, Any], hdvs: int) -> None:
    of = scenario("merge", **change, hdvs=(hdvs, hdvs))
    for seed in range(15):
        scene = of.scene(seed)
        assert sum(start.kind is Kind.HDV for start in scene.starts) == hdvs
        for lane in {start.route for start in scene.starts}:
            check_room([start for start in scene.starts if start.route == lane], 10.0)
