"""A connected automated vehicle: highway-env's semantic actions, driven with the paper's gains."""

import math
from collections.abc import Mapping

from highway_env.road.road import Road
from highway_env.vehicle.controller import MDPVehicle

from codriving.datatypes import Action, ControlInput, Kind, Start
from codriving.environment.motion import clip
from codriving.environment.settings import ControlGains, Corrections
from codriving.environment.traffic.route_following import RouteFollower, RoutePath


class ConnectedVehicle(RouteFollower, MDPVehicle):
    """A vehicle that takes one of the five actions a decision (paper Section II and Eq. 1), HOLD, or a command."""

    kind = Kind.CAV
    may_hold: bool = False  # Whether HOLD is an action
    command: ControlInput | None = None  # What it carries out in the place of an action
    reckoned: float  # Where it was at the last decision, and how far it has driven since [m]

    @classmethod
    def start(
        cls,
        road: Road,
        start: Start,
        route_paths: Mapping[str, RoutePath],
        target_speeds: tuple[float, ...],
        gains: ControlGains,
        corrections: Corrections,
    ) -> "ConnectedVehicle":
        """Put a CAV on the road."""
        vehicle = cls.place(road, start, route_paths, corrections, target_speeds=list(target_speeds))
        gains.apply(vehicle)
        return vehicle

    def take(self, decision: Action | ControlInput) -> None:
        """Take a decision."""
        self.command = decision if isinstance(decision, ControlInput) else None
        if self.command is not None or decision in (Action.LANE_LEFT, Action.LANE_RIGHT):
            self.act(None if self.command is not None else str(decision))
            return
        # How it steers for that is worked out in the simulation step that follows.
        self._aim(str(decision))
        self.enter_next_lane()

    def act(self, action: str | None = None) -> None:
        """Take an action, or go on with the last decision."""
        if self.command is not None:
            # No faster than the highest target speed: others reckon with it.
            pedal = min(self.command.acceleration, self.KP_A * (float(self.target_speeds[-1]) - self.speed))
            steering = clip(self.command.steering, self.MAX_STEERING_ANGLE)
            self.action = {"steering": steering, "acceleration": pedal}
            return
        if action in (Action.LANE_LEFT, Action.LANE_RIGHT):
            super().act(action)
            if self.corrections.route_lane:
                self.follow_target_lane()
            self.reckoned = self.s
            return
        if action is not None:
            self._aim(action)
        self.action = {"steering": self.keep_lane(), "acceleration": self.speed_control(self.target_speed)}

    def _aim(self, action: str) -> None:
        """Choose the target speed by an action."""
        self.reckoned = self.s
        if action in (Action.FASTER, Action.SLOWER):
            # From the speed at which it drives, not from the target that it had; so does highway-env's MDPVehicle.
            self.speed_index = self.speed_to_index(self.speed) + (1 if action == Action.FASTER else -1)
            self.speed_index = min(max(self.speed_index, 0), len(self.target_speeds) - 1)
            self.target_speed = float(self.target_speeds[self.speed_index])
        elif action == Action.HOLD:
            self.target_speed = self.speed

    def before_step(self, dt: float) -> None:
        """Keep what was commanded within the limits; with a command, past what is planned for curves."""
        if self.command is None:
            super().before_step(dt)
        else:
            self.hold(math.inf, dt)

    def after_step(self) -> None:
        """Correct what the dynamics made of it; with a command, also where it is off its lane."""
        if self.command is None:
            super().after_step()
            return
        if self.corrections.no_reverse:
            self.speed = max(self.speed, 0.0)
        self.target_speed = self.speed
        if self.target_lane_index != self.lane_index:
            self.target_lane_index = self.lane_index
            if self.corrections.route_lane:
                self.follow_target_lane()

    def keeps_lane(self) -> bool:
        """Whether it steers by `keep_lane` when it goes on with its decision."""
        return self.command is None

    def odometer(self, dt: float) -> float:
        """Return its place on the route, reckoned from the last decision on: so it is predicted exactly [m]."""
        place = self.reckoned
        self.reckoned += self.speed * dt
        return place

    def speed_to_index(self, speed: float) -> int:
        """Return the number of the target speed that is closest to a speed [m/s]; target speeds are evenly spaced."""
        low, high, top = float(self.target_speeds[0]), float(self.target_speeds[-1]), len(self.target_speeds) - 1
        return min(max(round((speed - low) / (high - low) * top), 0), top)

    def available(self) -> tuple[Action, ...]:
        """Return the actions that the road allows now; speed can always be changed."""
        actions = [Action.SLOWER, Action.IDLE, *([Action.HOLD] * self.may_hold), Action.FASTER]
        start, end, index = self.target_lane_index
        lanes = self.road.network.graph[start][end]
        for action, other in ((Action.LANE_LEFT, index - 1), (Action.LANE_RIGHT, index + 1)):
            if 0 <= other < len(lanes) and lanes[other].is_reachable_from(self.position) and self.speed > 0:
                actions.append(action)
        return tuple(actions)
