"""Any scenario of ours in highway-env's own environment, made of nothing but highway-env's own classes."""

from typing import Any

import numpy as np
from highway_env.envs.common.abstract import AbstractEnv
from highway_env.road.lane import AbstractLane, CircularLane, SineLane, StraightLane
from highway_env.road.regulation import RegulatedRoad
from highway_env.road.road import Road as StockRoad
from highway_env.road.road import RoadNetwork
from highway_env.vehicle.behavior import IDMVehicle
from highway_env.vehicle.controller import MDPVehicle
from highway_env.vehicle.kinematics import Vehicle
from highway_env.vehicle.objects import Obstacle

from codriving.datatypes.road import Arc, Lane, Road, Sine, beside
from codriving.datatypes.world import Kind, Start
from codriving.environment.environment import Environment
from codriving.environment.network import PAINT
from codriving.environment.traffic.route_following import route_path


class Stock(AbstractEnv):
    """highway-env's environment with the road, the vehicles and the frequencies of one of ours.

    Each CAV has an action and an observation of its own, as highway-env has it for several agents.

    Args:
        ours: Our environment.

    Attributes:
        named: Vehicles on the road, by id.
        cavs: Ids of those that are decided for.
    """

    def __init__(self, ours: Environment) -> None:
        self.ours, self.named, self.cavs = ours, dict[str, Vehicle](), list[str]()
        self._network = stock_network(ours.scenario.road)
        pace = ours.scenario.pace
        speeds = {"target_speeds": list(pace.target_speeds)}
        super().__init__(
            {
                "action": {
                    "type": "MultiAgentAction",
                    "action_config": {"type": "DiscreteMetaAction", **speeds},
                },
                "observation": {
                    "type": "MultiAgentObservation",
                    "observation_config": {"type": "Kinematics"},
                },
                "simulation_frequency": pace.simulation_frequency,
                "policy_frequency": pace.decision_frequency,
            }
        )

    def begin(self, seed: int) -> None:
        """Begin the episode of a seed.

        Args:
            seed: Seed of the scene and of the drivers' individual differences.
        """
        self._seed = seed
        self.reset(seed=seed)

    def decide(self, actions: dict[str, str]) -> None:
        """Take one decision.

        Args:
            actions: Name of the action of each CAV, by id.
        """
        numbers = self.action_type.agents_action_types[0].actions_indexes
        self.step(tuple(numbers[actions[name]] for name in self.cavs))

    def _reset(self) -> None:
        self.road, self.named = populated(self.ours, self._network, getattr(self, "_seed", 0))
        self.controlled_vehicles = [v for v in self.road.vehicles if isinstance(v, MDPVehicle)]
        self.cavs = [name for name, v in self.named.items() if isinstance(v, MDPVehicle)]

    def _reward(self, action: Any) -> float:  # noqa: ANN401
        return 0.0

    def _is_terminated(self) -> bool:
        return False

    def _is_truncated(self) -> bool:
        return False


def populated(ours: Environment, network: RoadNetwork, seed: int) -> tuple[StockRoad, dict[str, Vehicle]]:
    """Put a scene on highway-env's road.

    Args:
        ours: Our environment.
        network: The network of its road.
        seed: Seed of the scene.

    Returns:
        The road and the vehicles on it, by id.
    """
    rng = np.random.default_rng(np.random.SeedSequence(entropy=seed, spawn_key=(1,)))
    road = (RegulatedRoad if ours.scenario.road.regulated else StockRoad)(network, np_random=rng)
    for block in ours.scenario.road.blocks:
        road.objects.append(Obstacle(road, list(block.position), block.heading))
    vehicles = {start.id: _vehicle(ours, road, start) for start in ours.scenario.scene(seed).starts}
    road.vehicles += vehicles.values()
    return road, vehicles


def _vehicle(ours: Environment, road: StockRoad, start: Start) -> Vehicle:
    path, drivers = ours.road_map.paths[start.route], ours.drivers
    x, y = path.position(start.position)
    place, heading = [float(x), float(y)], float(path.heading(start.position))
    if start.kind is Kind.CAV:
        vehicle = MDPVehicle(road, place, heading, start.speed, target_speeds=list(ours.driving_model.target_speeds))
        vehicle.KP_A, vehicle.KP_HEADING = ours.control.speed, ours.control.heading
        vehicle.KP_LATERAL = ours.control.lateral
    else:
        vehicle = IDMVehicle(road, place, heading, start.speed)
        vehicle.COMFORT_ACC_MAX, vehicle.COMFORT_ACC_MIN = drivers.acceleration, -drivers.deceleration
        vehicle.ACC_MAX, vehicle.DISTANCE_WANTED = drivers.limit, drivers.jam_distance
        vehicle.TIME_WANTED, vehicle.POLITENESS = drivers.headway, drivers.politeness
        vehicle.LANE_CHANGE_MIN_ACC_GAIN = drivers.gain_threshold
        vehicle.LANE_CHANGE_MAX_BRAKING_IMPOSED = drivers.safe_braking
        vehicle.randomize_behavior()
    laid, graph = route_path(ours.road_map, start.route), road.network.graph
    bound = laid.route.lanes if laid.changes_after(start.position) else ()
    vehicle.route = [
        (a, b, k if len(graph[a][b]) == 1 or any(beside((a, b, k), lane) for lane in bound) else None)
        for a, b, k in laid.plan(start.position)
    ]
    return vehicle


def stock_network(road: Road) -> RoadNetwork:
    """Turn a road into highway-env's network of highway-env's own lanes.

    Args:
        road: The road as data.
    """
    network = RoadNetwork()
    for lane in road.lanes:
        network.add_lane(*lane.id[:2], _lane(lane))
    return network


def _lane(lane: Lane) -> AbstractLane:
    shape = lane.shape
    common = {
        "width": lane.width,
        "line_types": [PAINT[line] for line in lane.lines],
        "forbidden": lane.forbidden,
        "speed_limit": lane.speed_limit,
        "priority": lane.priority,
    }
    if isinstance(shape, Arc):
        return CircularLane(
            shape.center, shape.radius, shape.start_phase, shape.end_phase, clockwise=shape.clockwise, **common
        )
    if isinstance(shape, Sine):
        return SineLane(shape.start, shape.end, shape.amplitude, shape.pulsation, shape.phase, **common)
    return StraightLane(shape.start, shape.end, **common)
