"""The library of simple plans by which vehicles are expected to keep a passing order."""

from codriving.datatypes.action import Action
from codriving.prediction.rollout import Plan

FIRST = (Action.FASTER, Action.IDLE, Action.SLOWER)
"""What a vehicle may do now, most progress first."""

WAITS = (0, 1, 2, 3, 4, 6, 8, 11, 14)
"""For how many decisions it may then slow down before it goes for good."""

PLANS: tuple[Plan, ...] = tuple(
    dict.fromkeys(
        plan
        for first in FIRST
        for plan in (*((first, *(Action.SLOWER,) * k, Action.FASTER) for k in WAITS), (first, Action.SLOWER))
    )
)
"""Every plan: something now, then slowing down for a while or for good, then going."""

STARTS_WITH: dict[Action, tuple[int, ...]] = {
    first: tuple(i for i, plan in enumerate(PLANS) if plan[0] is first) for first in FIRST
}
"""Indices of the plans that begin with an action."""
