"""highway-env's bicycle model and steering law in plain numbers: the same bits, without arrays of one element."""

import math
from typing import TYPE_CHECKING

import numpy as np
from highway_env.road.lane import AbstractLane
from numpy.typing import NDArray

from codriving.datatypes import LaneId, VehicleLimits

if TYPE_CHECKING:
    from highway_env.vehicle.controller import ControlledVehicle as _Base
else:
    _Base = object

CHANGED = 0.25  # A vehicle this close to the centre of a lane has finished changing to it [m]

STANDSTILL = 1e-2  # Speeds are taken at least this large where something is divided by them, as highway-env does [m/s]


class PlainMotion(_Base):
    """Mixin over highway-env's controlled vehicles: how they steer and how they move.

    The trigonometry stays numpy's, since ``math`` rounds differently on some machines.
    """

    speed: float
    heading: float
    action: dict[str, float]
    impact: NDArray[np.float64] | None
    limits: VehicleLimits | None = None
    change_gains: tuple[float, float]  # Gains of heading and lateral offset while it changes lanes [1/s]
    changes: bool = False  # Whether it steers for a lane beside its own

    def steering_control(self, target_lane_index: LaneId) -> float:
        """Return the angle of the front wheels [rad] (paper Eq. 1: delta = arcsin(K_h (phi_r - phi) l / 2v))."""
        lane = self.road.network.get_lane(target_lane_index)
        return self._steer(lane, *lane.local_coordinates(self.position))

    def keep_lane(self) -> float:
        """Go on to the next lane where it is time to, and steer [rad]; `follow_road` and `steering_control` in one."""
        lane = self.road.network.get_lane(self.target_lane_index)
        s, lateral = lane.local_coordinates(self.position)
        if s > lane.length - lane.VEHICLE_LENGTH / 2:
            self.follow_road()
            return self.steering_control(self.target_lane_index)
        return self._steer(lane, s, lateral)

    def _steer(self, lane: AbstractLane, s: float, lateral: float) -> float:
        speed = self.speed if abs(self.speed) > STANDSTILL else math.copysign(STANDSTILL, self.speed + 0.0)
        heading_gain, lateral_gain, look_ahead = self.KP_HEADING, self.KP_LATERAL, self.TAU_PURSUIT
        if self.limits is not None:
            self.changes = abs(lateral) > (CHANGED if self.changes else lane.width / 2)
            if self.changes:
                heading_gain, lateral_gain = self.change_gains
                look_ahead = 1 / heading_gain
        sideways = float(np.arcsin(clip(-lateral_gain * float(lateral) / speed, 1.0)))
        turn = float(lane.heading_at(s + self.speed * look_ahead)) + clip(sideways, math.pi / 4) - self.heading
        rate = heading_gain * (((turn + math.pi) % (2 * math.pi)) - math.pi)
        slip = np.arcsin(clip(self.LENGTH / 2 / speed * rate, 1.0))
        return clip(float(np.arctan(2 * float(np.tan(slip)))), self.MAX_STEERING_ANGLE)

    def move(self, dt: float) -> None:
        """Integrate the bicycle model, position before heading (paper Eq. 1: beta = arctan(tan(delta) / 2))."""
        self.clip_actions()
        beta = float(np.arctan(1 / 2 * float(np.tan(self.action["steering"]))))
        course = self.heading + beta
        self.position[0] += self.speed * float(np.cos(course)) * dt
        self.position[1] += self.speed * float(np.sin(course)) * dt
        if self.impact is not None:
            self.position += self.impact
            self.crashed = True
            self.impact = None
        self.heading += self.speed * float(np.sin(beta)) / (self.LENGTH / 2) * dt
        self.speed += self.action["acceleration"] * dt
        self.on_state_update()

    def hold(self, most: float, dt: float) -> None:
        """Keep what was commanded within the limits, and the acceleration below a bound [m/s2].

        The tyres hold at both ends of a simulation step [s]: v times the yaw rate v sin(beta) / (l / 2).
        """
        if self.limits is None:
            return
        pedal = min(max(min(float(self.action["acceleration"]), most), -self.limits.braking), self.limits.acceleration)
        squared = self.speed * max(self.speed, self.speed + pedal * dt)
        steering = float(self.action["steering"])
        if squared > (held := self.limits.lateral * self.LENGTH / 2):
            steering = clip(steering, math.atan(2 * math.tan(math.asin(held / squared))))
        self.action = {"steering": steering, "acceleration": pedal}


def clip(value: float, most: float) -> float:
    """Keep a number within [-most, most]."""
    return min(max(value, -most), most)
