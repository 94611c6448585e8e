"""What the safety layers look at: where one CAV would go after each action, and what it knows of the others."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from codriving.datatypes.action import Action
from codriving.datatypes.conflict import Conflict
from codriving.datatypes.order import PassingOrder
from codriving.datatypes.scene_description import SceneDescription, TrackedVehicle
from codriving.geometry.road_map import RoadMap
from codriving.reasoning.prediction.expectation import Expected
from codriving.reasoning.prediction.forecast import Forecast
from codriving.reasoning.prediction.rollout import Plan

Array = NDArray[np.float64]

LONGITUDINAL = (Action.SLOWER, Action.IDLE, Action.FASTER)


def then_stop(action: Action) -> Plan:
    """Carry out an action once, then brake to a stop."""
    return (action, Action.SLOWER)


def then_go(action: Action) -> Plan:
    """Carry out an action once, then accelerate."""
    return (action, Action.FASTER)


CONTINUATIONS: tuple[Plan, ...] = tuple(f(a) for f in (then_stop, then_go) for a in LONGITUDINAL)
"""Every plan that the safety layers look at."""


@dataclass(frozen=True, slots=True)
class Outlook:
    """One CAV's view of the near future.

    Attributes:
        stops: Arc length if it brakes after each action (actions, n) [m].
        goes: Arc length if it accelerates after each action (actions, n) [m].
    """

    scene: SceneDescription
    conflicts: tuple[Conflict, ...]
    order: PassingOrder
    others: dict[str, TrackedVehicle]
    expected: dict[str, tuple[Expected, ...]]
    actions: tuple[Action, ...]
    stops: Array
    goes: Array
    road_map: RoadMap
    forecast: Forecast
    lag: int
    minds_conflicts: bool
    sides: "dict[Action, Outlook | None]" = field(default_factory=dict)


def motions(scene: SceneDescription, actions: tuple[Action, ...], forecast: Forecast) -> tuple[Array, Array]:
    """Predict one CAV for every action, braking and accelerating afterwards; a lane change keeps the speed.

    Returns:
        Arc length if it brakes and if it accelerates after each action, each (actions, n) [m].
    """
    speed, target = scene.ego.speed, scene.intent.target_speed
    plain = [a if a in LONGITUDINAL else Action.IDLE for a in actions]
    stops = forecast.travel(speed, target, [then_stop(a) for a in plain])
    goes = forecast.travel(speed, target, [then_go(a) for a in plain])
    return scene.place + stops, scene.place + goes
