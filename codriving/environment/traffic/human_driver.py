"""A human driver: highway-env's IDM and MOBIL, with its faults corrected."""

import math
from collections.abc import Mapping, Sequence
from typing import Self

import numpy as np
from highway_env.road.road import Road
from highway_env.vehicle.behavior import IDMVehicle
from highway_env.vehicle.kinematics import Vehicle
from highway_env.vehicle.objects import Obstacle, RoadObject

from codriving.datatypes import BLOCKER, LaneId, Manner, Start
from codriving.environment.drivers.attention import DriverJudgement
from codriving.environment.drivers.body import Body
from codriving.environment.drivers.style import DriverMix, DriverTraits
from codriving.environment.motion import STANDSTILL, clip
from codriving.environment.settings import Corrections, DriverProfile
from codriving.environment.traffic.route_following import RouteFollower, RoutePath

CREEP = 1.0  # Below this speed a driver counts as standing [m/s]

GAP = 4.0  # Time gap before which a driver who stands starts onto the lane beside [s]; so long it is in the way


# How much earlier a driver with a style stops before the end of a lane, so that it can still turn out of it [m].
ROOM = 4.0


class HumanDriver(RouteFollower, IDMVehicle):
    """An uncontrolled vehicle that shares nothing and follows its own route."""

    by_idm = True
    waits_at: float | None = None  # Arc length of the line at which the driver has to wait [m], or None
    sight: float  # How far ahead along the route it looks for bodies [m]
    stands: float = 0.0  # How long it still stands before it drives [s]
    traits: DriverTraits | None = None
    judgement: DriverJudgement | None = None

    @classmethod
    def start(
        cls,
        road: Road,
        start: Start,
        route_paths: Mapping[str, RoutePath],
        profile: DriverProfile | DriverMix,
        corrections: Corrections,
        traits: DriverTraits | None = None,
    ) -> Self:
        """Put a human driver on the road; the start speed is the speed that the driver wants."""
        driver = cls.place(road, start, route_paths, corrections)
        driver.stands = start.stands
        if traits is not None:
            traits.profile.apply(driver, to_class=False)
            driver.sight, driver.DELTA, driver.target_speed = profile.sight, traits.exponent, start.speed * traits.speed
            driver.traits, driver.style, driver.signals = traits, traits.style, traits.signals
            driver.judgement = DriverJudgement(traits)
        else:
            assert isinstance(profile, DriverProfile)
            profile.apply(driver, to_class=not corrections.own_parameters)
            driver.sight = profile.sight
            driver.randomize_behavior()
        if start.stands > 0:
            driver.style = BLOCKER
            driver.target_speed = float(driver.lane.speed_limit) * (1.0 if traits is None else traits.speed)
        return driver

    @property
    def manner(self) -> Manner:
        """How it treats the right of way; without a style it keeps to the rules, and reacts at once."""
        if self.traits is None or self.judgement is None:
            return Manner("by_rule", hesitates=False, reaction=0.0)
        traits = self.traits
        return Manner(traits.gives_way, self.judgement.hesitates, traits.reaction, traits.distraction)

    def become(self, traits: DriverTraits) -> None:
        """Let another driver go on in its place, who has stood as long and signals alike; only of one with traits."""
        assert self.traits is not None
        assert self.judgement is not None
        traits.profile.apply(self, to_class=False)
        self.DELTA, stood = traits.exponent, self.judgement.stood
        self.target_speed *= traits.speed / self.traits.speed
        self.traits, self.judgement = traits, DriverJudgement(traits)
        self.judgement.stood = stood
        if self.style != BLOCKER:
            self.style = traits.style

    def act(self, action: dict[str, float] | str | None = None) -> None:
        """Steer along the route and follow the vehicle ahead on it."""
        if self.stands > 1e-9:
            self.action = {"steering": 0.0, "acceleration": 0.0}
            return
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

    def keeps_lane(self) -> bool:
        """Whether it steers by `keep_lane` when it acts."""
        return self.stands <= 1e-9 and self.corrections.route_leader and not self.crashed

    def before_step(self, dt: float) -> None:
        """Note that time passes [s], and keep what was commanded within the limits."""
        self.timer += dt
        self.stands = max(self.stands - dt, 0.0)
        if self.judgement is not None:
            self.judgement.watch(self, dt)
        super().before_step(dt)

    def following_acceleration(self) -> float:
        """Return IDM's acceleration to the nearest body on the route and the line to wait at, unclipped [m/s2]."""
        bodies = self.road.seen_by(self, None if self.traits is None else self.traits.reaction)
        leader, gap = body_ahead(self, bodies, self.sight)
        changing = self.lane_index != self.target_lane_index
        wanted = [0.0]
        if leader is not None and not (changing and self._leaves(leader[0])):
            # IDM counts from centre to centre; a body that crosses is met at its near side.
            wanted.append(self.gap_behind(leader) / max(gap + self.LENGTH, 0.01))
        lane_end = self.route_path.lane_end - (0.0 if self.traits is None else ROOM)
        if not changing and self.lane_index == self.route_path.ending and lane_end < self.s + self.sight:
            wanted.append(self._gap_at(self.speed) / max(lane_end - self.s - self.LENGTH / 2 + self.LENGTH, 0.01))
        if self.waits_at is not None:
            wanted.append(self._gap_at(self.speed) / max(self.waits_at - self.s + self.LENGTH / 2, 0.01))
        acceleration = float(self.free_acceleration() - self.COMFORT_ACC_MAX * max(wanted) ** 2)
        if changing:
            ahead, _ = self.road.neighbour_vehicles(self, self.target_lane_index)
            acceleration = min(acceleration, float(self.acceleration(ego_vehicle=self, front_vehicle=ahead)))
        return acceleration

    def gap_behind(self, leader: Body) -> float:
        """Return the gap that the driver wants behind a body, by how fast it is coming closer [m]."""
        *_, heading, speed = leader
        cos, sin = self.facing()
        x, y = self.speed * cos - speed * float(np.cos(heading)), self.speed * sin - speed * float(np.sin(heading))
        return self._gap_at(x * cos + y * sin)

    def _gap_at(self, closing: float, speed: float | None = None) -> float:
        """IDM's desired gap [m] at a closing speed [m/s]; of another vehicle than this one if its speed is given."""
        speed = self.speed if speed is None else speed
        comfort = 2 * math.sqrt(-self.COMFORT_ACC_MAX * self.COMFORT_ACC_MIN)
        return float(self.DISTANCE_WANTED + speed * self.TIME_WANTED + speed * closing / comfort)

    def desired_gap(self, ego_vehicle: Vehicle, front_vehicle: RoadObject, projected: bool = True) -> float:
        """Return IDM's desired gap [m], as highway-env works it out."""
        if not projected:
            return float(super().desired_gap(ego_vehicle, front_vehicle, projected))
        # The dot product of numpy, since plain products may be rounded differently from its fused ones.
        direction = ego_vehicle.direction
        closing = float((ego_vehicle.speed * direction - front_vehicle.velocity).dot(direction))
        return self._gap_at(closing, ego_vehicle.speed)

    def acceleration(
        self,
        ego_vehicle: Vehicle | None,
        front_vehicle: RoadObject | None = None,
        rear_vehicle: RoadObject | None = None,
    ) -> float:
        """Return the acceleration that IDM expects of a vehicle behind another one [m/s2], as highway-env does."""
        if not isinstance(ego_vehicle, RouteFollower):
            return float(super().acceleration(ego_vehicle, front_vehicle, rear_vehicle))
        wish, limit = ego_vehicle.target_speed, ego_vehicle.lane.speed_limit
        if limit is not None:
            wish = min(max(wish, 0), limit)
        pace = max(ego_vehicle.speed, 0) / max(abs(wish), STANDSTILL)
        acceleration = float(self.COMFORT_ACC_MAX * (1 - np.power(pace, self.DELTA)))
        if front_vehicle is not None:
            gap = ego_vehicle.lane_distance_to(front_vehicle)
            if abs(gap) <= STANDSTILL:
                gap = STANDSTILL if gap >= 0 else -STANDSTILL
            share = self.desired_gap(ego_vehicle, front_vehicle) / gap
            acceleration -= float(self.COMFORT_ACC_MAX * np.power(share, 2))
        return acceleration

    def free_acceleration(self) -> float:
        """Return IDM's acceleration on a free road [m/s2]: a (1 - (v / v_0)^delta)."""
        wish = max(min(max(self.target_speed, 0), self.lane.speed_limit), STANDSTILL)
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
        """Whether the vehicle behind on a lane is far enough away; MOBIL only minds how hard it had to brake now."""
        _, behind = self.road.neighbour_vehicles(self, lane_index)
        return behind is None or behind.lane_distance_to(self) - self.LENGTH > behind.speed * GAP


