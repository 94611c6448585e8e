"""What CAVs do when they are given lists of actions: highway-env's rule, simulated exactly; the library of plans."""

from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property, lru_cache
from math import nan

import numpy as np

from codriving.datatypes import Action, DrivingModel
from codriving.geometry import Along, Array, TargetSteps, limited, unlimited

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


class Library(tuple[Plan, ...]):
    """Plans that are looked up at every step; their hash, of a thousand actions, is worked out once."""

    def __hash__(self) -> int:
        return self._hash

    def __reduce__(self) -> tuple[type, tuple[tuple[Plan, ...]]]:
        return Library, (tuple(self),)  # Texts have another hash in another process

    @cached_property
    def _hash(self) -> int:
        return super().__hash__()


# Every plan: something now, then slowing down or rolling for a while or for good, then going or keeping the speed.
HOLDING_PLANS = Library(dict.fromkeys(plan for first in FIRST for plan in _after(first)))

PLANS = Library(plan for plan in HOLDING_PLANS if Action.HOLD not in plan)  # Those of five actions


def plan_library(model: DrivingModel) -> Library:
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


def _target_steps(
    model: DrivingModel, plans: tuple[Plan, ...], decisions: int, states: int, paired: bool, bounds: bool
) -> TargetSteps:
    """What plans ask of so many states."""
    return TargetSteps(model, _changes(plans, decisions), states, paired, bounds)


_known_target_steps = lru_cache(maxsize=32)(_target_steps)  # Those of libraries, which are asked for at every step


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
    changes = _known_target_steps(model, plans, -(-steps // model.substeps), len(speeds), False, False)
    places, paces = (np.empty((steps + 1, *changes.shape)) for _ in range(2))
    if model.limits is None:
        unlimited(model, speeds, targets, changes, 1, places, paces)
    else:
        limited(model, model.limits, speeds, targets, changes, 1, along, places, paces)
    return _by_state(places), _by_state(paces)


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
    decisions, bounds = -(-samples * stride // model.substeps), model.limits is not None and not paired
    steps_of = _target_steps if paired else _known_target_steps
    changes = steps_of(model, plans, decisions, len(speeds), paired, bounds)
    found = np.empty((samples + 1, *changes.shape))
    if model.limits is not None:
        limited(model, model.limits, speeds, targets, changes, stride, along, found)
        return _by_state(found)
    unlimited(model, speeds, targets, changes, stride, found)
    return _by_state(found)


def _by_state(samples: Array) -> Array:
    """Turn an array that has a row for each time into one with the times last."""
    return np.ascontiguousarray(np.moveaxis(samples, 0, -1))
