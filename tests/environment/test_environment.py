"""What the environment hands out, what it writes down, and what it refuses."""

import json
import re
from collections.abc import Callable
from dataclasses import asdict, replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from codriving.datatypes.world import Action, Kind, Start, WorldState
from codriving.environment.drivers.body import body
from codriving.environment.environment import Environment
from codriving.environment.settings import DriverProfile
from codriving.environment.traffic.human_driver import body_ahead
from codriving.environment.traffic.route_following import route_path
from codriving.errors import ConfigError, EpisodeError, ScenarioError
from codriving.geometry.road_map import road_map

BODY_MARGIN = 0.6

Build = Callable[..., Environment]


def idle(world: WorldState) -> dict[str, Action]:
    return {cav.id: Action.IDLE for cav in world.cavs}


def test_world_before_the_first_step_is_the_scene(intersection: Build) -> None:
    env = intersection()
    world = env.reset(3)
    scene = env.scenario.scene(3)
    assert (world.time, world.step) == (0.0, 0)
    assert [v.id for v in world.vehicles] == sorted(start.id for start in scene.starts)
    for start in scene.starts:
        seen = next(v for v in world.vehicles if v.id == start.id)
        x, y = env.road_map.paths[start.route].position(start.position)
        assert (seen.x, seen.y, seen.speed, seen.kind) == (float(x), float(y), start.speed, start.kind)
        assert seen.lane == env.road_map.routes[start.route].lanes[0]


def test_world_hides_what_drivers_intend(intersection: Build) -> None:
    env = intersection()
    world = env.reset(3)
    for _ in range(3):
        cavs = {cav.id for cav in world.cavs}
        assert set(world.intents) == set(world.available) == cavs
        assert {v.id for v in world.hdvs}.isdisjoint(cavs)
        assert all(v.kind is Kind.HDV for v in world.hdvs)
        world = env.step(idle(world))
    assert "route" not in asdict(world.vehicles[0])


def test_world_is_made_of_plain_numbers(intersection: Build) -> None:
    env = intersection()
    world = env.reset(3)
    for _ in range(2):
        for vehicle in world.vehicles:
            numbers = (vehicle.x, vehicle.y, vehicle.heading, vehicle.speed, vehicle.acceleration, vehicle.length)
            assert {type(n) for n in numbers} == {float}
            assert type(vehicle.lane[2]) is int
        assert {type(intent.target_speed) for intent in world.intents.values()} == {float}
        assert type(world.time) is float
        assert json.loads(json.dumps(asdict(world)))["step"] == world.step
        world = env.step(idle(world))


def test_world_is_a_copy(intersection: Build) -> None:
    env = intersection()
    world = env.reset(3)
    before = asdict(world)
    env.step(idle(world))
    assert asdict(world) == before


def test_time_and_decisions_are_counted(intersection: Build) -> None:
    env = intersection(decision_frequency=5.0)
    world = env.reset(0)
    for k in range(4):
        assert (world.step, world.time) == (k, pytest.approx(0.2 * k))
        world = env.step(idle(world))


def test_rows_of_the_recorder(intersection: Build) -> None:
    env = intersection()
    world = env.reset(3)
    worlds = [world]
    for _ in range(4):
        worlds.append(env.step({cav.id: Action.SLOWER for cav in worlds[-1].cavs}))
    trajectory = env.trajectory()
    assert trajectory.step == pytest.approx(0.1)
    assert [t.id for t in trajectory.tracks] == [v.id for v in world.vehicles]
    for track in trajectory.tracks:
        assert (track.first_step, len(track.x), len(track.action), track.arrived) == (0, 21, 21, None)
        assert track.kind.value == track.id[:3]
        for k, seen in enumerate(worlds):
            state = next(v for v in seen.vehicles if v.id == track.id)
            row = tuple(float(a[5 * k]) for a in (track.x, track.y, track.heading, track.speed, track.acceleration))
            assert row == (state.x, state.y, state.heading, state.speed, state.acceleration)
        assert set(track.action[1:]) == ({"SLOWER"} if track.kind is Kind.CAV else {""})
        assert track.action[0] == ""
        assert track.route in env.road_map.routes


@pytest.mark.parametrize(
    ("actions", "message"),
    [
        ({}, "one action for each of ['CAV1', 'CAV2'] is needed, got []"),
        ({"CAV1": Action.IDLE}, "is needed, got ['CAV1']"),
        ({"CAV1": Action.IDLE, "CAV2": Action.IDLE, "HDV1": Action.IDLE}, "got ['CAV1', 'CAV2', 'HDV1']"),
        (
            {"CAV1": Action.IDLE, "CAV2": Action.LANE_LEFT},
            "CAV2 cannot do LANE_LEFT here; it can do SLOWER, IDLE, FASTER",
        ),
        ({"CAV1": Action.IDLE, "CAV2": "brake"}, "CAV2 cannot do brake here"),
        ({"CAV1": Action.IDLE, "CAV2": None}, "CAV2 cannot do None here"),
    ],
)
def test_wrong_actions_are_refused_and_nothing_moves(
    actions: dict[str, Any], message: str, intersection: Build
) -> None:
    env = intersection(cavs=2)
    world = env.reset(0)
    with pytest.raises(EpisodeError, match=re.escape(message)):
        env.step(actions)
    assert env.step(idle(world)).time == 0.5


def test_an_episode_must_have_begun_and_not_be_over(intersection: Build) -> None:
    env = intersection(cavs=2, time_limit=1.0)
    with pytest.raises(EpisodeError, match="no episode has begun"):
        env.step({})
    with pytest.raises(EpisodeError, match="no episode has begun"):
        env.trajectory()
    world = env.reset(0)
    while env.outcome is None:
        world = env.step(idle(world))
    with pytest.raises(EpisodeError, match="the episode is over"):
        env.step(idle(world))
    assert env.reset(0).time == 0.0
    assert env.outcome is None


