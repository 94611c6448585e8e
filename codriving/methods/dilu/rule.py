"""DiLu without a language model, ``llm=offline``: it decides by the demonstrated pattern and repeats no mistake."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

from codriving.datatypes import Action, Decision, Situation, Verdict
from codriving.methods.dilu.collision_log import Correction, Mistake
from codriving.methods.single_vehicle.demonstrated import PREFERRED
from codriving.methods.single_vehicle.method import Driver, account
from codriving.reasoning import SIDES, Moment, favour


def decide_by_rule(
    rule: Driver, moment: Moment, situations: Sequence[Situation]
) -> tuple[list[Situation], list[Decision], Counter[str]]:
    """Stand in for the language model; this is not DiLu, and tables call it ``dilu-rule``."""
    egos = [situation.scene.ego.id for situation in situations]
    choices = [rule.decide(moment, ego) for ego in egos]
    accounts = [account(moment, ego, choice) for ego, choice in zip(egos, choices, strict=True)]
    based_on = [replace(own, memories=s.memories) for own, s in zip(accounts, situations, strict=True)]
    plain = [Decision(ego, choice.action, choice.reason) for ego, choice in zip(egos, choices, strict=True)]
    decisions = [corrected(situation, decision) for situation, decision in zip(based_on, plain, strict=True)]
    counts = Counter[str]()
    for choice in choices:
        counts.update(choice.counts)
    return based_on, decisions, counts


def corrected(situation: Situation, decision: Decision) -> Decision:
    """Repeat no mistake: take the next slower acceptable action if what is remembered speaks against a decision.

    A lane change is replaced by the fastest acceptable action along the lane.
    """
    memories, action = situation.memories, decision.action
    if favour(memories, action) >= 0:
        return decision
    slower = PREFERRED[PREFERRED.index(action) + 1 :] if action in PREFERRED else PREFERRED
    other = next((a for a in slower if a in situation.allowed and favour(memories, a) >= 0), None)
    if other is None:
        return decision
    cases = [m for m in memories if m.action is action and m.verdict is Verdict.INTENSIFIED]
    number = sum(m.count for m in cases)
    times = "once" if number == 1 else f"{number} times"
    reason = f"{action} was a mistake {times} in situations like this one, so {other}"
    return replace(decision, action=other, reason=reason, recalled=tuple(m.id for m in cases))


def correct_by_rule(mistakes: Sequence[Mistake]) -> list[Correction]:
    """Return one correction a mistake: a CAV should have slowed down, one that changed lanes should have stayed."""
    return [correct_one(mistake) for mistake in mistakes]


def correct_one(mistake: Mistake) -> Correction:
    """Correct one mistake by rule."""
    action = mistake.decision.action
    how = "you ran into another vehicle" if mistake.struck else "another vehicle ran into you"
    wrong = f"{action}, and {mistake.later:.1f} s later {how}."
    if action in SIDES:
        return Correction(Action.IDLE, wrong, "Stay on the lane in a situation like this.")
    return Correction(Action.SLOWER, wrong, "Slow down in time in a situation like this.")
