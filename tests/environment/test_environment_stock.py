"""With every correction off, each vehicle moves as in highway-env, bit for bit."""

from collections.abc import Callable
from dataclasses import fields

import numpy as np
import pytest
from highway_env.envs.intersection_env import IntersectionEnv
from highway_env.road.regulation import RegulatedRoad
from highway_env.vehicle.behavior import IDMVehicle
from highway_env.vehicle.controller import MDPVehicle
from highway_env.vehicle.kinematics import Vehicle
from thorough import some

from benchmarks.stock import populated, stock_network
from codriving.datatypes.world import Kind
from codriving.environment.cav import ConnectedVehicle
from codriving.environment.environment import Environment, spawn
from codriving.environment.network import build_network
from codriving.environment.settings import Corrections
from codriving.environment.traffic.route_following import route_path
from codriving.environment.traffic.traffic import Traffic

OFF = tuple(field.name for field in fields(Corrections))
SECONDS, SUBSTEPS, DT = 20, 5, 0.1
WEIGHTS = {"SLOWER": 0.35, "IDLE": 0.25, "FASTER": 0.4}


def stock_road(env: Environment, seed: int) -> tuple[RegulatedRoad, dict[str, Vehicle]]:
    """The same scene with nothing but highway-env's own classes, on the network that its environment makes."""
    maker = object.__new__(IntersectionEnv)
    maker.config = IntersectionEnv.default_config()
    maker._make_road()
    rng = np.random.default_rng(np.random.SeedSequence(entropy=seed, spawn_key=(1,)))
    road, vehicles = RegulatedRoad(maker.road.network, np_random=rng), {}
    drivers = env.drivers
    for start in env.scenario.scene(seed).starts:
        path = env.road_map.paths[start.route]
        x, y = path.position(start.position)
        place, heading = [float(x), float(y)], float(path.heading(start.position))
        if start.kind is Kind.CAV:
            speeds = list(env.driving_model.target_speeds)
            vehicle = MDPVehicle(road, place, heading, start.speed, target_speeds=speeds)
            vehicle.KP_A, vehicle.KP_HEADING = env.control.speed, env.control.heading
            vehicle.KP_LATERAL = env.control.lateral
        else:
            vehicle = IDMVehicle(road, place, heading, start.speed)
            vehicle.COMFORT_ACC_MAX, vehicle.COMFORT_ACC_MIN = drivers.acceleration, -drivers.deceleration
            vehicle.ACC_MAX, vehicle.DISTANCE_WANTED = drivers.limit, drivers.jam_distance
            vehicle.TIME_WANTED, vehicle.POLITENESS = drivers.headway, drivers.politeness
            vehicle.LANE_CHANGE_MIN_ACC_GAIN = drivers.gain_threshold
            vehicle.LANE_CHANGE_MAX_BRAKING_IMPOSED = drivers.safe_braking
            vehicle.randomize_behavior()
        vehicle.route = list(env.road_map.routes[start.route].lanes)
        road.vehicles.append(vehicle)
        vehicles[start.id] = vehicle
    return road, vehicles


def our_road(env: Environment, seed: int) -> Traffic:
    rng = np.random.default_rng(np.random.SeedSequence(entropy=seed, spawn_key=(1,)))
    traffic = Traffic(build_network(env.scenario.road), rng, env.road_map, env.corrections)
    route_paths = {name: route_path(env.road_map, name) for name in env.road_map.routes}
    spawn(traffic, env.scenario.scene(seed), route_paths, env.driving_model.target_speeds, env.control, env.drivers)
    return traffic


def state(vehicle: Vehicle) -> tuple[float, float, float, float, bool]:
    return (*map(float, vehicle.position), float(vehicle.heading), float(vehicle.speed), vehicle.crashed)


@pytest.mark.usefixtures("clean_class")
@pytest.mark.parametrize("seed", some(3, range(5)))
def test_trajectories_are_the_same_bits(seed: int, intersection: Callable[..., Environment]) -> None:
    env = intersection(*OFF)
    road, theirs = stock_road(env, seed)
    traffic = our_road(env, seed)
    ours = {vehicle.id: vehicle for vehicle in traffic.vehicles}
    assert list(ours) == list(theirs)
    rng = np.random.default_rng(seed)
    for _ in range(round(SECONDS / SUBSTEPS / DT)):
        # As AbstractEnv._simulate does: the actions first, then every frame acts and steps.
        for name, vehicle in ours.items():
            if isinstance(vehicle, ConnectedVehicle):
                action = str(rng.choice(list(WEIGHTS), p=list(WEIGHTS.values())))
                vehicle.act(action)
                theirs[name].act(action)
        for _ in range(SUBSTEPS):
            for simulated in (traffic, road):
                simulated.act()
                simulated.step(DT)
            assert {n: state(v) for n, v in ours.items()} == {n: state(v) for n, v in theirs.items()}


@pytest.mark.usefixtures("clean_class")
@pytest.mark.parametrize("seed", some(1, range(3)))
@pytest.mark.parametrize("name", ["roundabout", "highway", "merge"])
def test_so_they_are_on_every_road(name: str, seed: int, configured: Callable[..., Environment]) -> None:
    env = configured(f"scenario={name}", *(f"environment.corrections.{switch}=false" for switch in OFF))
    road, theirs = populated(env, stock_network(env.scenario.road), seed)
    traffic = our_road(env, seed)
    ours = {vehicle.id: vehicle for vehicle in traffic.vehicles}
    rng = np.random.default_rng(seed)
    changes = 0
    for _ in range(round(SECONDS / SUBSTEPS / DT)):
        for vehicle in ours.values():
            if isinstance(vehicle, ConnectedVehicle):
                action = str(rng.choice(vehicle.available()))
                changes += action.startswith("LANE")
                vehicle.act(action)
                theirs[vehicle.id].act(action)
        for _ in range(SUBSTEPS):
            for simulated in (traffic, road):
                simulated.act()
                simulated.step(DT)
            assert {n: state(v) for n, v in ours.items()} == {n: state(v) for n, v in theirs.items()}
            assert {n: v.lane_index for n, v in ours.items()} == {n: v.lane_index for n, v in theirs.items()}
    assert (changes > 5) == (name != "roundabout")


@pytest.mark.usefixtures("clean_class")
def test_environment_drives_the_same_way(intersection: Callable[..., Environment]) -> None:
    env = intersection(*OFF)
    world = env.reset(0)
    road, theirs = stock_road(env, 0)
    for _ in range(8):
        world = env.step({cav.id: world.available[cav.id][0] for cav in world.cavs})
        for cav in theirs:
            if isinstance(theirs[cav], MDPVehicle):
                theirs[cav].act("SLOWER")
        for _ in range(SUBSTEPS):
            road.act()
            road.step(DT)
        for seen in world.vehicles:
            assert (seen.x, seen.y, seen.heading, seen.speed) == state(theirs[seen.id])[:4]
    assert env.outcome is None