BODY_MARGIN = 0.6  # Lateral room that a driver wants beside a body before it counts as out of the way [m]

ROUNDING = 1e-6  # More than what the place of a body on a straight line may be rounded by [m]

LARGE = 8.0  # Longer bodies may be in the way even if their centre is not near it [m]


def body_ahead(driver: RouteFollower, bodies: Sequence[Body], sight: float) -> tuple[Body | None, float]:
    """Find the nearest body on the route of a driver."""
    route_path, end = driver.route_path, len(driver.route_path.points) - 2
    first = _row((driver.s - driver.LENGTH) / route_path.spacing, end)
    last = _row((driver.s + sight) / route_path.spacing, end)
    # The quick look must leave out no body that could be in the way; it doesn't know large bodies, other lanes than
    # that of the route, nor what lies beyond the end of the route.
    plain = abs(driver.shift) < 0.5 and last < end
    x, y = driver.position.tolist()
    seen = []
    for one in bodies:
        thing, px, py, _, _ = one
        if thing is driver or not thing.solid or math.hypot(px - x, py - y) >= sight:
            continue
        if not plain or thing.LENGTH > LARGE or route_path.is_near(px, py):
            seen.append(one)
    best: tuple[Body | None, float] = (None, math.inf)
    if not seen:
        return best
    if route_path.is_straight:
        return _ahead_on_straight(driver, seen, first, last, end)
    rows = slice(first, last + 2)
    places = np.array([one[1:3] for one in seen])
    dx, dy = route_path.x[rows] - places[:, :1], route_path.y[rows] - places[:, 1:]
    for one, k in zip(seen, (dx * dx + dy * dy).argmin(axis=1).tolist(), strict=True):
        if 0 < k == last + 1 - first and last < end:
            continue
        gap = _gap(driver, one, first + k)
        if gap < best[1]:
            best = (one, gap)
    return best


