"""Case-based reasoning for the built-in rules: what was a mistake in the most similar cases is not repeated.

The rules see of a memory what a model is told: what was done, what that did to the conflict, how alike the situation
was and how often it happened.
"""

from collections.abc import Iterable
from dataclasses import replace
from math import log2

from codriving.datatypes.action import Action
from codriving.datatypes.experience import Memory, Verdict
from codriving.datatypes.situation import Decision, Situation

BY_SPEED = (Action.SLOWER, Action.IDLE, Action.FASTER)
"""Actions along the lane from the slowest to the fastest."""


def reconsider(situation: Situation, decision: Decision) -> Decision:
    """Take another action than the rules would if the memories speak against it.

    An action is avoided if, among the cases in which it was taken, those in which it intensified the conflict weigh
    more than those in which it did no harm; then whatever is safe, and of which the same cannot be said, is taken
    instead, first what eased the conflict, then what gets the CAV farthest. An action that was too cautious gives way
    to the next faster one that is safe and was not a mistake. If nothing else is safe, the decision stands.

    Args:
        situation: What the CAV is told, with its memories.
        decision: What the rules decide without them.

    Returns:
        A decision; ``recalled`` names the memories that changed it.
    """
    if not situation.memories or any(a.safe and a.reasons for a in situation.assessments):
        return decision
    against = weight(situation.memories, decision.action, Verdict.INTENSIFIED)
    favour = weight(situation.memories, decision.action, Verdict.EASED)
    cautious = weight(situation.memories, decision.action, Verdict.TOO_CAUTIOUS)
    if against > favour + cautious:
        other = _instead(situation, decision.action)
        return _changed(situation, decision, other, Verdict.INTENSIFIED, "intensified the conflict")
    if cautious > favour + against:
        other = _faster(situation, decision.action)
        return _changed(situation, decision, other, Verdict.TOO_CAUTIOUS, "was too cautious")
    return decision


def weight(memories: Iterable[Memory], action: Action, verdict: Verdict) -> float:
    """Weigh the cases in which an action had a certain effect: by how alike and, more slowly, how many they are.

    Args:
        memories: The memories.
        action: The action.
        verdict: Its effect.
    """
    return sum(m.similarity * (1 + log2(m.count)) for m in memories if (m.action, m.verdict) == (action, verdict))


def _is_mistake(situation: Situation, action: Action) -> bool:
    against = weight(situation.memories, action, Verdict.INTENSIFIED)
    return against > weight(situation.memories, action, Verdict.EASED)


def _instead(situation: Situation, avoided: Action) -> Action | None:
    """The best of the other safe actions along the lane, none of which was a mistake itself."""
    others = [
        a
        for a in situation.assessments
        if a.safe and a.action is not avoided and a.action in BY_SPEED and not _is_mistake(situation, a.action)
    ]
    if not others:
        return None
    return max(
        others,
        key=lambda a: (
            weight(situation.memories, a.action, Verdict.EASED),
            a.progress is not None,
            a.progress or 0.0,
            -BY_SPEED.index(a.action),
        ),
    ).action


def _faster(situation: Situation, cautious: Action) -> Action | None:
    """The next faster action that is safe and was not a mistake."""
    if cautious not in BY_SPEED:
        return None
    for action in BY_SPEED[BY_SPEED.index(cautious) + 1 :]:
        if action in situation.allowed and not _is_mistake(situation, action):
            return action
    return None


def _changed(situation: Situation, decision: Decision, other: Action | None, verdict: Verdict, what: str) -> Decision:
    if other is None:
        return decision
    cases = [m for m in situation.memories if (m.action, m.verdict) == (decision.action, verdict)]
    number = sum(m.count for m in cases)
    times = "once" if number == 1 else f"{number} times"
    return replace(
        decision,
        action=other,
        reason=f"{decision.action} {what} {times} in situations like this one, so {other}",
        recalled=tuple(m.id for m in cases),
    )
