"""What CAVs do when they are given lists of actions: highway-env's rule, simulated exactly."""

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from codriving.datatypes.action import Action
from codriving.datatypes.driving_model import DrivingModel

Array = NDArray[np.float64]

Plan = tuple[Action, ...]
"""Actions, one a decision; the last one is repeated for ever."""

CHANGE = {Action.SLOWER: -1, Action.FASTER: 1}
"""Steps of the target speed that an action asks for; every other action leaves the target alone."""


@lru_cache(maxsize=64)
def _changes(plans: tuple[Plan, ...], decisions: int) -> Array:
    """Steps of the target speed that every plan asks for at every decision (decisions, len(plans))."""
    return np.array([[CHANGE.get(p[min(d, len(p) - 1)], 0) for p in plans] for d in range(decisions)], dtype=np.float64)


def rollout(
    model: DrivingModel, speeds: Sequence[float], targets: Sequence[float], plans: tuple[Plan, ...], steps: int
) -> tuple[Array, Array]:
    """Simulate every plan from every state, along a route.

    FASTER and SLOWER step from the *current speed* to the next allowed target, as highway-env's ``MDPVehicle`` does;
    the speed follows a = K_a (target - v) (paper Eq. 1), position first, then speed.

    Args:
        model: The vehicle model.
        speeds: Speed of each state (n,) [m/s].
        targets: Target speed of each state (n,) [m/s].
        plans: The plans.
        steps: Simulation steps to look ahead.

    Returns:
        Distance travelled [m] and speed [m/s], each (n, len(plans), steps + 1), the first column being now.
    """
    decisions = -(-steps // model.substeps)
    low, high = model.target_speeds[0], model.target_speeds[-1]
    top = len(model.target_speeds) - 1
    spacing = (high - low) / top
    shape = (len(speeds), len(plans))
    v = np.broadcast_to(np.array(speeds, dtype=np.float64)[:, None], shape)
    goal = np.broadcast_to(np.array(targets, dtype=np.float64)[:, None], shape)
    s = np.zeros(shape)
    # While the target stays the same, Euler's steps are a geometric series: its sum replaces the loop.
    counts = np.arange(1, model.substeps + 1)
    left = (1 - model.speed_gain * model.step) ** counts
    summed, elapsed = (1 - left) / model.speed_gain, counts * model.step
    distances, reached = [np.zeros((*shape, 1))], [v[..., None]]
    for change in _changes(plans, decisions):
        index = np.minimum(np.maximum(np.rint((v - low) / (high - low) * top), 0), top)
        asked = low + spacing * np.minimum(np.maximum(index + change, 0), top)
        goal = np.where(change != 0, asked, goal)
        excess = v - goal
        distances.append(s[..., None] + goal[..., None] * elapsed + excess[..., None] * summed)
        reached.append(goal[..., None] + excess[..., None] * left)
        s, v = distances[-1][..., -1], reached[-1][..., -1]
    return np.concatenate(distances, axis=-1)[..., : steps + 1], np.concatenate(reached, axis=-1)[..., : steps + 1]
