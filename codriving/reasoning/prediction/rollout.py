"""What CAVs do when they are given lists of actions: highway-env's rule, simulated exactly; the library of plans."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import nan

import numpy as np

from codriving.datatypes import Action, DrivingModel
from codriving.geometry import Along, Array, TargetSteps, limited

Plan = tuple[Action, ...]  # Actions, one a decision; the last one is repeated for ever

# Steps of the target speed that an action asks for; no number of steps leads to the present speed, which HOLD asks for.
# Every other action leaves the target alone.
CHANGE = {Action.SLOWER: -1.0, Action.FASTER: 1.0, Action.HOLD: nan}

FIRST = (Action.FASTER, Action.IDLE, Action.HOLD, Action.SLOWER)  # What a vehicle may do now, most progress first

WAITS = (0, 1, 2, 3, 4, 6, 8, 11, 14)  # For how many decisions it may then slow down before it goes for good

# For how many decisions it may then slow down or accelerate before it keeps its speed, as one does behind a leader.
HOLDS = (0, 1, 2, 4)

# For how many decisions it may then keep its speed before it goes for good, to arrive moving when the way is free.
ROLLS = (1, 2, 3, 4, 6, 8, 11)


def _after(first: Action) -> Iterator[Plan]:
    yield from ((first, *(Action.SLOWER,) * k, Action.FASTER) for k in WAITS)
    for slows in (0, 1):
        yield from ((first, *(Action.SLOWER,) * slows, *(Action.IDLE,) * k, Action.FASTER) for k in ROLLS)
    yield from ((first, *(change,) * k, Action.IDLE) for k in HOLDS for change in (Action.FASTER, Action.SLOWER))
    held = () if first is Action.HOLD else (Action.HOLD,)
    if held:
        yield from ((first, *(Action.SLOWER,) * k, Action.HOLD) for k in HOLDS[:3])
        yield from ((first, *held, *(Action.IDLE,) * k, Action.FASTER) for k in ROLLS[::2])
    yield from ((first, *held, *(Action.IDLE,) * k, Action.SLOWER) for k in ROLLS[::2])
    yield first, Action.SLOWER


# Every plan: something now, then slowing down or rolling for a while or for good, then going or keeping the speed.
HOLDING_PLANS: tuple[Plan, ...] = tuple(dict.fromkeys(plan for first in FIRST for plan in _after(first)))

PLANS: tuple[Plan, ...] = tuple(plan for plan in HOLDING_PLANS if Action.HOLD not in plan)  # Those of five actions


def plan_library(model: DrivingModel) -> tuple[Plan, ...]:
    """Return every plan that a vehicle may follow."""
    return HOLDING_PLANS if model.steady else PLANS


@lru_cache(maxsize=8)
def starts_with(plans: tuple[Plan, ...]) -> Mapping[Action, tuple[int, ...]]:
    """Return the indices of the plans that begin with each action."""
    firsts = [first for first in FIRST if any(plan[0] is first for plan in plans)]
    return {first: tuple(i for i, plan in enumerate(plans) if plan[0] is first) for first in firsts}


def canonical(plan: Plan) -> Plan:
    """Return the shortest way to write a plan: its last action is repeated anyway."""
    while len(plan) > 1 and plan[-2] is plan[-1]:
        plan = plan[:-1]
    return plan


def _changes(plans: tuple[Plan, ...], decisions: int) -> Array:
    """Steps of the target speed that every plan asks for at every decision (decisions, len(plans))."""
    found = np.empty((decisions, len(plans)))
    for k, plan in enumerate(plans):
        steps = [CHANGE.get(action, 0) for action in plan[:decisions]]
        found[: len(steps), k], found[len(steps) :, k] = steps, steps[-1]
    return found


_known_changes = lru_cache(maxsize=64)(_changes)  # The same for libraries, which are asked for at every step


def _target_steps(
    model: DrivingModel, plans: tuple[Plan, ...], decisions: int, states: int, paired: bool, bounds: bool
) -> TargetSteps:
    """What plans ask of so many states."""
    return TargetSteps(model, _changes(plans, decisions), states, paired, bounds)


_known_target_steps = lru_cache(maxsize=32)(_target_steps)  # Those of libraries, which are asked for at every step


@dataclass(frozen=True, slots=True)
class _Law:
    """The speed law between two decisions, and the allowed targets as numbers."""

    low: float
    span: float
    top: int
    spacing: float
    elapsed: Array
    summed: Array
    left: Array


@lru_cache(maxsize=64)
def _law(model: DrivingModel) -> _Law:
    low, top = model.target_speeds[0], len(model.target_speeds) - 1
    span = model.target_speeds[-1] - low
    counts = np.arange(1, model.substeps + 1)
    left: Array = np.asarray((1 - model.speed_gain * model.step) ** counts, dtype=np.float64)
    return _Law(
        low, span, top, span / top, np.asarray(counts * model.step), np.asarray((1 - left) / model.speed_gain), left
    )


def rollout(
    model: DrivingModel,
    speeds: Sequence[float],
    targets: Sequence[float],
    plans: tuple[Plan, ...],
    steps: int,
    along: Sequence[Along] = (),
) -> tuple[Array, Array]:
    """Simulate every plan from every state, along a route.

    FASTER and SLOWER step from the *current speed* to the next allowed target, as highway-env's ``MDPVehicle`` does;
    the speed follows a = K_a (target - v) (paper Eq. 1), position first, then speed.

    Args:
        speeds: Speed of each state (n,) [m/s].
        targets: Target speed of each state (n,) [m/s].
        along: The way of each state, where vehicles have limits; without it the road is straight.

    Returns:
        Distance travelled [m] and speed [m/s], each (n, len(plans), steps + 1), the first column being now.
    """
    if model.limits is not None:
        changes = _known_target_steps(model, plans, -(-steps // model.substeps), len(speeds), False, False)
        places, paces = (np.empty((steps + 1, *changes.shape)) for _ in range(2))
        limited(model, model.limits, speeds, targets, changes, 1, along, places, paces)
        return _by_state(places), _by_state(paces)
    law = _law(model)
    shape = (len(speeds), len(plans))
    v = np.broadcast_to(np.array(speeds, dtype=np.float64)[:, None], shape)
    goal = np.broadcast_to(np.array(targets, dtype=np.float64)[:, None], shape)
    s = np.zeros(shape)
    distances, reached = [np.zeros((*shape, 1))], [v[..., None]]
    for change in _known_changes(plans, -(-steps // model.substeps)):
        index = np.minimum(np.maximum(np.rint((v - law.low) / law.span * law.top), 0), law.top)
        goal = np.where(change != 0, law.low + law.spacing * np.minimum(np.maximum(index + change, 0), law.top), goal)
        goal = np.where(np.isnan(change), v, goal)
        excess = v - goal
        distances.append(s[..., None] + goal[..., None] * law.elapsed + excess[..., None] * law.summed)
        reached.append(goal[..., None] + excess[..., None] * law.left)
        s, v = distances[-1][..., -1], reached[-1][..., -1]
    return np.concatenate(distances, axis=-1)[..., : steps + 1], np.concatenate(reached, axis=-1)[..., : steps + 1]


def travelled(
    model: DrivingModel,
    speeds: Sequence[float],
    targets: Sequence[float],
    plans: tuple[Plan, ...],
    samples: int,
    stride: int,
    paired: bool = False,
    along: Sequence[Along] = (),
) -> Array:
    """Return the distances of `rollout` at every `stride`-th step, bit for bit, without working out the others.

    Where vehicles have limits and are not paired, the lowest and the highest bound of all plans follow as two more.
    """
    substeps, decisions = model.substeps, -(-samples * stride // model.substeps)
    bounds = model.limits is not None and not paired
    steps_of = _target_steps if paired else _known_target_steps
    changes = steps_of(model, plans, decisions, len(speeds), paired, bounds)
    found = np.empty((samples + 1, *changes.shape))
    if model.limits is not None:
        limited(model, model.limits, speeds, targets, changes, stride, along, found)
        return _by_state(found)
    law, shape = _law(model), changes.shape
    v, place, goal, kept, part = (np.empty(shape) for _ in range(5))
    v.T[...], goal.T[...], place[...], found[0] = speeds, targets, 0.0, 0.0
    left, elapsed, summed = (np.array(each[-1]) for each in (law.left, law.elapsed, law.summed))
    for k in range(decisions):
        goal, kept = kept, goal
        changes.apply(k, v, goal, kept, v)
        over = np.subtract(v, goal, v)
        # Samples until the next decision, and the steps since this one at each of them.
        first, last = k * substeps // stride, min((k + 1) * substeps // stride, samples)
        since = (np.arange(first + 1, last + 1) * stride - 1 - k * substeps).reshape(-1, *(1,) * len(shape))
        # Distances add up in the order of `rollout`: what the target gives, then what the excess gives.
        moved = np.multiply(goal, law.elapsed[since], out=found[first + 1 : last + 1])
        moved += place
        moved += over * law.summed[since]
        np.multiply(goal, elapsed, part)
        np.add(place, part, place)
        np.multiply(over, summed, part)
        np.add(place, part, place)
        np.multiply(over, left, v)
        np.add(v, goal, v)
    return _by_state(found)


def _by_state(samples: Array) -> Array:
    """Turn an array that has a row for each time into one with the times last."""
    return np.ascontiguousarray(np.moveaxis(samples, 0, -1))
