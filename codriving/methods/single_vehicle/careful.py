"""A careful driver: the fastest action that keeps its distance and meets no vehicle if all go on as they do now."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from codriving.datatypes import Action, Precedence
from codriving.errors import require_range
from codriving.methods.single_vehicle.encounters import Encounter, encounters, leaders
from codriving.methods.single_vehicle.lane_choice import LaneChoice
from codriving.methods.single_vehicle.method import Choice, Driver
from codriving.reasoning import IntelligentDriver, Moment, rollout

Array = NDArray[np.float64]

PREFERRED = (Action.FASTER, Action.IDLE, Action.SLOWER)  # The actions in the order in which they are tried

# Least and largest value of each setting.
LIMITS = {"look": (0.5, 10.0), "headway": (0.0, 5.0), "standstill": (0.0, 20.0), "margin": (0.0, 5.0)}

SLOW = 0.1  # A vehicle that is slower is taken to be so fast, so that times stay finite [m/s]

FIRM = 4.0  # Braking beyond which no vehicle is expected to wait any more [m/s2]


@dataclass(frozen=True, slots=True)
class _Motion:
    """What an action that is held leads to."""

    times: Array
    travelled: Array
    speeds: Array

    def until(self, distance: float) -> float:
        """Return when a distance has been covered, at the last speed beyond the horizon [s]; inf if never."""
        if distance <= 0:
            return 0.0
        if self.travelled[-1] >= distance:
            return float(np.interp(distance, self.travelled, self.times))
        last = float(self.speeds[-1])
        return float(self.times[-1]) + (distance - float(self.travelled[-1])) / last if last > 0.1 else float("inf")


@dataclass(eq=False, repr=False)
class Careful(Driver):
    """Tries FASTER, IDLE and SLOWER in this order, each held for a while, and takes the first that is free of danger.

    It is the rule that stands in for a language model where none is asked: it teaches TeLL (Xu et al., 2025), whose
    own rules are not published. Lanes are changed as by the other drivers on their own.
    """

    name = "careful"

    look: float
    headway: float
    standstill: float
    margin: float
    lanes: LaneChoice

    def __post_init__(self) -> None:
        for key, (low, high) in LIMITS.items():
            require_range(key, getattr(self, key), low, high)
        self._idm = IntelligentDriver(gap=self.standstill, headway=self.headway)

    def reset(self) -> None:
        """Begin an episode; nothing is remembered from the one before."""
        self.lanes.reset()

    def decide(self, moment: Moment, ego: str) -> Choice:
        """Decide for one CAV."""
        change, refused = self.lanes.choose(moment, ego, self._idm)
        if change is not None:
            return Choice(change.action, change.reason, (), refused)
        found: dict[Action, tuple[float, str, tuple[Precedence, ...]]] = {}
        for action in PREFERRED:
            danger, why, order = found[action] = self._danger(moment, ego, action)
            if not why:
                return Choice(action, "nothing is in the way of it", order, refused)
            refused[action] = f"{why} in {danger:.1f} s"
        # Nothing is free of danger: put it off for as long as possible, and of two that are alike take the slower one.
        latest = max(danger for danger, _, _ in found.values())
        action = next(a for a in reversed(PREFERRED) if found[a][0] >= latest - 0.1)
        del refused[action]
        return Choice(action, f"{found[action][1]} whatever it does", found[action][2], refused, {"cornered": 1})

    def _danger(self, moment: Moment, ego: str, action: Action) -> tuple[float, str, tuple[Precedence, ...]]:
        """When an action becomes dangerous [s], why (nothing if it does not), and who would go first."""
        model, scene = moment.forecast.model, moment.scenes[ego]
        steps = round(self.look / model.step)
        now, way = ([scene.ego.speed], [scene.intent.target_speed]), moment.forecast.along(scene.ego.speed, scene.where)
        travelled, speeds = rollout(model, *now, ((action,),), steps, way)
        motion = _Motion(np.arange(steps + 1, dtype=np.float64) * model.step, travelled[0, 0], speeds[0, 0])
        dangers: list[tuple[float, str]] = []
        for ahead in leaders(scene, moment.road_map):
            gap = ahead.gap + ahead.speed * motion.times - motion.travelled
            close = gap < self.standstill + self.headway * motion.speeds
            if close.any():
                dangers.append((float(motion.times[int(close.argmax())]), f"it comes too close to {ahead.id}"))
        order: dict[str, Precedence] = {}
        for e in encounters(moment, ego, FIRM):
            own = motion.until(e.own_way), motion.until(e.conflict.exits[0])
            entry = e.its_way / max(e.other.speed, SLOW)
            first = own[0] <= entry
            names = (ego, e.conflict.other) if first else (e.conflict.other, ego)
            order.setdefault(e.conflict.other, Precedence(*names, "if both go on like this"))
            # A vehicle that is not there within the look can decide anew.
            if own[0] <= self.look and self._meets(e, own):
                dangers.append((max(own[0], entry), f"it meets {e.conflict.other} where the ways cross"))
        at, why = min(dangers, default=(float("inf"), ""))
        return at, why, tuple(order.values())

    def _meets(self, e: Encounter, own: tuple[float, float]) -> bool:
        """Whether both are in a zone at once, or too soon one after the other, if the other one keeps its speed."""
        if e.inside:
            # A vehicle in the zone can only get out of it; one that is ahead there does so first.
            ahead = e.zone.point_i - e.conflict.places[0] <= e.zone.point_j - e.conflict.places[1]
            return e.other_inside and not ahead and not e.merges()
        its = e.its_way / max(e.other.speed, SLOW), e.conflict.exits[1] / max(e.other.speed, SLOW)
        if e.merges():
            # Both go on together, so that being ahead is enough; who stands there waits, or is met as a leader.
            if e.other_inside and e.other.standing > 0:
                return False
            return abs(own[0] - max(its[0], 0.0)) < self.headway
        return own[0] < its[1] + self.margin and its[0] < own[1] + self.margin
