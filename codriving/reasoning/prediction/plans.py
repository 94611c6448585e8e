"""The library of simple plans by which vehicles are expected to keep a passing order."""

from collections.abc import Iterator

from codriving.datatypes.action import Action
from codriving.reasoning.prediction.rollout import Plan

FIRST = (Action.FASTER, Action.IDLE, Action.SLOWER)
"""What a vehicle may do now, most progress first."""

WAITS = (0, 1, 2, 3, 4, 6, 8, 11, 14)
"""For how many decisions it may then slow down before it goes for good."""

HOLDS = (0, 1, 2, 4)
"""For how many decisions it may then slow down or accelerate before it keeps its speed, as one does behind a leader."""

ROLLS = (1, 2, 3, 4, 6, 8, 11)
"""For how many decisions it may then keep its speed before it goes for good, to arrive moving when the way is free."""


def _after(first: Action) -> Iterator[Plan]:
    yield from ((first, *(Action.SLOWER,) * k, Action.FASTER) for k in WAITS)
    for slows in (0, 1):
        yield from ((first, *(Action.SLOWER,) * slows, *(Action.IDLE,) * k, Action.FASTER) for k in ROLLS)
    yield from ((first, *(change,) * k, Action.IDLE) for k in HOLDS for change in (Action.FASTER, Action.SLOWER))
    yield first, Action.SLOWER


PLANS: tuple[Plan, ...] = tuple(dict.fromkeys(plan for first in FIRST for plan in _after(first)))
"""Every plan: something now, then slowing down or rolling for a while or for good, then going or keeping the speed."""

STARTS_WITH: dict[Action, tuple[int, ...]] = {
    first: tuple(i for i, plan in enumerate(PLANS) if plan[0] is first) for first in FIRST
}
"""Indices of the plans that begin with an action."""
