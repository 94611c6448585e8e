"""What a joint plan is worth to each vehicle: how near it gets to its destination, or a utility of three terms."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from codriving.datatypes import ApproachingVehicle, Instance
from codriving.reasoning import JointPlan, JointPlanner

# Drivers are indifferent about the order if the distance of the one that turns is 1.44 times that of the one that goes
# straight, less 25.4 m (fit of the source).
SLOPE, OFFSET = 1.44, 25.4

NEAREST = 1.0  # Distance to the destination below which a vehicle counts as being there [m]


class Goal(StrEnum):
    """What is summed up over all vehicles."""

    INVERSE_DISTANCE = "inverse_distance"
    UTILITY = "utility"


class Scale(StrEnum):
    """Which distances are put on the scale of the others before they are added."""

    TURNING = "turning"
    STRAIGHT = "straight"
    NONE = "none"


def on_one_scale(distance: float, turning: bool, scale: Scale) -> float:
    """Return a distance on the common scale of vehicles that turn and vehicles that go straight [m]."""
    if scale is Scale.TURNING and turning:
        return max((distance + OFFSET) / SLOPE, NEAREST)
    if scale is Scale.STRAIGHT and not turning:
        return max(SLOPE * distance - OFFSET, NEAREST)
    return max(distance, NEAREST)


@dataclass(frozen=True, slots=True)
class Payoff:
    """What a joint plan is worth to each vehicle."""

    objective: Goal
    scale: Scale
    efficiency: float
    comfort: float
    safety: float
    reference_acceleration: float  # Acceleration that costs the whole weight of comfort [m/s2]
    risk_time: float  # Gap in time at which the risk has fallen to 1/e [s]

    def of(self, instance: Instance, plan: JointPlan, planner: JointPlanner, ahead: float = 0.0) -> dict[str, float]:
        """Return what a plan is worth to each vehicle, by id."""
        kinds = {vehicle.turning for vehicle in instance.vehicles.values()}
        # Distances are only changed where some turn and others do not.
        scale = self.scale if len(kinds) == 2 else Scale.NONE
        found = {}
        for name, vehicle in instance.vehicles.items():
            left = self._left(vehicle, plan, ahead)
            if self.objective is Goal.INVERSE_DISTANCE:
                found[name] = 1 / on_one_scale(left, vehicle.turning, scale)
            else:
                found[name] = self._utility(instance, vehicle, left, plan, planner)
        return found

    def gain(
        self, instance: Instance, plan: JointPlan, planner: JointPlanner, payoffs: Mapping[str, float], time: float
    ) -> float:
        """Return what a vehicle gains on average by being farther along its plan."""
        later = self.of(instance, plan, planner, time)
        return sum(later[name] - payoffs[name] for name in later) / len(later)

    def _left(self, vehicle: ApproachingVehicle, plan: JointPlan, ahead: float) -> float:
        """Mean distance to the destination within the horizon [m]."""
        travel = plan.travels[vehicle.id]
        if ahead:
            travel = travel + float(travel[-1]) / (plan.sample * (len(travel) - 1)) * ahead
        return float(np.maximum(vehicle.remaining - travel, 0.0).mean())

    def _utility(
        self, instance: Instance, vehicle: ApproachingVehicle, left: float, plan: JointPlan, planner: JointPlanner
    ) -> float:
        distance = max(vehicle.remaining, NEAREST)
        acceleration = np.diff(plan.speed(vehicle.id)) / plan.sample
        partners = [name for name in instance.vehicles if name != vehicle.id and instance.conflict(name, vehicle.id)]
        gaps = [max(planner.gap_time(plan, vehicle.id, name), 0.0) for name in partners]
        risk = sum(math.exp(-gap / self.risk_time) for gap in gaps) / len(gaps) if gaps else 0.0
        effort = self.comfort * float((acceleration**2).mean()) / self.reference_acceleration**2
        terms = self.efficiency * (distance - left) / distance - effort - self.safety * risk
        return terms / (self.efficiency + self.comfort + self.safety)
