"""The pattern of DiLu's demonstrations as a rule: FASTER, then IDLE, then SLOWER, and the first that is acceptable."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from codriving.datatypes.order import Precedence
from codriving.datatypes.world import Action
from codriving.errors import require_range
from codriving.methods.single_vehicle.encounters import (
    Encounter,
    Leader,
    Patience,
    encounters,
    goes_first,
    leaders,
    may_start,
)
from codriving.methods.single_vehicle.lane_choice import LaneChoice, Side
from codriving.methods.single_vehicle.method import Choice, Driver
from codriving.reasoning.perception import Moment
from codriving.reasoning.prediction.clearance import stays_behind
from codriving.reasoning.prediction.idm import IntelligentDriver
from codriving.reasoning.prediction.rollout import Plan

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

PREFERRED = (Action.FASTER, Action.IDLE, Action.SLOWER)
"""Actions along the lane, the most wanted first."""

CONSTANT: tuple[Plan, ...] = tuple((action,) for action in PREFERRED)
"""Each of them, taken again and again; a forecast has to know these plans."""

LIMITS = {
    "horizon": (0.5, 10.0),
    "headway": (0.0, 5.0),
    "merging": (0.0, 5.0),
    "gap": (0.0, 20.0),
    "stop_gap": (0.0, 20.0),
    "after": (0.0, 5.0),
    "tie": (0.0, 5.0),
    "firm": (0.5, 10.0),
    "patience": (0.0, 60.0),
    "clear": (0.0, 10.0),
}
"""Least and largest value of each setting."""

OPENS = 1e-6
"""A gap that grows by less does not grow: two who drive at the same speed are not told apart by rounding [m]."""


@dataclass(frozen=True, slots=True)
class Limits:
    """What an acceptable action keeps to."""

    horizon: float  # Time over which it is predicted [s]
    headway: float  # Time gap to the vehicle ahead [s]
    gap: float  # Distance to the vehicle ahead [m]
    stop_gap: float  # Distance from a zone at which the vehicle waits [m]
    after: float  # Time between the other one's leaving a zone and the vehicle's entering it [s]


class Demonstrated(Driver):
    """A driver that takes the first acceptable action (after the reasoning shown in Wen et al., 2024).

    Args:
        horizon: Time over which an action is predicted, taken again and again [s].
        headway: Time gap that is kept to the vehicle ahead [s].
        merging: The same on the other lane for a change that the route asks for [s].
        gap: Distance that is kept to the vehicle ahead, however slow [m].
        stop_gap: Distance from a zone at which the vehicle waits [m].
        after: Time between the other one's leaving a zone and the vehicle's entering it [s].
        tie: Difference of the times to a zone up to which both count as there at once [s].
        firm: Braking beyond which no vehicle is expected to wait any more [m/s2].
        patience: Time after which a waiting vehicle may start into an empty zone [s].
        clear: Time that a vehicle which moves towards that zone must be away from it beyond what the start takes [s].

    Raises:
        ConfigError: If a setting is out of range.
    """

    name = "demonstrated"
    variant = ""

    def __init__(
        self,
        horizon: float,
        headway: float,
        merging: float,
        gap: float,
        stop_gap: float,
        after: float,
        tie: float,
        firm: float,
        patience: float,
        clear: float,
        lanes: LaneChoice,
    ) -> None:
        for key, value in [(key, value) for key, value in locals().items() if key in LIMITS]:
            require_range(key, value, *LIMITS[key])
        self.limits = Limits(horizon, headway, gap, stop_gap, after)
        self.merging, self.tie, self.firm = merging, tie, firm
        self.patience, self.clear, self.lanes = patience, clear, lanes
        self._idm = IntelligentDriver(gap=gap)
        self._patience = Patience()

    def reset(self) -> None:
        """Begin an episode; nothing is remembered from the one before."""
        self._patience = Patience()
        self.lanes.reset()

    def decide(self, moment: Moment, ego: str) -> Choice:
        """Change lanes if that is wanted and safe, or take the first action along the lane that is acceptable.

        Args:
            moment: Its forecast has to know the plans of ``CONSTANT``.
        """
        waited = self._patience.waited(ego, moment.scenes[ego].ego.speed, moment.time)
        change, refused = self.lanes.choose(moment, ego, self._idm, self.refuses)
        if change is not None:
            return Choice(change.action, change.reason, (), refused)
        met = encounters(moment, ego, self.firm)
        creeps = may_start(moment, ego, met, waited, self.patience, self.clear)
        # A CAV that has waited long enough lets no other vehicle into an empty zone first.
        before, precedences = self.first(moment, ego, () if creeps else met)
        refused = {**refused, **refusals(moment, ego, before, self.limits, PREFERRED)}
        counts = {"creeps": int(creeps)}
        action = next((a for a in PREFERRED if a in moment.available[ego] and a not in refused), None)
        if action is None:
            why = refused.pop(Action.SLOWER, "")
            return Choice(Action.SLOWER, f"nothing is acceptable, so SLOWER: {why}", precedences, refused, counts)
        return Choice(action, _reason(action, refused, waited if creeps else 0.0), precedences, refused, counts)

    def refuses(self, moment: Moment, ego: str, side: Side, idm: IntelligentDriver) -> str:
        """Say why a lane change is refused; nothing if it is not."""
        must = moment.scenes[ego].must_change is not None
        headway = self.merging if must else self.limits.headway
        return self.lanes.braked_for(moment, ego, side, idm) or change_refused(moment, ego, side, self.limits, headway)

    def first(
        self, moment: Moment, ego: str, met: tuple[Encounter, ...]
    ) -> tuple[tuple[Encounter, ...], tuple[Precedence, ...]]:
        """Return the encounters in which the other one may be there first, and who goes first by that."""
        before, precedences = [], dict[str, Precedence]()
        for e in met:
            own, why = goes_first(e, moment.road_map, self.tie)
            other = e.conflict.other
            if own:
                precedences.setdefault(other, Precedence(ego, other, why))
                continue
            before.append(e)
            if other not in precedences or precedences[other].first == ego:
                precedences[other] = Precedence(other, ego, why)
        return tuple(before), tuple(precedences.values())


def _reason(action: Action, refused: dict[Action, str], waited: float) -> str:
    if waited:
        return f"it has waited for {waited:.0f} s and the zones ahead are empty, so {action}"
    if action is Action.FASTER:
        return "accelerating keeps clear of everybody"
    faster = PREFERRED[PREFERRED.index(action) - 1]
    return f"{action}, since with {faster} {refused[faster]}" if faster in refused else f"{action} keeps clear"


def refusals(
    moment: Moment, ego: str, before: Sequence[Encounter], limits: Limits, actions: Sequence[Action]
) -> dict[Action, str]:
    """Say which actions are not acceptable, and why.

    An action is acceptable if, taken again and again for the horizon, it keeps the headway to all vehicles ahead, and
    enters no zone in which another vehicle may be first before it has left the way. All others are expected to
    keep the speed.

    Returns:
        The reason by action, without those that are acceptable.
    """
    scene, forecast = moment.scenes[ego], moment.forecast
    last = min(round(limits.horizon / forecast.sample), forecast.steps) + 1
    travel = forecast.travel(scene.ego.speed, scene.intent.target_speed, tuple((a,) for a in actions))[:, :last]
    times = forecast.times[:last]
    found: dict[Action, str] = {}
    for leader in leaders(scene, moment.road_map):
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


def change_refused(moment: Moment, ego: str, side: Side, limits: Limits, headway: float) -> str:
    """Say why a lane change is not acceptable because of the vehicle that is then ahead; nothing if it is.

    Args:
        headway: Time gap to the vehicle that is then ahead [s].
    """
    scene, forecast, ahead = moment.scenes[ego], moment.forecast, side.ahead
    if ahead is None or ahead.gap is None:
        return ""
    last = min(round(limits.horizon / forecast.sample), forecast.steps) + 1
    travel = forecast.travel(scene.ego.speed, scene.intent.target_speed, ((Action.IDLE,),))[:, :last]
    leader = Leader(ahead.id, ahead.gap, ahead.speed)
    close = _too_close(leader, travel, forecast.times[:last], forecast.sample, headway, limits.gap)
    return f"{ahead.id} ahead there is close" if close.any() else ""


def _note(found: dict[Action, str], actions: Sequence[Action], refused: Flags, why: str) -> None:
    for action, no in zip(actions, refused.tolist(), strict=True):
        if no:
            found.setdefault(action, why)


def _too_close(leader: Leader, travel: Array, times: Array, sample: float, headway: float, gap: float) -> Flags:
    """Whether each motion comes too close to a vehicle ahead (actions,); one that gets away is not too close."""
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
