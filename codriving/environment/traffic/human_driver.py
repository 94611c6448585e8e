"""A human driver: highway-env's IDM and MOBIL, with its faults corrected."""

import math
from collections.abc import Mapping

import numpy as np
from highway_env.road.road import Road
from highway_env.vehicle.behavior import IDMVehicle
from highway_env.vehicle.objects import Obstacle, RoadObject

from codriving.datatypes.road import LaneId
from codriving.datatypes.scene import Start
from codriving.environment.corrections import Corrections
from codriving.environment.motion import STANDSTILL, clip
from codriving.environment.traffic.body_ahead import body_ahead
from codriving.environment.traffic.driver_profile import DriverProfile
from codriving.environment.traffic.on_way import OnWay
from codriving.environment.traffic.way import Way

CREEP = 1.0
"""Below this speed a driver counts as standing [m/s]."""

GAP = 4.0
"""Time gap before which a driver who stands starts onto the lane beside [s]; so long it is in the way."""


class HumanDriver(OnWay, IDMVehicle):
    """An uncontrolled vehicle that shares nothing and follows its own route.

    Attributes:
        waits_at: Arc length of the line at which the driver has been told to wait [m], or None.
        sight: How far ahead along the route it looks for bodies [m].
    """

    waits_at: float | None = None
    sight: float

    @classmethod
    def start(
        cls, road: Road, start: Start, ways: Mapping[str, Way], profile: DriverProfile, corrections: Corrections
    ) -> "HumanDriver":
        """Put a human driver on the road; the start speed is the speed that the driver wants."""
        way = ways[start.route]
        x, y = way.path.position(start.position)
        heading = float(way.path.heading(start.position))
        driver = cls(road, [float(x), float(y)], heading, start.speed)
        driver.take_way(start, ways, corrections)
        profile.apply(driver, to_class=not corrections.own_parameters)
        driver.sight = profile.sight
        driver.randomize_behavior()
        return driver

    def act(self, action: dict[str, float] | str | None = None) -> None:
        """Steer along the route and follow whoever is ahead on it."""
        if not self.corrections.route_leader or self.crashed:
            super().act(action)
            return
        steering = self.keep_lane()
        lane = self.target_lane_index
        if self.enable_lane_change:
            self.change_lane_policy()
        if self.target_lane_index != lane:
            steering = self.steering_control(self.target_lane_index)
            if self.corrections.route_lane:
                self.follow_target_lane()
        self.action = {"steering": steering, "acceleration": clip(self.following_acceleration(), self.ACC_MAX)}

    def step(self, dt: float) -> None:
        """Move by one simulation step.

        Args:
            dt: Simulation step [s].
        """
        self.timer += dt
        super().step(dt)

    def following_acceleration(self) -> float:
        """Return IDM's acceleration behind the nearest body on the route, and before the line to wait at.

        Returns:
            Acceleration before clipping [m/s2].
        """
        leader, gap = body_ahead(self, self.road.vehicles + self.road.objects, self.sight)
        changing = self.lane_index != self.target_lane_index
        wanted = [0.0]
        if leader is not None and not (changing and self._leaves(leader)):
            # IDM counts from centre to centre; a body that crosses is met at its near side.
            wanted.append(self.gap_behind(leader) / max(gap + self.LENGTH, 0.01))
        if not changing and self.lane_index == self.way.ending and self.way.lane_end < self.s + self.sight:
            room = self.way.lane_end - self.s - self.LENGTH / 2
            wanted.append(self._gap_at(self.speed) / max(room + self.LENGTH, 0.01))
        if self.waits_at is not None:
            wanted.append(self._gap_at(self.speed) / max(self.waits_at - self.s + self.LENGTH / 2, 0.01))
        acceleration = float(self.free_acceleration() - self.COMFORT_ACC_MAX * max(wanted) ** 2)
        if changing:
            ahead, _ = self.road.neighbour_vehicles(self, self.target_lane_index)
            acceleration = min(acceleration, float(self.acceleration(ego_vehicle=self, front_vehicle=ahead)))
        return acceleration

    def gap_behind(self, leader: RoadObject) -> float:
        """Return the gap that the driver wants behind a body, by how fast it is coming closer [m]."""
        cos, sin = float(np.cos(self.heading)), float(np.sin(self.heading))
        x = self.speed * cos - leader.speed * float(np.cos(leader.heading))
        y = self.speed * sin - leader.speed * float(np.sin(leader.heading))
        return self._gap_at(x * cos + y * sin)

    def _gap_at(self, closing: float) -> float:
        """IDM's desired gap [m] at a closing speed [m/s]."""
        comfort = 2 * math.sqrt(-self.COMFORT_ACC_MAX * self.COMFORT_ACC_MIN)
        return float(self.DISTANCE_WANTED + self.speed * self.TIME_WANTED + self.speed * closing / comfort)

    def free_acceleration(self) -> float:
        """Return IDM's acceleration on a free road [m/s2]: a (1 - (v / v_0)^delta)."""
        wish = min(max(self.target_speed, 0), self.lane.speed_limit)
        wish = wish if wish > STANDSTILL else STANDSTILL
        return float(self.COMFORT_ACC_MAX * (1 - np.power(max(self.speed, 0) / wish, self.DELTA)))

    def _leaves(self, leader: RoadObject) -> bool:
        """Whether a driver who changes lanes may forget what is ahead: standing at an obstacle, it never got away."""
        return self.corrections.start_into_gap and self.speed < CREEP and isinstance(leader, Obstacle)

    def change_lane_policy(self) -> None:
        """Decide on a lane change by MOBIL, also from a standstill if that is corrected."""
        if self.corrections.start_into_gap and self.speed < CREEP and self.lane_index == self.target_lane_index:
            for lane_index in self.road.network.side_lanes(self.lane_index):
                lane = self.road.network.get_lane(lane_index)
                if lane.is_reachable_from(self.position) and self._finds_gap(lane_index) and self.mobil(lane_index):
                    self.target_lane_index = lane_index
            return
        super().change_lane_policy()

    def _finds_gap(self, lane_index: LaneId) -> bool:
        """Whether whoever comes on a lane is far enough behind; MOBIL only minds how hard it had to brake now."""
        _, behind = self.road.neighbour_vehicles(self, lane_index)
        return behind is None or behind.lane_distance_to(self) - self.LENGTH > behind.speed * GAP
