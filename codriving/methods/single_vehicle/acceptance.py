"""Which actions along the lane are acceptable, by what comes of taking each of them again and again."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from codriving.datatypes.action import Action
from codriving.methods.single_vehicle.encounters import Encounter
from codriving.methods.single_vehicle.lane_choice import Side
from codriving.methods.single_vehicle.leaders import Leader, leaders
from codriving.methods.single_vehicle.protocol import View
from codriving.reasoning.prediction.clearance import stays_behind

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]


OPENS = 1e-6
"""A gap that grows by less does not grow: two who drive at the same speed are not told apart by rounding [m]."""


@dataclass(frozen=True, slots=True)
class Limits:
    """What an acceptable action keeps to.

    Attributes:
        horizon: Time over which it is predicted [s].
        headway: Time gap to whoever drives ahead [s].
        gap: Distance to whoever drives ahead [m].
        stop_gap: Distance from a zone at which the vehicle waits [m].
        after: Time between the other one's leaving a zone and the vehicle's entering it [s].
    """

    horizon: float
    headway: float
    gap: float
    stop_gap: float
    after: float


def refusals(view: View, before: Sequence[Encounter], limits: Limits, actions: Sequence[Action]) -> dict[Action, str]:
    """Say which actions are not acceptable, and why.

    An action is acceptable if, taken again and again for the horizon, it keeps the headway to everybody ahead, and
    enters no zone in which somebody else may be first before that one has left the way. Everybody else is expected to
    keep the speed.

    Returns:
        The reason by action, without those that are acceptable.
    """
    scene, forecast = view.scene, view.forecast
    last = min(round(limits.horizon / forecast.sample), forecast.steps) + 1
    travel = forecast.travel(scene.ego.speed, scene.intent.target_speed, tuple((a,) for a in actions))[:, :last]
    times = forecast.times[:last]
    found: dict[Action, str] = {}
    for leader in leaders(scene, view.road_map):
        _note(
            found,
            actions,
            _too_close(leader, travel, times, forecast.sample, limits.headway, limits.gap),
            f"{leader.id} ahead is close",
        )
    for e in before:
        why = f"{e.conflict.other} may be there first"
        _note(found, actions, _in_the_way(e, travel, times, forecast.sample, limits), why)
    return found


def change_refused(view: View, side: Side, limits: Limits, headway: float) -> str:
    """Say why a lane change is not acceptable because of whoever is then ahead; nothing if it is.

    Args:
        headway: Time gap to whoever is then ahead [s].
    """
    forecast, ego, ahead = view.forecast, view.scene.ego, side.ahead
    if ahead is None or ahead.gap is None:
        return ""
    last = min(round(limits.horizon / forecast.sample), forecast.steps) + 1
    travel = forecast.travel(ego.speed, view.scene.intent.target_speed, ((Action.IDLE,),))[:, :last]
    leader = Leader(ahead.id, ahead.gap, ahead.speed)
    close = _too_close(leader, travel, forecast.times[:last], forecast.sample, headway, limits.gap)
    return f"{ahead.id} ahead there is close" if close.any() else ""


def _note(found: dict[Action, str], actions: Sequence[Action], refused: Flags, why: str) -> None:
    for action, no in zip(actions, refused.tolist(), strict=True):
        if no:
            found.setdefault(action, why)


def _too_close(leader: Leader, travel: Array, times: Array, sample: float, headway: float, gap: float) -> Flags:
    """Whether each motion comes too close to somebody ahead (actions,); who gets away is not too close."""
    free = leader.gap + leader.speed * times - travel
    pace = np.diff(travel, axis=1) / sample
    close = (free[:, 1:] < headway * pace) & (free[:, 1:] < leader.gap + OPENS)
    return np.asarray((close | (free[:, 1:] < gap)).any(axis=1))


def _in_the_way(e: Encounter, travel: Array, times: Array, sample: float, limits: Limits) -> Flags:
    """Whether each motion enters a zone before the other one has left the way (actions,)."""
    place, there = e.conflict.places
    motion = place + travel
    enters = motion[:, -1] > e.zone.entry_i - limits.stop_gap
    behind = stays_behind(e.zone, motion, there + e.other.speed * times, round(limits.after / sample), 0.0)
    return np.asarray(enters & ~behind)
