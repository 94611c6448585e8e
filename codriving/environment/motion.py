"""highway-env's bicycle model and steering law in plain numbers: the same bits, without arrays of one element."""

import math
from collections.abc import Iterable, Sequence
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

    The trigonometry stays numpy's, since ``math`` rounds differently on some machines. It is worked out for all
    vehicles at once, which gives each the same bits as alone.
    """

    speed: float
    heading: float
    action: dict[str, float]
    impact: NDArray[np.float64] | None
    limits: VehicleLimits | None = None
    change_gains: tuple[float, float]  # Gains of heading and lateral offset while it changes lanes [1/s]
    changes: bool = False  # Whether it steers for a lane beside its own
    steers: float | None = None  # Angle of the front wheels with which it keeps its lane, if worked out already [rad]
    _faced: tuple[float, float, float] | None = None  # A heading [rad], its cosine and its sine

    def steering_control(self, target_lane_index: LaneId) -> float:
        """Return the angle of the front wheels [rad] (paper Eq. 1: delta = arcsin(K_h (phi_r - phi) l / 2v))."""
        lane = self.road.network.get_lane(target_lane_index)
        return steering([(self, lane, *lane.local_coordinates(self.position))])[0]

    def keep_lane(self) -> float:
        """Go on to the next lane where it is time to, and steer [rad]; `follow_road` and `steering_control` in one."""
        if self.steers is not None:
            known, self.steers = self.steers, None
            return known
        lane = self.road.network.get_lane(self.target_lane_index)
        s, lateral = lane.local_coordinates(self.position)
        if s > lane.length - lane.VEHICLE_LENGTH / 2:
            self.follow_road()
            return self.steering_control(self.target_lane_index)
        return steering([(self, lane, s, lateral)])[0]

    def enter_next_lane(self) -> None:
        """Go on to the next lane where it is time to; `follow_road` of highway-env."""
        lane = self.road.network.get_lane(self.target_lane_index)
        if lane.local_coordinates(self.position)[0] > lane.length - lane.VEHICLE_LENGTH / 2:
            self.follow_road()

    def keeps_lane(self) -> bool:
        """Whether it steers by `keep_lane` next."""
        raise NotImplementedError

    def facing(self) -> tuple[float, float]:
        """Return cosine and sine of the heading."""
        heading = float(self.heading)
        if self._faced is None or self._faced[0] != heading:
            self._faced = (heading, float(np.cos(heading)), float(np.sin(heading)))
        return self._faced[1:]

    @property
    def direction(self) -> NDArray[np.float64]:
        """Unit vector along the heading (2,)."""
        return np.array(self.facing())

    def commanded(self) -> float:
        """Return the angle of the front wheels [rad]; `clip_actions` of highway-env for one that can do as it wants."""
        if self.crashed or not self.MIN_SPEED <= self.speed <= self.MAX_SPEED:
            self.clip_actions()
            return self.action["steering"]
        action = self.action
        action["acceleration"] = float(action["acceleration"])
        action["steering"] = angle = float(action["steering"])
        return angle

    def moved_to(self, x: float, y: float) -> None:
        """Take note of a new place [m]."""
        self.on_state_update()

    def hold(self, most: float, dt: float) -> None:
        """Keep what was commanded within the limits, and the acceleration below a bound [m/s2].

        The tyres hold at both ends of a simulation step [s]: v times the yaw rate v sin(beta) / (l / 2).
        """
        limits = self.limits
        if limits is None:
            return
        pedal = min(max(min(float(self.action["acceleration"]), most), -limits.braking), limits.acceleration)
        squared = self.speed * max(self.speed, self.speed + pedal * dt)
        steering = float(self.action["steering"])
        if squared > (held := limits.lateral * self.LENGTH / 2):
            steering = clip(steering, math.atan(2 * math.tan(math.asin(held / squared))))
        self.action = {"steering": steering, "acceleration": pedal}


Steered = tuple[PlainMotion, AbstractLane, float, float]  # Vehicle and lane, arc length and lateral offset on it [m]


def steering(steered: Sequence[Steered]) -> list[float]:
    """Return the angles of the front wheels of vehicles that steer for lanes [rad]."""
    sideways, ahead = [], []
    for vehicle, lane, s, lateral in steered:
        own = vehicle.speed
        speed = own if abs(own) > STANDSTILL else math.copysign(STANDSTILL, own + 0.0)
        heading_gain, lateral_gain, look_ahead = vehicle.KP_HEADING, vehicle.KP_LATERAL, vehicle.TAU_PURSUIT
        if vehicle.limits is not None:
            vehicle.changes = abs(lateral) > (CHANGED if vehicle.changes else lane.width / 2)
            if vehicle.changes:
                heading_gain, lateral_gain = vehicle.change_gains
                look_ahead = 1 / heading_gain
        sideways.append(clip(-lateral_gain * float(lateral) / speed, 1.0))
        ahead.append((float(lane.heading_at(s + own * look_ahead)), vehicle.heading, heading_gain, speed))
    slips = []
    for (vehicle, *_), (bound, heading, gain, speed), aside in zip(
        steered, ahead, np.arcsin(sideways).tolist(), strict=True
    ):
        turn = bound + clip(aside, math.pi / 4) - heading
        rate = gain * (((turn + math.pi) % (2 * math.pi)) - math.pi)
        slips.append(clip(vehicle.LENGTH / 2 / speed * rate, 1.0))
    angles = np.arctan(2 * np.tan(np.arcsin(slips))).tolist()
    return [clip(angle, one[0].MAX_STEERING_ANGLE) for one, angle in zip(steered, angles, strict=True)]


def steer(vehicles: Iterable[PlainMotion]) -> None:
    """Work out with which angle of the front wheels vehicles keep their lanes, of those that keep them."""
    steered: list[Steered] = []
    for vehicle in vehicles:
        vehicle.steers = None
        if vehicle.keeps_lane():
            lane = vehicle.road.network.get_lane(vehicle.target_lane_index)
            s, lateral = lane.local_coordinates(vehicle.position)
            if s <= lane.length - lane.VEHICLE_LENGTH / 2:
                steered.append((vehicle, lane, s, lateral))
    if steered:
        for (vehicle, *_), angle in zip(steered, steering(steered), strict=True):
            vehicle.steers = angle


def face(vehicles: Sequence[PlainMotion]) -> None:
    """Work out the cosine and the sine of all headings that are new."""
    vehicles = [v for v in vehicles if v._faced is None or v._faced[0] != v.heading]
    headings = [float(vehicle.heading) for vehicle in vehicles]
    found = zip(vehicles, headings, np.cos(headings).tolist(), np.sin(headings).tolist(), strict=True)
    for vehicle, *faced in found:
        vehicle._faced = tuple(faced)


def move(vehicles: Sequence[PlainMotion], dt: float) -> None:
    """Integrate the bicycle model, position before heading (paper Eq. 1: beta = arctan(tan(delta) / 2))."""
    wheels = [vehicle.commanded() for vehicle in vehicles]
    betas = np.arctan(1 / 2 * np.tan(wheels))
    courses = np.array([vehicle.heading for vehicle in vehicles]) + betas
    turned = (np.cos(courses).tolist(), np.sin(courses).tolist(), np.sin(betas).tolist())
    for vehicle, cos, sin, yaw in zip(vehicles, *turned, strict=True):
        speed, place = vehicle.speed, vehicle.position
        x, y = place.tolist()
        x += speed * cos * dt
        y += speed * sin * dt
        place[0], place[1] = x, y
        if vehicle.impact is not None:
            vehicle.position += vehicle.impact
            vehicle.crashed = True
            vehicle.impact = None
            x, y = vehicle.position.tolist()
        vehicle.heading += speed * yaw / (vehicle.LENGTH / 2) * dt
        vehicle.speed += vehicle.action["acceleration"] * dt
        vehicle.moved_to(x, y)


def clip(value: float, most: float) -> float:
    """Keep a number within [-most, most]."""
    # Sooner than min and max.
    return -most if value < -most else most if value > most else value
