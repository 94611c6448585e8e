"""Case-based reasoning for the built-in rules: what was a mistake in the most similar cases is not repeated.

The rules see of a memory what a model is told: what was done, what that did to the conflict, how alike the situation
was and how often it happened.
"""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from math import log2

from codriving.datatypes import Action, ActionAssessment, Decision, Memory, Situation, Verdict

# How an effect speaks for or against an action.
SIGNS = {Verdict.EASED: 1.0, Verdict.INTENSIFIED: -1.0, Verdict.TOO_CAUTIOUS: -1.0}


def reconsider(situation: Situation, decision: Decision) -> Decision:
    """Take another action than the rules would if the memories speak against it.

    The cases in which an action was taken speak for it if it eased the conflict, and against it if it intensified the
    conflict or was too cautious. If they speak against what the rules decide, the CAV does something else that is safe
    and that they speak less against: something faster if it was too cautious, and otherwise what they speak most for,
    or what gets it farthest if they are silent. If there is none, as when only the least dangerous action is left,
    the decision stands.
    """
    against = favour(situation.memories, decision.action)
    if against >= 0:
        return decision
    verdict = _main_objection(situation.memories, decision.action)
    rank_of = situation.scene.speed_rank
    safe = [(a, rank) for a in situation.assessments if a.safe and (rank := rank_of(a.action)) is not None]
    others = [(a, rank) for a, rank in safe if favour(situation.memories, a.action) > against]
    if verdict is Verdict.TOO_CAUTIOUS:
        taken = rank_of(decision.action)
        others = [(a, rank) for a, rank in others if taken is not None and rank > taken]
    if not others:
        return decision
    best, _ = max(others, key=lambda pair: _preference(situation.memories, *pair))
    return _changed(situation, decision, best.action, verdict)


def favour(memories: Iterable[Memory], action: Action) -> float:
    """Weigh the cases in which an action was taken: by how alike and, more slowly, how many they are.

    Returns:
        Positive if they speak for it, negative if they speak against it, 0 if they are silent.
    """
    return sum(_weight(m) * SIGNS.get(m.verdict, 0.0) for m in memories if m.action is action)


def _weight(memory: Memory) -> float:
    return memory.similarity * (1 + log2(memory.count))


def _main_objection(memories: Iterable[Memory], action: Action) -> Verdict:
    return max(
        (Verdict.INTENSIFIED, Verdict.TOO_CAUTIOUS),
        key=lambda verdict: sum(_weight(m) for m in memories if (m.action, m.verdict) == (action, verdict)),
    )


def _preference(memories: Sequence[Memory], a: ActionAssessment, rank: float) -> tuple[float, bool, float, float]:
    """What the memories say counts first, then whether the order is kept, how far the CAV gets, and braking less."""
    return favour(memories, a.action), a.progress is not None, a.progress or 0.0, rank


def _changed(situation: Situation, decision: Decision, other: Action, verdict: Verdict) -> Decision:
    cases = [m for m in situation.memories if (m.action, m.verdict) == (decision.action, verdict)]
    number = sum(m.count for m in cases)
    times = "once" if number == 1 else f"{number} times"
    what = "was too cautious" if verdict is Verdict.TOO_CAUTIOUS else "intensified the conflict"
    return replace(
        decision,
        action=other,
        reason=f"{decision.action} {what} {times} in situations like this one, so {other}",
        recalled=tuple(m.id for m in cases),
    )
