"""Decisions by a language model: one question a CAV, all asked at once; each may choose what is left to it."""

from abc import abstractmethod
from collections.abc import Sequence
from typing import Any, ClassVar, cast

from codriving.briefing import PastDecisions, nothing_to_judge
from codriving.datatypes import Action, Decision, Situation
from codriving.llm import Answer, DecisionReply, Question, decision_reply, decision_view, names_for
from codriving.methods.language_model.prompted_model import PromptedModel
from codriving.reasoning import Decider, RuleDecider, is_plain

# Actions in the order in which they stand in for an answer that is missing.
SAFEST = (Action.SLOWER, Action.IDLE, Action.HOLD, Action.FASTER, Action.LANE_RIGHT, Action.LANE_LEFT)


THOUGHTS = 250  # How much longer an answer may be that thoughts precede [tokens]


class ModelDecider(Decider):
    """Asks a model for every CAV, all in one go; a method has a template, its variables and a fallback of its own."""

    template: ClassVar[str]  # Which template is filled in
    plans = False  # Whether a decision comes with a plan

    def __init__(self, model: PromptedModel) -> None:
        self.model = model

    @abstractmethod
    def variables(self, situation: Situation, nearest: int | None, with_memories: bool) -> dict[str, Any]:
        """Return the variables of the template."""

    @abstractmethod
    def objection(self, situation: Situation, action: str) -> str:
        """Say why an action that is not allowed cannot be chosen."""

    @abstractmethod
    def substitute(self, situation: Situation) -> Action:
        """Return the action that stands in for an answer that is missing."""

    def by_rules(self, situation: Situation) -> Action | None:
        """Return what the rules would have decided in a situation; None where there are none to compare with."""
        return None

    def decide(self, situations: Sequence[Situation]) -> list[Decision]:
        """Return one decision a situation, in the same order."""
        answers = self.model.ask([self.question(situation) for situation in situations])
        return [self._decision(*pair) for pair in zip(situations, answers, strict=True)]

    def question(self, situation: Situation, nearest: int | None = None, with_memories: bool = True) -> Question:
        """Return what the model is asked for one CAV, see ``variables``."""
        allowed = [str(action) for action in situation.allowed]

        def check(reply: object) -> str:
            action = cast(DecisionReply, reply).action
            return "" if action in allowed else self.objection(situation, action)

        def shorter() -> Question | None:
            """Leave out the memories, then again and again the farther half of the vehicles."""
            if situation.memories and with_memories:
                return self.question(situation, nearest, False)
            left = (len(situation.scene.neighbours) if nearest is None else nearest) // 2
            return self.question(situation, left, False) if left else None

        variables = self.variables(situation, nearest, with_memories)
        messages = self.model.prompts.messages(self.template, variables)
        form = decision_reply(tuple(allowed), self.model.thoughts, self.plans)
        more = THOUGHTS if self.model.thoughts else 0
        return Question("decide", situation.scene.ego.id, messages, form, check, shorter, more)

    def _decision(self, situation: Situation, answer: Answer) -> Decision:
        ego, reply, ledger = situation.scene.ego.id, cast(DecisionReply | None, answer.value), self.model.ledger
        if reply is not None and reply.action in situation.allowed:
            rule = self.by_rules(situation)
            ledger.decided(len(situation.allowed), answer.mended, None if rule is None else reply.action == rule)
            return Decision(ego, Action(reply.action), reply.reason or "no reason was given")
        problem = answer.problem
        if reply is not None:
            # No chat should let this pass; only what is allowed is done all the same.
            ledger.count("fallbacks")
            problem = "the action is not allowed"
        ledger.count("single_decisions" if len(situation.allowed) == 1 else "fallback_decisions")
        return Decision(ego, self.substitute(situation), f"fallback, no usable answer: {problem}")


class CheckedDecider(ModelDecider):
    """CoDrivingLLM's: each CAV may choose what the safety check has left.

    The model is not asked for a CAV whose decision is plain, see ``is_plain``, nor, but with the prompts ``planner``,
    for one that has nothing to judge, see ``nothing_to_judge``; the rules decide, and the ledger counts it.
    """

    template = "decide"

    def __init__(self, model: PromptedModel, ask_plain: bool, sees_conflicts: bool) -> None:
        super().__init__(model)
        self.ask_plain, self.sees_conflicts = ask_plain, sees_conflicts
        self.plans, self._past = model.prompts.informed, PastDecisions()

    def decide(self, situations: Sequence[Situation]) -> list[Decision]:
        self._past.begin_step()
        unclear = [s for s in situations if self.ask_plain or not self._is_plain(s)]
        found = {decision.ego: decision for decision in super().decide(unclear)}
        for s in situations:
            if s.scene.ego.id not in found:
                self.model.ledger.count("single_decisions" if len(s.allowed) == 1 else "plain_decisions")
        return [found.get(s.scene.ego.id) or RuleDecider().decide([s])[0] for s in situations]

    def _is_plain(self, situation: Situation) -> bool:
        plain = is_plain(situation, self.sees_conflicts)
        return plain or (self.model.prompts.informed and nothing_to_judge(situation))

    def _decision(self, situation: Situation, answer: Answer) -> Decision:
        decision = super()._decision(situation, answer)
        self._past.note(situation, decision, getattr(answer.value, "plan", ""))
        return decision

    def by_rules(self, situation: Situation) -> Action:
        return RuleDecider().decide([situation])[0].action

    def variables(self, situation: Situation, nearest: int | None, with_memories: bool) -> dict[str, Any]:
        return decision_view(situation, nearest, with_memories, self._past.of(situation), self.model.thoughts)

    def objection(self, situation: Situation, action: str) -> str:
        names = names_for(situation)
        removed = {str(a.action): a.reasons for a in situation.assessments if not a.safe}
        why = names.sentence("; ".join(removed[action])) if action in removed else "it is no action"
        allowed = ", ".join(str(action) for action in situation.allowed)
        return f"{names.sentence(action)} cannot be chosen: {why}; choose one of: {allowed}"

    def substitute(self, situation: Situation) -> Action:
        """Return the slowest action that keeps the order, or else the slowest that is allowed.

        The rules would often drive on here. A model that does not answer is not to be driven by them in silence.
        """
        keeps = {a.action for a in situation.assessments if a.safe and a.progress is not None}
        return next(a for a in SAFEST if a in (keeps or situation.allowed))
