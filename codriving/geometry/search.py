"""The earliest drive of one CAV among all that its actions allow, past places that others block for a while."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from codriving.datatypes import Action, DrivingModel
from codriving.geometry.clearance import Array
from codriving.geometry.speed_profile import SpeedProfile

Numbers = NDArray[np.intp]

Actions = tuple[Action, ...]  # One a decision

MERGED = (0.25, 0.35)  # Place [m] and speed [m/s] within which states are taken for one

MOST = 20_000  # States that are kept at most; of more, those with most progress


@dataclass(frozen=True, slots=True, eq=False)
class Search:
    """What a CAV wants and may do.

    Where it cannot be is given as stretches: at step n it must not be within (low[n], high[n]) of any.
    """

    model: DrivingModel
    place: float  # Arc length [m]
    speed: float  # [m/s]
    target: float  # Target speed that it has [m/s]
    goal: float  # Arc length at which it has arrived [m]
    low: Sequence[Array] = ()  # Begin of each stretch at each step (steps + 1,) [m]
    high: Sequence[Array] = ()  # End of each stretch, likewise [m]
    profile: SpeedProfile | None = None  # How fast its route can be driven, where vehicles have limits
    # Arc length gained a metre driven, at each metre of the route (n,): CAVs cut corners. None takes 1.
    stretch: Array | None = None
    merged: tuple[float, float] = MERGED

    def drive(self, steps: int) -> "SearchedDrive | None":
        """Search for a drive.

        Args:
            steps: Simulation steps that are looked ahead at most, rounded up to whole decisions.

        Returns:
            The drive that arrives first, of those that arrive at the same step the one that is farthest; if none
            arrives within the steps, the one that is farthest at their end. None if each meets a stretch.
        """
        layers: list[tuple[Numbers, Numbers]] = []
        states = np.array([[self.place], [self.speed], [self.target]])
        decisions = -(-steps // self.model.substeps)
        free = self._free()
        for k in range(decisions):
            parents, actions, states, arrived = self._step(states, k * self.model.substeps)
            if arrived is not None:
                layers.append((parents[[arrived]], actions[[arrived]]))
                return self._traced(layers, 0)
            if not states.size:
                return None
            kept = _merged(states, self.merged) if (k + 1) * self.model.substeps < free else _fastest(states)
            states = states[:, kept]
            layers.append((parents[kept], actions[kept]))
        return self._traced(layers, int(np.lexsort((states[1], states[0]))[-1]))

    def _free(self) -> float:
        """From which step on no stretch is left: then those that are ahead and as fast are no worse."""
        last = -1.0
        for low, high in zip(self.low, self.high, strict=True):
            blocked = np.flatnonzero((low < high) & np.isfinite(np.minimum(np.abs(low), np.abs(high))))
            if len(blocked):
                # What stands at the end stands for ever.
                last = max(last, np.inf if blocked[-1] == len(low) - 1 else float(blocked[-1]))
        return last + 1

    def _step(self, states: Array, first: int) -> tuple[Numbers, Numbers, Array, int | None]:
        """Let each state take each action; gives the parent of each new state, its action, and who has arrived."""
        model = self.model
        count = states.shape[1]
        targets = [self._targets(action, states) for action in _actions(model)]
        goal = np.concatenate(targets)
        parents = np.tile(np.arange(count), len(targets))
        actions = np.repeat(np.arange(len(targets)), count)
        s, v = np.tile(states[0], len(targets)), np.tile(states[1], len(targets))
        rolling = s.copy()
        alive = np.ones(len(s), dtype=np.bool_)
        for n in range(first + 1, first + model.substeps + 1):
            s, v, rolling = self.moved(s, v, goal, rolling)
            for low, high in zip(self.low, self.high, strict=True):
                at = min(n, len(low) - 1)
                alive &= ~((s > low[at]) & (s < high[at]))
            there = alive & (s >= self.goal)
            if there.any():
                best = np.flatnonzero(there)
                return parents, actions, states, int(best[np.argmax(s[best])])
        kept = np.flatnonzero(alive)
        return parents[kept], actions[kept], np.array([s[kept], v[kept], goal[kept]]), None

    def moved(self, s: Array, v: Array, goal: Array, reckoned: Array) -> tuple[Array, Array, Array]:
        """Move by one simulation step; the place that is reckoned counts metres driven since the last decision."""
        model = self.model
        aim = goal if self.profile is None else np.minimum(goal, self._reference(reckoned))
        pedal = model.speed_gain * (aim - v)
        if model.limits is not None:
            pedal = np.clip(pedal, -model.limits.braking, model.limits.acceleration)
        way = v * model.step
        gained = way if self.stretch is None else way * self.stretch.take(s.astype(np.intp), mode="clip")
        return s + gained, np.maximum(v + pedal * model.step, 0.0), reckoned + way

    def _reference(self, places: Array) -> Array:
        profile = self.profile
        assert profile is not None
        x = np.maximum(places, 0.0) / profile.spacing
        k = np.minimum(x.astype(np.intp), len(profile.base) - 1)
        return np.asarray(profile.base[k] + profile.slopes[k] * x)

    def _targets(self, action: Action, states: Array) -> Array:
        """Return the target speed of each state after an action, as `DrivingModel.target_after` does."""
        if action in (Action.IDLE, Action.HOLD):
            return np.asarray(states[2 if action is Action.IDLE else 1])
        speeds = self.model.target_speeds
        low, top = speeds[0], len(speeds) - 1
        nearest = np.clip(np.rint((states[1] - low) / (speeds[-1] - low) * top), 0, top)
        index = np.clip(nearest + (1 if action is Action.FASTER else -1), 0, top)
        return np.asarray(np.array(speeds)[index.astype(np.intp)])

    def _traced(self, layers: Sequence[tuple[Numbers, Numbers]], state: int) -> "SearchedDrive":
        """Follow a state back to the beginning, and drive it once more for places and speeds."""
        choices = _actions(self.model)
        plan: list[Action] = []
        for parents, actions in reversed(layers):
            plan.append(choices[int(actions[state])])
            state = int(parents[state])
        plan.reverse()
        return self.driven(tuple(plan))

    def driven(self, plan: Actions, steps: int | None = None) -> "SearchedDrive":
        """Drive a plan whose last action is repeated.

        Args:
            steps: Simulation steps; None for as many as the plan has decisions for.
        """
        s, v, goal = (np.array([value]) for value in (self.place, self.speed, self.target))
        reckoned, places, speeds = s, [self.place], [self.speed]
        substeps = self.model.substeps
        for n in range(len(plan) * substeps if steps is None else steps):
            if n % substeps == 0:
                goal, reckoned = self._targets(plan[min(n // substeps, len(plan) - 1)], np.array([s, v, goal])), s
            s, v, reckoned = self.moved(s, v, goal, reckoned)
            places.append(float(s[0]))
            speeds.append(float(v[0]))
        arrivals = np.flatnonzero(np.array(places) >= self.goal)
        return SearchedDrive(plan, np.array(places), np.array(speeds), int(arrivals[0]) if len(arrivals) else None)


@dataclass(frozen=True, slots=True, eq=False)
class SearchedDrive:
    """A drive that keeps clear of all stretches."""

    plan: Actions
    places: Array  # Arc length at each simulation step (n,) [m]
    speeds: Array  # (n,) [m/s]
    arrives: int | None  # Step at which it has arrived, or None


def _actions(model: DrivingModel) -> tuple[Action, ...]:
    """Every action along the road, most progress first."""
    return (Action.FASTER, Action.IDLE, *([Action.HOLD] if model.steady else []), Action.SLOWER)


def _merged(states: Array, near: tuple[float, float]) -> Numbers:
    """Take one of those states that are alike, the farthest; and of too many those with most progress."""
    cells = np.rint(states / np.array((*near, near[1]))[:, None]).astype(np.int64)
    cells -= cells.min(axis=1, keepdims=True)
    key = (cells[0] * (cells[1].max() + 1) + cells[1]) * (cells[2].max() + 1) + cells[2]
    order = np.argsort(-states[0], kind="stable")
    kept = order[np.unique(key[order], return_index=True)[1]]
    return np.asarray(kept if len(kept) <= MOST else kept[np.argsort(-states[0][kept], kind="stable")[:MOST]])


def _fastest(states: Array) -> Numbers:
    """Leave out states behind which another one is neither in place nor in speed nor in target."""
    order = np.lexsort((-states[2], -states[1], -states[0]))
    # In the order of places, those that are faster than all that are farther.
    speeds = states[1][order] + 1e-6 * states[2][order]
    return np.asarray(order[speeds > np.concatenate(([-1.0], np.maximum.accumulate(speeds)[:-1]))])