def test_driving_model_is_that_of_the_settings(intersection: Build) -> None:
    model = intersection(simulation_frequency=15.0, decision_frequency=1.0, detection_range=70.0).driving_model
    assert (model.substeps, model.speed_gain, model.detection_range) == (15, 1.6, 70.0)
    assert model.target_speeds == (0.0, 3.0, 6.0, 9.0)


def test_driver_parameters_out_of_range_are_refused() -> None:
    good = dict.fromkeys(("acceleration", "deceleration", "limit", "headway", "safe_braking"), 2.0)
    good |= {"jam_distance": 7.0, "sight": 70.0, "politeness": 0.0, "gain_threshold": 0.2}
    DriverProfile(**good)
    with pytest.raises(ConfigError, match=r"drivers\.jam_distance must be 5\.5 to 30, got 5"):
        DriverProfile(**{**good, "jam_distance": 5.0})


def test_goal_too_near_to_the_end_of_the_road_is_refused(intersection: Build) -> None:
    road = intersection().scenario.road
    routes = tuple(replace(route, goal=route.goal + 70.0) for route in road.routes)
    with pytest.raises(ScenarioError, match="must have its goal 8 m or more before its end at"):
        route_path(road_map(replace(road, routes=routes)), "south-north")


@pytest.mark.parametrize("name", ["south-north", "south-east", "south-west"])
def test_following_a_way_gives_the_same_numbers_as_projecting(name: str, intersection: Build) -> None:
    laid_out = route_path(intersection().road_map, name)
    rng = np.random.default_rng(0)
    for s in rng.uniform(-3, laid_out.path.length + 3, 300):
        x, y = (float(v) for v in laid_out.path.position(s))
        x, y, near = x + float(rng.normal()), y + float(rng.normal()), float(s - rng.uniform(0, 3))
        assert laid_out.follow(x, y, near) == laid_out.path.project(x, y, near)
        assert laid_out.is_near(x, y) or not 0 < s < laid_out.path.length


def test_body_ahead_is_the_nearest_one_in_the_way(intersection: Build, by_hand: Build) -> None:
    env = by_hand(starts=[Start("HDV1", Kind.HDV, "south-west", 80.0, 6.0)])
    env.reset(0)
    driver = env._traffic.vehicles[0]
    path = env.road_map.paths["south-west"]
    rng = np.random.default_rng(1)
    found = 0
    for _ in range(400):
        s, aside, turn = rng.uniform(60, 148), rng.uniform(-8, 8), rng.uniform(-3, 3)
        (x, y), heading = path.position(s), float(path.heading(s))
        place = np.array([x - aside * np.sin(heading), y + aside * np.cos(heading)])
        box = SimpleNamespace(LENGTH=5.0, WIDTH=2.0, solid=True)
        reach = abs(np.cos(turn)) * 2.5 + abs(np.sin(turn))
        side = abs(np.sin(turn)) * 2.5 + abs(np.cos(turn))
        distance = float(np.hypot(*(place - driver.position)))
        if abs(abs(aside) - (1 + BODY_MARGIN + side)) < 0.3 or abs(s - 80.0) < 1.0 or abs(distance - 70.0) < 1.0:
            continue  # on the edge, where a path of straight pieces may decide either way
        one = (box, *place.tolist(), heading + turn, 0.0)
        body_seen, gap = body_ahead(driver, [body(driver), one], 70.0)
        if abs(aside) < 1 + BODY_MARGIN + side and s > 80.0 and distance < 70.0:
            found += 1
            assert body_seen is one
            assert gap == pytest.approx(s - 80.0 - reach - 2.5, abs=0.4)
        else:
            assert body_seen is None
            assert gap == np.inf
    assert found > 50


@pytest.mark.parametrize("aside", [0.0, 3.0])
def test_on_a_straight_route_the_same_body_is_found(aside: float, configured: Callable[..., Environment]) -> None:
    env = configured("scenario=highway")
    env.reset(0)
    driver = next(v for v in env._traffic.vehicles if v.kind is Kind.HDV)
    assert driver.route_path.is_straight
    driver.position[1] += aside
    driver.on_state_update()
    quick, rng, found = driver.route_path, np.random.default_rng(2), 0
    for _ in range(400):
        around = rng.uniform((-40, -9), (140, 9), (5, 2)) + driver.position
        bodies = [
            (SimpleNamespace(LENGTH=float(rng.uniform(2, 9)), WIDTH=2.0, solid=True), *place, float(turn), 0.0)
            for place, turn in zip(around.tolist(), rng.normal(0, rng.choice([0.02, 1.0]), 5), strict=True)
        ]
        driver.route_path = quick
        sooner = body_ahead(driver, bodies, 100.0)
        driver.route_path = replace(quick, is_straight=False)
        assert sooner == body_ahead(driver, bodies, 100.0)
        found += sooner[0] is not None
    assert 200 < found < 400


def test_drivers_are_drawn_anew_where_they_are(configured: Callable[..., Environment]) -> None:
    environment = configured("suite=default", "drivers=mixed", "scenario.hdvs=[4,4]")
    world = environment.reset(20_000)
    before = environment.manners()
    environment.redraw_drivers(1)
    first = environment.manners()
    environment.redraw_drivers(2)
    second = environment.manners()
    environment.redraw_drivers(1)
    assert environment.manners() == first
    assert len({str(manners) for manners in (before, first, second)}) == 3
    acting = {v.id: Action.IDLE for v in world.cavs}
    after = environment.step(acting)
    assert [v.id for v in after.vehicles] == [v.id for v in world.vehicles]
