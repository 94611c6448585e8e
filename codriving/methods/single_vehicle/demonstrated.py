"""The pattern of DiLu's demonstrations as a rule: FASTER, then IDLE, then SLOWER, and the first that is acceptable."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from codriving.datatypes import Action
from codriving.geometry import stays_behind
from codriving.methods.single_vehicle.encounters import Encounter, Leader, WaitingDriver, leaders
from codriving.methods.single_vehicle.lane_choice import Side
from codriving.methods.single_vehicle.method import Choice
from codriving.reasoning import IntelligentDriver, Moment, Plan

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

PREFERRED = (Action.FASTER, Action.IDLE, Action.SLOWER)  # Actions along the lane, the most wanted first

# Each of them, taken again and again; a forecast has to know these plans.
CONSTANT: tuple[Plan, ...] = tuple((action,) for action in PREFERRED)

# Least and largest value of each setting.
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

# A gap that grows by less does not grow: two who drive at the same speed are not told apart by rounding [m].
OPENS = 1e-6


@dataclass(kw_only=True, eq=False, repr=False)
class Demonstrated(WaitingDriver):
    """A driver that takes the first acceptable action (after the reasoning shown in Wen et al., 2024)."""

    name = "demonstrated"
    ranges = LIMITS

    horizon: float
    headway: float
    merging: float
    gap: float
    stop_gap: float
    after: float

    def __post_init__(self) -> None:
        super().__post_init__()
        self._idm = IntelligentDriver(gap=self.gap)

    def decide(self, moment: Moment, ego: str) -> Choice:
        """Change lanes if that is wanted and safe, or take the first action along the lane that is acceptable."""
        waited = self._patience.waited(ego, moment.scenes[ego].ego.speed, moment.time)
        change, refused = self.lanes.choose(moment, ego, self._idm, self.refuses)
        if change is not None:
            return Choice(change.action, change.reason, (), refused)
        met = self.met(moment, ego)
        creeps = self.may_start(moment, ego, met, waited)
        # A CAV that has waited long enough lets no other vehicle into an empty zone first.
        before, precedences = self.yields_to(moment, ego, () if creeps else met)
        refused = {**refused, **self._refusals(moment, ego, [e for e, _ in before])}
        counts = {"creeps": int(creeps)}
        action = next((a for a in PREFERRED if a in moment.available[ego] and a not in refused), None)
        if action is None:
            why = refused.pop(Action.SLOWER, "")
            return Choice(Action.SLOWER, f"nothing is acceptable, so SLOWER: {why}", precedences, refused, counts)
        return Choice(action, _reason(action, refused, waited if creeps else 0.0), precedences, refused, counts)

    def refuses(self, moment: Moment, ego: str, side: Side, idm: IntelligentDriver) -> str:
        """Say why a lane change is refused; nothing if it is not."""
        braked, ahead = self.lanes.braked_for(moment, ego, side, idm), side.ahead
        if braked or ahead is None or ahead.gap is None:
            return braked
        headway = self.headway if moment.scenes[ego].must_change is None else self.merging
        travel, times = self._motions(moment, ego, (Action.IDLE,))
        leader = Leader(ahead.id, ahead.gap, ahead.speed)
        close = self._too_close(leader, travel, times, moment.forecast.sample, headway)
        return f"{ahead.id} ahead there is close" if close.any() else ""

    def _refusals(self, moment: Moment, ego: str, before: Sequence[Encounter]) -> dict[Action, str]:
        """Say which actions are not acceptable, and why.

        An action is acceptable if, taken again and again for the horizon, it keeps the headway to all vehicles ahead,
        and enters no zone in which another vehicle may be first before it has left the way. All others are expected to
        keep the speed.
        """
        motion = (*self._motions(moment, ego, PREFERRED), moment.forecast.sample)
        ahead = leaders(moment.scenes[ego], moment.road_map)
        refusals = [(f"{leader.id} ahead is close", self._too_close(leader, *motion, self.headway)) for leader in ahead]
        refusals += [(f"{e.conflict.other} may be there first", self._in_the_way(e, *motion)) for e in before]
        found: dict[Action, str] = {}
        for why, refused in refusals:
            for k in np.flatnonzero(refused).tolist():
                found.setdefault(PREFERRED[k], why)
        return found

    def _motions(self, moment: Moment, ego: str, actions: Sequence[Action]) -> tuple[Array, Array]:
        """The way that each action leads over within the horizon (actions, n) [m], and the times (n,) [s]."""
        scene, forecast = moment.scenes[ego], moment.forecast
        last = min(round(self.horizon / forecast.sample), forecast.steps) + 1
        plans = tuple((a,) for a in actions)
        travel = forecast.travel(scene.ego.speed, scene.intent.target_speed, plans, scene.where)
        return travel[:, :last], forecast.times[:last]

    def _too_close(self, leader: Leader, travel: Array, times: Array, sample: float, headway: float) -> Flags:
        """Whether each motion comes too close to a vehicle ahead (actions,); one that gets away is not too close."""
        free = leader.gap + leader.speed * times - travel
        pace = np.diff(travel, axis=1) / sample
        close = (free[:, 1:] < headway * pace) & (free[:, 1:] < leader.gap + OPENS)
        return np.asarray((close | (free[:, 1:] < self.gap)).any(axis=1))

    def _in_the_way(self, e: Encounter, travel: Array, times: Array, sample: float) -> Flags:
        """Whether each motion enters a zone before the other one has left the way (actions,)."""
        place, there = e.conflict.places
        motion = place + travel
        enters = motion[:, -1] > e.zone.entry_i - self.stop_gap
        behind = stays_behind(e.zone, motion, there + e.other.speed * times, round(self.after / sample), 0.0)
        return np.asarray(enters & ~behind)


def _reason(action: Action, refused: dict[Action, str], waited: float) -> str:
    if waited:
        return f"it has waited for {waited:.0f} s and the zones ahead are empty, so {action}"
    if action is Action.FASTER:
        return "accelerating keeps clear of all others"
    faster = PREFERRED[PREFERRED.index(action) - 1]
    return f"{action}, since with {faster} {refused[faster]}" if faster in refused else f"{action} keeps clear"
