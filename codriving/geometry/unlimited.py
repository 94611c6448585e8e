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
    """The speed law between two decisions, and the allowed targets as numbers.

    Attributes:
        elapsed: Time of each step since the decision [s].
        summed: What a metre a second above the target has added to the distance by then [s].
        left: What is left of it then.
    """

    low: float
    span: float
    top: int
    spacing: float
    elapsed: Array
    summed: Array
    left: Array


@lru_cache(maxsize=64)
def _speed_law(model: DrivingModel) -> _SpeedLaw:
    low, top = model.target_speeds[0], len(model.target_speeds) - 1
    span = model.target_speeds[-1] - low
    counts = np.arange(1, model.substeps + 1)
    left: Array = np.asarray((1 - model.speed_gain * model.step) ** counts, dtype=np.float64)
    return _SpeedLaw(
        low, span, top, span / top, np.asarray(counts * model.step), np.asarray((1 - left) / model.speed_gain), left
    )


def every_step(
    model: DrivingModel, speeds: Sequence[float], targets: Sequence[float], changes: Array, steps: int
) -> tuple[Array, Array]:
    """Simulate states under changes of the target speed (decisions, plans), with what they come to at every step.

    Args:
        speeds: Speed of each state (n,) [m/s].
        targets: Target speed of each state (n,) [m/s].

    Returns:
        Distance travelled [m] and speed [m/s], each (n, plans, steps + 1), the first column being now.
    """
    law = _speed_law(model)
    shape = (len(speeds), changes.shape[1])
    v = np.broadcast_to(np.array(speeds, dtype=np.float64)[:, None], shape)
    goal = np.broadcast_to(np.array(targets, dtype=np.float64)[:, None], shape)
    s = np.zeros(shape)
    distances, reached = [np.zeros((*shape, 1))], [v[..., None]]
    for change in changes:
        index = np.minimum(np.maximum(np.rint((v - law.low) / law.span * law.top), 0), law.top)
        goal = np.where(change != 0, law.low + law.spacing * np.minimum(np.maximum(index + change, 0), law.top), goal)
        goal = np.where(np.isnan(change), v, goal)
        excess = v - goal
        distances.append(s[..., None] + goal[..., None] * law.elapsed + excess[..., None] * law.summed)
        reached.append(goal[..., None] + excess[..., None] * law.left)
        s, v = distances[-1][..., -1], reached[-1][..., -1]
    return np.concatenate(distances, axis=-1)[..., : steps + 1], np.concatenate(reached, axis=-1)[..., : steps + 1]


def unlimited(
    model: DrivingModel,
    speeds: Sequence[float],
    targets: Sequence[float],
    changes: TargetSteps,
    stride: int,
    places: Array,
) -> None:
    """Give the distances of `every_step` at some steps, bit for bit, without working out the others.

    Args:
        speeds: Speed of each state (n,) [m/s].
        targets: Target speed of each state (n,) [m/s].
        stride: Simulation steps between two samples.
        places: Where the distance at each sample is put (samples + 1, n, plans), or (samples + 1, n) if paired [m].
    """
    law, shape, substeps = _speed_law(model), changes.shape, model.substeps
    samples, decisions = len(places) - 1, -(-(len(places) - 1) * stride // substeps)
    v, place, goal, kept, part = (np.empty(shape) for _ in range(5))
    v.T[...], goal.T[...], place[...], places[0] = speeds, targets, 0.0, 0.0
    left, elapsed, summed = (np.array(each[-1]) for each in (law.left, law.elapsed, law.summed))
    for k in range(decisions):
        goal, kept = kept, goal
        changes.apply(k, v, goal, kept, v)
        over = np.subtract(v, goal, v)
        # Samples until the next decision, and the steps since this one at each of them.
        first, last = k * substeps // stride, min((k + 1) * substeps // stride, samples)
        since = (np.arange(first + 1, last + 1) * stride - 1 - k * substeps).reshape(-1, *(1,) * len(shape))
        # Distances add up in the order of `every_step`: what the target gives, then what the excess gives.
        moved = np.multiply(goal, law.elapsed[since], out=places[first + 1 : last + 1])
        moved += place
        moved += over * law.summed[since]
        np.multiply(goal, elapsed, part)
        np.add(place, part, place)
        np.multiply(over, summed, part)
        np.add(place, part, place)
        np.multiply(over, left, v)
        np.add(v, goal, v)
