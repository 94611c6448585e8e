"""The built-in rule reasoner behind ``llm=offline``: it sees what a model would be told, and nothing else."""

import math
from collections.abc import Sequence

from codriving.datatypes.action import Action
from codriving.datatypes.situation import Decision, Situation

EAGERNESS = (Action.FASTER, Action.IDLE, Action.SLOWER)
"""Actions from the most to the least progress."""


TOLERANCE = 1.5
"""Progress that is given up to be closer when the way becomes free earlier than expected [m]."""


class RuleDecider:
    """Goes as fast as is safe and as the passing order allows."""

    def decide(self, situations: Sequence[Situation]) -> list[Decision]:
        """Return one decision a situation, in the same order.

        Args:
            situations: What each CAV is told.
        """
        return [decide_one(situation) for situation in situations]


def decide_one(situation: Situation) -> Decision:
    """Take the allowed action that gets the CAV farthest if it lets those pass who go first; if equal, the fastest.

    Args:
        situation: What the CAV is told.
    """
    ego = situation.scene.ego.id
    allowed = [action for action in EAGERNESS if action in situation.allowed]
    if not allowed:
        return Decision(ego, situation.allowed[0], "the only action that the safety check left")
    if any(a.safe and a.reasons for a in situation.assessments):
        return Decision(ego, allowed[0], f"no action is safe, and {allowed[0]} is the least dangerous")
    reached = {a.action: a.progress for a in situation.assessments if a.action in allowed and a.progress is not None}
    waits_for = _first(situation)
    if not reached:
        reason = (
            f"the order cannot be kept with {waits_for or 'others'}; {allowed[-1]} is the slowest action that is safe"
        )
        return Decision(ego, allowed[-1], reason)
    best = max(reached.values())
    action = next(action for action in allowed if reached.get(action, -math.inf) >= best - TOLERANCE)
    return Decision(ego, action, _reason(action, allowed, waits_for))


def _first(situation: Situation) -> str:
    ego = situation.scene.ego.id
    names = [p.first for p in situation.order.precedences if p.second == ego]
    return ", ".join(dict.fromkeys(names))


def _reason(action: Action, allowed: list[Action], waits_for: str) -> str:
    if waits_for:
        return f"{action} still lets {waits_for} pass first"
    if action is Action.FASTER:
        return "nobody goes first and accelerating is safe"
    if action is allowed[0]:
        return f"nobody goes first, and {action} is the fastest action that is safe"
    return f"nobody goes first, and {action} gets farther in the end behind those ahead"
