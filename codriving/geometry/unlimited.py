"""The near future of vehicles without limits: from decision to decision, since the speed law can be solved."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from codriving.datatypes import DrivingModel
from codriving.geometry.clearance import Array
from codriving.geometry.target_steps import TargetSteps


@dataclass(frozen=True, slots=True)
class _SpeedLaw:
    """The speed law between two decisions, at each simulation step since the decision (substeps,)."""

    elapsed: Array  # Time since the decision [s]
    summed: Array  # What a metre a second above the target has added to the distance by then [s]
    left: Array  # What is left of it then


@lru_cache(maxsize=64)
def _speed_law(model: DrivingModel) -> _SpeedLaw:
    counts = np.arange(1, model.substeps + 1)
    left: Array = np.asarray((1 - model.speed_gain * model.step) ** counts, dtype=np.float64)
    return _SpeedLaw(np.asarray(counts * model.step), np.asarray((1 - left) / model.speed_gain), left)


def unlimited(
    model: DrivingModel,
    speeds: Sequence[float],
    targets: Sequence[float],
    changes: TargetSteps,
    stride: int,
    places: Array,
    reached: Array | None = None,
) -> None:
    """Simulate states under changes of the target speed, without working out the steps between two samples.

    Args:
        speeds: Speed of each state (n,) [m/s].
        targets: Target speed of each state (n,) [m/s].
        stride: Simulation steps between two samples.
        places: Where the distance at each sample is put (samples + 1, n, plans), or (samples + 1, n) if paired [m].
        reached: Where the speed at each sample is put, in the same shape [m/s].
    """
    law, shape, substeps = _speed_law(model), changes.shape, model.substeps
    samples, decisions = len(places) - 1, -(-(len(places) - 1) * stride // substeps)
    v, place, goal, kept, part = (np.empty(shape) for _ in range(5))
    v.T[...], goal.T[...], place[...], places[0] = speeds, targets, 0.0, 0.0
    if reached is not None:
        reached[0] = v
    left, elapsed, summed = (np.array(each[-1]) for each in (law.left, law.elapsed, law.summed))
    for k in range(decisions):
        goal, kept = kept, goal
        changes.apply(k, v, goal, kept, v)
        over = np.subtract(v, goal, v)
        # Samples until the next decision, and the steps since this one at each of them.
        first, last = k * substeps // stride, min((k + 1) * substeps // stride, samples)
        since = (np.arange(first + 1, last + 1) * stride - 1 - k * substeps).reshape(-1, *(1,) * len(shape))
        # Distances add up in one order, however many samples there are: what the target gives, then the excess.
        moved = np.multiply(goal, law.elapsed[since], out=places[first + 1 : last + 1])
        moved += place
        moved += over * law.summed[since]
        if reached is not None:
            np.add(goal, over * law.left[since], out=reached[first + 1 : last + 1])
        np.multiply(goal, elapsed, part)
        np.add(place, part, place)
        np.multiply(over, summed, part)
        np.add(place, part, place)
        np.multiply(over, left, v)
        np.add(v, goal, v)
