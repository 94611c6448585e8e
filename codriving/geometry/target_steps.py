"""The target speeds that decisions set: FASTER and SLOWER step from the speed that is driven to an allowed target."""

import numpy as np

from codriving.datatypes import DrivingModel
from codriving.geometry.clearance import Array


class TargetSteps:
    """Steps of the target speed that every state takes at every decision, in arrays of the shape of the states.

    Numpy takes two arrays of one shape in half the time of an array and a row or a number. A scalar that is an array,
    too, is as good.

    Args:
        changes: Steps of the target speed at each decision (decisions, plans); each for one state if paired. Not a
            number where the speed that is driven becomes the target.
        states: Number of states.
        bounds: Whether two plans follow that no other can fall behind and outrun: the lowest and the highest of the
            target that is kept and the one to which SLOWER and FASTER step.
    """

    def __init__(
        self, model: DrivingModel, changes: Array, states: int, paired: bool = False, bounds: bool = False
    ) -> None:
        low, top = model.target_speeds[0], len(model.target_speeds) - 1
        span = model.target_speeds[-1] - low
        if bounds:
            extremes = np.tile([-1.0, 1.0], (len(changes), 1))
            changes = np.concatenate((changes, extremes), axis=1)
        self.shape = (states,) if paired else (states, changes.shape[1])
        holds, changes = np.isnan(changes), np.nan_to_num(changes)
        self._low, self._span, self._top, self._spacing = (
            np.array(n, np.float64) for n in (low, span, top, span / top)
        )
        # No plan steps beyond the highest or lowest target; where the target stays, the one before is kept.
        rows = (changes, np.maximum(changes, 0), top + np.minimum(changes, 0), (changes == 0) & ~holds, holds)
        each = ((row if paired else row[:, None]) for row in rows)
        change, least, most, stays, held = (np.broadcast_to(row, (len(row), *self.shape)).copy() for row in each)
        any_held = [bool(row.any()) for row in holds]
        self._decisions = list(zip(change, least, most, stays, held, any_held, strict=True))
        self._bounds = bounds

    def apply(self, k: int, speed: Array, goal: Array, kept: Array, held: Array, scale: Array | None = None) -> None:
        """Write down the target of each state after the k-th decision.

        Args:
            speed: Its speed [m/s].
            goal: Where its target is put, times the scale; may be the same array as that of the speeds.
            kept: Its target before, times the scale.
            held: Its speed, times the scale.
            scale: By what speeds are multiplied.
        """
        change, least, most, stays, holds, any_holds = self._decisions[k]
        np.subtract(speed, self._low, goal)
        np.divide(goal, self._span, goal)
        np.multiply(goal, self._top, goal)
        np.rint(goal, goal)
        np.add(goal, change, goal)
        np.maximum(goal, least, out=goal)
        np.minimum(goal, most, out=goal)
        np.multiply(goal, self._spacing, goal)
        np.add(goal, self._low, goal)
        if scale is not None:
            np.multiply(goal, scale, goal)
        np.putmask(goal, stays, kept)
        if any_holds:
            np.putmask(goal, holds, held)
        if self._bounds:
            lowest, highest = goal[:, -2], goal[:, -1]
            np.minimum(lowest, kept[:, -2], out=lowest)
            np.maximum(highest, kept[:, -1], out=highest)
