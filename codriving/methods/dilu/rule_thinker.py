"""Reasoning by rule, for ``llm=offline``: the demonstrated pattern, and no mistake that is remembered."""

from collections.abc import Sequence
from dataclasses import replace

from codriving.datatypes.experience import Verdict
from codriving.datatypes.situation import Decision, Situation
from codriving.methods.dilu.thinker import Thought
from codriving.methods.dilu.told import Told
from codriving.methods.single_vehicle.demonstrated import PREFERRED
from codriving.methods.single_vehicle.method import Driver, account
from codriving.reasoning.decision.cases import favour


class RuleThinker:
    """Stands in for the language model; this is not DiLu, and tables call it ``dilu-rule``."""

    def __init__(self, rule: Driver) -> None:
        self.rule = rule
        rule.reset()

    def decide(self, told: Sequence[Told]) -> list[Thought]:
        """Return one thought a CAV, in the same order."""
        return [self._decide(one) for one in told]

    def _decide(self, told: Told) -> Thought:
        choice = self.rule.decide(told.moment, told.ego)
        situation = replace(account(told.moment, told.ego, choice), memories=told.situation.memories)
        decision = corrected(situation, Decision(situation.scene.ego.id, choice.action, choice.reason))
        return Thought(decision, situation, choice.counts)


def corrected(situation: Situation, decision: Decision) -> Decision:
    """Repeat no mistake: take the next slower acceptable action if what is remembered speaks against a decision.

    Whoever would change lanes takes the fastest acceptable action along the lane instead.

    Returns:
        A decision; ``recalled`` names the memories that changed it.
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
    return replace(
        decision,
        action=other,
        reason=f"{action} was a mistake {times} in situations like this one, so {other}",
        recalled=tuple(m.id for m in cases),
    )
