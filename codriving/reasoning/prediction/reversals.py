"""What it costs a plan to take back at once what was begun: FASTER after SLOWER, or SLOWER after FASTER."""

from functools import lru_cache
from itertools import pairwise

import numpy as np

from codriving.datatypes import Action
from codriving.geometry import Array
from codriving.reasoning.prediction.rollout import Plan

# Distance that a reversal counts as, from one decision to the next and with others in between [m].
AT_ONCE, LATER = 1.0, 0.5

CHANGING = 0.3  # A vehicle whose target differs by less from its speed keeps that [m/s]

SIGNS = {Action.FASTER: 1, Action.SLOWER: -1}


def reverses(action: Action, speed: float, target: float) -> bool:
    """Whether an action takes back what a vehicle is doing, which its target speed [m/s] tells."""
    return abs(target - speed) > CHANGING and SIGNS.get(action, 0) * (target - speed) < 0


def price(speed: float, target: float, plans: tuple[Plan, ...]) -> Array:
    """Return what the reversals of plans count as, the first one against what the vehicle is doing (plans,) [m]."""
    within, back = _prices(plans)
    first = next((a for a in SIGNS if reverses(a, speed, target)), None)
    return within if first is None else within + AT_ONCE * back[first]


@lru_cache(maxsize=64)
def _prices(plans: tuple[Plan, ...]) -> tuple[Array, dict[Action, Array]]:
    """Return the price of the reversals within plans [m], and which of them begin with an action, by that."""
    within = np.array([_within(plan) for plan in plans])
    return within, {first: np.array([float(plan[0] is first) for plan in plans]) for first in SIGNS}


def _within(plan: Plan) -> float:
    changes = [(k, SIGNS[action]) for k, action in enumerate(plan) if action in SIGNS]
    pairs = pairwise(changes)
    return sum(AT_ONCE if later - k == 1 else LATER for (k, one), (later, other) in pairs if one != other)