def _ahead_on_straight(
    driver: RouteFollower, seen: Sequence[Body], first: int, last: int, end: int
) -> tuple[Body | None, float]:
    """Find the nearest body on a straight route, between two of its points; where each is tells which need a look."""
    route_path = driver.route_path
    (x, y), (cos, sin), heading = route_path.points[0], route_path.directions[0], route_path.headings[0]
    near = []
    for number, one in enumerate(seen):
        thing, px, py, turned, _ = one
        dx, dy = px - x, py - y
        along = dx * cos + dy * sin
        half, side = thing.LENGTH / 2, thing.WIDTH / 2
        # No box reaches farther to the side than this: the sine of an angle is no more than the angle.
        reach = driver.WIDTH / 2 + min(abs(turned - heading), 1.0) * half + side + BODY_MARGIN
        if along > driver.s - ROUNDING and abs(dy * cos - dx * sin - driver.shift) <= reach + ROUNDING:
            near.append((along - half - side, number))
    best, ahead, found = math.inf, -1, None
    for least, number in sorted(near):
        if least - driver.s - driver.LENGTH / 2 > best + ROUNDING:
            break
        one = seen[number]
        k = route_path.path.nearest_on_straight(one[1], one[2], first, last + 1)
        if first < k == last + 1 and last < end:
            continue
        gap = _gap(driver, one, k)
        if gap < best or (gap == best < math.inf and number < ahead):
            best, ahead, found = gap, number, one
    return found, best


def _gap(driver: RouteFollower, one: Body, k: int) -> float:
    """Free distance to a body closest to the k-th point of the route [m]; inf if it isn't ahead and in the way."""
    route_path = driver.route_path
    thing, x, y, turned, _ = one
    dx, dy = x - route_path.points[k][0], y - route_path.points[k][1]
    heading, (cos, sin) = route_path.headings[k], route_path.directions[k]
    across = abs(dy * cos - dx * sin - driver.shift)
    ahead = k * route_path.spacing + (dx * cos + dy * sin) - driver.s
    half, side = thing.LENGTH / 2, thing.WIDTH / 2
    # However the body is turned, farther to the side than this it could not be in the way.
    if ahead <= 0 or across > driver.WIDTH / 2 + half + side + BODY_MARGIN:
        return math.inf
    turn = turned - heading
    c, s = abs(float(np.cos(turn))), abs(float(np.sin(turn)))
    if across > driver.WIDTH / 2 + (s * half + c * side) + BODY_MARGIN:
        return math.inf
    return float(ahead - (c * half + s * side) - driver.LENGTH / 2)


def _row(row: float, end: int) -> int:
    return int(min(max(row, 0), end))
