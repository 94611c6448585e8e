"""Reasoning by rule, for ``llm=offline``: the demonstrated pattern, and no mistake that is remembered."""

from collections.abc import Sequence
from dataclasses import replace

from codriving.datatypes.situation import Decision
from codriving.dilu.thinker import Thought
from codriving.dilu.told import Told
from codriving.reasoning.decision.cases import reconsider
from codriving.single_vehicle.account import account
from codriving.single_vehicle.protocol import Driver


class RuleThinker:
    """Stands in for the language model; this is not DiLu, and tables call it ``dilu-rule``.

    Args:
        rule: Decides for one CAV at a time.
    """

    def __init__(self, rule: Driver) -> None:
        self.rule = rule
        rule.reset()

    def decide(self, told: Sequence[Told]) -> list[Thought]:
        """Return one thought a CAV, in the same order.

        Args:
            told: What each CAV is told, with what it remembers.
        """
        return [self._decide(one) for one in told]

    def _decide(self, told: Told) -> Thought:
        choice = self.rule.decide(told.view)
        situation = replace(account(told.view, choice), memories=told.situation.memories)
        decision = reconsider(situation, Decision(situation.scene.ego.id, choice.action, choice.reason))
        return Thought(decision, situation, choice.counts)
