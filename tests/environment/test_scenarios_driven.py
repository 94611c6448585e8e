"""Each scenario in the environment: what the drivers are, how far they see, and where they and CAVs may be."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from codriving.config.choices import choices
from codriving.datatypes.world import Action, WorldState
from codriving.environment.environment import Environment
from codriving.environment.traffic.human_driver import HumanDriver
from codriving.geometry.road_map import road_map

Build = Callable[..., Environment]


@pytest.fixture(scope="module")
def env(configured: Build, request: pytest.FixtureRequest) -> Environment:
    return configured(f"scenario={request.param}")


on_each = pytest.mark.parametrize("env", tuple(choices("scenario")), indirect=True)


def anything(world: WorldState, rng: np.random.Generator) -> dict[str, Action]:
    return {cav.id: world.available[cav.id][int(rng.integers(len(world.available[cav.id])))] for cav in world.cavs}


@on_each
def test_drivers_have_the_parameters_of_the_settings_and_the_class_has_none(env: Environment) -> None:
    before = dict(vars(HumanDriver))
    world = env.reset(1)
    env.step(anything(world, np.random.default_rng(1)))
    drivers = [vehicle for vehicle in env._traffic.vehicles if isinstance(vehicle, HumanDriver)]
    assert drivers
    for driver in drivers:
        assert (env.drivers.jam_distance, env.drivers.headway) == (driver.DISTANCE_WANTED, driver.TIME_WANTED)
        assert (env.drivers.acceleration, env.drivers.limit) == (driver.COMFORT_ACC_MAX, driver.ACC_MAX)
        assert driver.sight == env.drivers.sight
    assert dict(vars(HumanDriver)) == before


@on_each
def test_whatever_is_decided_every_vehicle_is_where_the_world_says(env: Environment) -> None:
    rng, lanes = np.random.default_rng(0), env.road_map.lanes
    for seed in (0, 1):
        world = env.reset(seed)
        while env.outcome is None and world.step < 30:
            for vehicle in env._traffic.vehicles:
                s, lateral = vehicle.route_path.path.project(*map(float, vehicle.position))
                assert vehicle.s == pytest.approx(s, abs=1e-6)
                assert vehicle.offset == pytest.approx(lateral, abs=1e-6)
                assert vehicle.speed >= 0.0
                # The centre line of a route is made of straight pieces.
                centre = vehicle.lane.local_coordinates(vehicle.position)[1]
                assert vehicle.offset - vehicle.shift == pytest.approx(centre, abs=0.6)
            for cav in world.cavs:
                intent = world.intents[cav.id]
                assert intent.route in env.road_map.routes
                assert {intent.target_lane, cav.lane} <= set(lanes)
                assert intent.target_speed in env.driving_model.target_speeds
                start, end, index = intent.target_lane
                for action, step in ((Action.LANE_LEFT, -1), (Action.LANE_RIGHT, 1)):
                    if action in world.available[cav.id]:
                        assert not lanes[start, end, index + step].forbidden
            world = env.step(anything(world, rng))


@on_each
def test_same_seed_same_trajectory_after_other_seeds(env: Environment) -> None:
    def driven(seed: int) -> list[tuple[Any, ...]]:
        rng = np.random.default_rng(seed)
        world = env.reset(seed)
        while env.outcome is None and world.step < 12:
            world = env.step(anything(world, rng))
        columns = ("x", "y", "heading", "speed")
        return [(t.id, t.route, *(getattr(t, name).tobytes() for name in columns)) for t in env.trajectory().tracks]

    first = [driven(seed) for seed in (0, 1)]
    assert [driven(seed) for seed in (1, 0)] == first[::-1]
    assert first[0] != first[1]


@on_each
def test_ways_are_laid_out_as_the_map_says(env: Environment) -> None:
    for route in env.scenario.road.routes:
        laid = env._route_paths[route.id]
        assert laid.route.goal <= laid.end < road_map(env.scenario.road).paths[route.id].length
        for s in np.linspace(0.0, laid.path.length, 50):
            assert laid.lane_at(s) == env.road_map.lane_at(route.id, s)


def test_a_way_knows_the_lane_that_ends_and_plans_the_one_beside(configured: Build) -> None:
    made = configured("scenario=merge", "scenario.lanes=2", "scenario.before=150", "scenario.converge=80")
    ramp, main = made._route_paths["ramp"], made._route_paths["main-1"]
    assert ramp.ending == ("b", "c", 2)
    assert ramp.lane_end == pytest.approx(made.scenario.road.blocks[0].position[0], abs=1.5)
    assert (main.ending, main.lane_end) == (None, np.inf)
    assert ramp.plan(0.0) == [("j", "k", 0), ("k", "b", 0), ("b", "c", 1), ("c", "d", 1)]
    assert ramp.plan(ramp.lane_end - 30.0) == [("b", "c", 1), ("c", "d", 1)]
    assert ramp.plan(ramp.lane_end + 5.0) == [("c", "d", 1)]
    assert [ramp.changes_after(s) for s in (0.0, ramp.lane_end - 30.0, ramp.lane_end)] == [1, 1, 0]
    assert main.changes_after(0.0) == 0
