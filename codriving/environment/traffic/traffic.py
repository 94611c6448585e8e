"""The road of highway-env with its right of way, its neighbours and its collisions corrected."""

import math
from itertools import combinations
from typing import Any

import numpy as np
from highway_env.road.lane import AbstractLane
from highway_env.road.regulation import RegulatedRoad
from highway_env.road.road import LaneIndex, RoadNetwork
from highway_env.vehicle.kinematics import Vehicle
from highway_env.vehicle.objects import Landmark, Obstacle, RoadObject

from codriving.datatypes import Block
from codriving.environment.drivers.attention import Past, look_round
from codriving.environment.drivers.body import Body, body
from codriving.environment.motion import face, move, steer
from codriving.environment.network import connected
from codriving.environment.settings import Corrections
from codriving.environment.traffic.hidden import Hidden, hidden_vehicles
from codriving.environment.traffic.human_driver import HumanDriver
from codriving.environment.traffic.right_of_way import Ahead, can_wait, meet, occupied_ahead
from codriving.environment.traffic.route_following import RouteFollower
from codriving.geometry import RoadMap

ATTENTION = 5  # How often a driver looks for other vehicles [Hz]


class Traffic(RegulatedRoad):
    """All bodies on the road, and the rules that human drivers obey."""

    def __init__(
        self,
        network: RoadNetwork,
        np_random: np.random.Generator,
        road_map: RoadMap,
        corrections: Corrections,
        styled: bool = False,
    ) -> None:
        super().__init__(network, np_random=np_random)
        self.past = Past() if styled else None  # What drivers with a style have seen
        self.road_map, self.corrections = road_map, corrections
        self.objects = [_obstacle(self, block) for block in road_map.road.blocks]
        self._connected: dict[tuple[Any, ...], list[tuple[AbstractLane, float]]] = {}
        self._hidden: Hidden | None = None

    @property
    def hidden(self) -> Hidden:
        """The vehicles that cannot see one another now, worked out once a simulation step."""
        if self._hidden is None:
            self._hidden = hidden_vehicles(self.road_map, self.vehicles)
        return self._hidden

    def exchange(self, vehicles: list[RouteFollower]) -> None:
        """Put other vehicles in the place of all that are there."""
        self.vehicles[:] = vehicles
        self._hidden = None

    def seen_by(self, driver: RouteFollower, reaction: float | None) -> list[Body]:
        """Return the bodies that a driver sees, vehicles as they are or as they were a reaction time [s] ago."""
        if reaction is not None and self.past is not None:
            seen = self.past.seen(driver, self.vehicles, reaction, self.hidden)
        else:
            unseen = self.hidden.get(driver, ())
            seen = [body(v) for v in self.vehicles if v is not driver and v not in unseen]
        return [*seen, *map(body, self.objects)] if self.objects else seen

    def act(self) -> None:
        """Let all vehicles decide what they do in the next simulation step."""
        steer(self.vehicles)
        face(self.vehicles)
        super().act()

    def step(self, dt: float) -> None:
        """Move all vehicles by one simulation step [s]."""
        if not self.corrections.true_collisions:
            super().step(dt)
            self._hidden = None
            return
        self.steps += 1
        # A driver who looks only twice a second is in the way before it can wait.
        frequency = ATTENTION if self.corrections.yield_at_entry else self.REGULATION_FREQUENCY
        every = max(int(1 / dt / frequency), 1)
        if self.past is not None:
            if self.steps % every == 0 and self.road_map.road.regulated:
                look_round(self.road_map, self.vehicles, every * dt, self.hidden)
            self.past.note(self.vehicles, dt, self.hidden)
        elif self.steps % every == 0:
            self.enforce_road_rules()
        for vehicle in self.vehicles:
            vehicle.before_step(dt)
        move(self.vehicles, dt)
        for vehicle in self.vehicles:
            vehicle.after_step()
        face(self.vehicles)
        self._hidden = None

    def enforce_road_rules(self) -> None:
        """Tell drivers of lower priority to wait, at the entry of the junction only if that is corrected.

        CAVs are not made to wait, as in highway-env: they must treat the right of way by their own reasoning.
        """
        if not self.road_map.road.regulated:
            return
        if not self.corrections.yield_at_entry:
            super().enforce_road_rules()
            return
        for vehicle in self.vehicles:
            if isinstance(vehicle, HumanDriver):
                if vehicle.waits_at is not None:
                    vehicle.target_speed = vehicle.lane.speed_limit
                vehicle.waits_at = None
        # Where each may be soon is worked out once, since nothing below changes it.
        soon = {vehicle: Ahead(vehicle) for vehicle in self.vehicles} if self.corrections.route_prediction else {}
        for one, other in combinations(self.vehicles, 2):
            if not (isinstance(one, HumanDriver) or isinstance(other, HumanDriver)):
                continue
            if other in self.hidden.get(one, ()):
                continue
            if soon:
                if not meet(self.road_map, soon[one], soon[other]):
                    continue
            elif not self.is_conflict_possible(one, other):
                continue
            yielding = self.respect_priorities(one, other)
            # A vehicle in the junction cannot give way any more; then the other one does.
            for vehicle in (yielding, other if yielding is one else one):
                if isinstance(vehicle, HumanDriver) and can_wait(vehicle):
                    vehicle.waits_at = vehicle.route_path.route.entry
                    break
                if not isinstance(vehicle, HumanDriver) and vehicle.s < vehicle.route_path.route.entry:
                    break
        for vehicle in self.vehicles:
            if isinstance(vehicle, HumanDriver) and vehicle.waits_at is None:
                seen = [other for other in self.vehicles if other not in self.hidden.get(vehicle, ())]
                place = occupied_ahead(self.road_map, vehicle, seen)
                if place is not None:
                    vehicle.waits_at = place + vehicle.DISTANCE_WANTED - vehicle.LENGTH / 2

    def is_conflict_possible(self, v1: RouteFollower, v2: RouteFollower) -> bool:
        """Whether two vehicles would meet within three seconds at constant speed, along their routes if corrected."""
        if self.corrections.route_prediction:
            return meet(self.road_map, Ahead(v1), Ahead(v2))
        return bool(RegulatedRoad.is_conflict_possible(v1, v2))

    def neighbour_vehicles(
        self, vehicle: Vehicle, lane_index: LaneIndex | None = None
    ) -> tuple[RoadObject | None, RoadObject | None]:
        """Find the vehicles ahead and behind on a lane and on the lanes physically connected to it."""
        index = lane_index or vehicle.lane_index
        if not self.corrections.connected_lanes or not index:
            return super().neighbour_vehicles(vehicle, lane_index)  # type: ignore[no-any-return]
        lane = self.network.get_lane(index)
        own = lane.local_coordinates(vehicle.position)[0]
        pieces = [(lane, 0.0), *self._connections(index, vehicle)]
        ahead: tuple[RoadObject | None, float] = (None, math.inf)
        behind: tuple[RoadObject | None, float] = (None, -math.inf)
        for other in [*self.vehicles, *self.objects]:
            if other is vehicle or isinstance(other, Landmark):
                continue
            for piece, offset in pieces:
                s, lateral = piece.local_coordinates(other.position)
                beyond = piece.VEHICLE_LENGTH
                # As `on_lane` of highway-env, with a margin of a metre.
                if not (abs(lateral) <= piece.width_at(s) / 2 + 1 and -beyond <= s < piece.length + beyond):
                    continue
                distance = s + offset - own
                if 0 <= distance <= ahead[1]:
                    ahead = (other, distance)
                elif distance < 0 and distance > behind[1]:
                    behind = (other, distance)
                break
        return ahead[0], behind[0]

    def _connections(self, index: LaneIndex, vehicle: Vehicle) -> list[tuple[AbstractLane, float]]:
        """The lanes connected to a lane, on the branch that a vehicle takes; worked out once."""
        planned = tuple(to for start, to, _ in getattr(vehicle, "route", None) or () if start == index[1])
        key = (*index, *planned)
        if key not in self._connected:
            self._connected[key] = connected(self.network, index, planned)
        return self._connected[key]


def _obstacle(road: Traffic, block: Block) -> Obstacle:
    obstacle = Obstacle(road, list(block.position), block.heading)
    obstacle.LENGTH, obstacle.WIDTH = block.length, block.width
    obstacle.diagonal = math.hypot(block.length, block.width)
    return obstacle
