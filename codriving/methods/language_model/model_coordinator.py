"""The conflict coordinator by a language model: asked about CAVs in conflict, if something changed."""

from collections.abc import Iterable, Mapping
from copy import copy
from typing import cast

from codriving.datatypes import Conflict, Pair, PassingOrder, SceneDescription
from codriving.llm import Names, OrderReply, Question, first_of_pairs, negotiation_view, order_reply, pair_names
from codriving.methods.language_model.model_decider import THOUGHTS
from codriving.methods.language_model.prompted_model import PromptedModel
from codriving.protocol import with_given, without_circles
from codriving.reasoning import (
    Coordinator,
    Moment,
    Premise,
    Problem,
    RuleCoordinator,
    find_circle,
    open_pairs,
    pose,
    premise,
)

AgreedPairs = dict[Pair, str]  # Pairs of CAVs, the one that goes first first, and why

# A pair takes 10 tokens in the form that is asked for, 15 where names are long, and 25 in the form of version 0.1.
TOKENS_A_PAIR = 25

OpenPairs = Mapping[str, Conflict]  # The pairs of a question: the most urgent conflict of each, by the name of the pair


class ModelCoordinator(Coordinator):
    """Asks a model who goes first in each pair of CAVs; the rules do the rest.

    The rules settle what cannot be negotiated: pairs that are physically fixed, and pairs with human drivers, who
    answer no message. From the model's pairs they work out when each CAV passes, as for an order of their own.

    An answer is kept as long as its premise holds, see ``Premise``, and nothing that it says has become impossible.

    What an answer leaves out or gets wrong is decided by the rules, and the least severe link of a circle is dropped;
    both count as a repaired order. Without an answer, the rules decide everything, and the ledger counts a fallback.
    """

    def __init__(self, model: PromptedModel, binding: bool) -> None:
        self.model, self.rules = model, RuleCoordinator(binding)
        self._agreed: tuple[Premise, AgreedPairs] | None = None

    def negotiate(self, moment: Moment, given: Mapping[Pair, str] | None = None) -> PassingOrder:
        """Return an order without cycles for all conflicts."""
        given = given or {}
        problem = with_given(pose(moment), given)
        urgent = most_urgent(problem, moment.conflicts)
        asked = open_pairs(problem.instance, urgent)
        if not asked:
            self._agreed = None
            return self.rules.settle(moment, problem, given)
        now = premise(problem.instance, asked)
        agreed = self._kept(problem, now)
        if agreed is not None:
            self.model.ledger.count("kept_orders")
            return self.rules.settle(moment, problem, {**agreed, **given})
        agreed, mended = self.ask(moment.scenes, problem, [urgent[pair] for pair in asked])
        by_rules = copy(self.rules).settle(moment, problem, given)
        order = self.rules.settle(moment, problem, {**(agreed or {}), **given})
        if agreed is None:
            # Nothing has been agreed on, and the next step asks again.
            self._agreed = None
            self.model.ledger.count("fallback_pairs", len(asked))
            return order
        self._agreed = now, _decided(order, asked)
        said = agreed.keys() & self._agreed[1].keys()
        self.model.ledger.ordered(len(asked), len(said), mended, len(said & _decided(by_rules, asked).keys()))
        return order

    def _kept(self, problem: Problem, now: Premise) -> AgreedPairs | None:
        """Return the pairs of the last answer that are still open if the answer can be kept."""
        if self._agreed is None or not self._agreed[0].still_holds(now):
            return None
        agreed = self._agreed[1]
        if find_circle({*agreed, *problem.instance.before}) is not None:
            return None
        return {pair: why for pair, why in agreed.items() if pair in now.leads or pair[::-1] in now.leads}

    def ask(
        self, scenes: Mapping[str, SceneDescription], problem: Problem, conflicts: Iterable[Conflict]
    ) -> tuple[AgreedPairs | None, bool]:
        """Ask the model, and repair what it says; None if there is no answer. Tells whether it was read tolerantly."""
        by_urgency = sorted(conflicts, key=lambda c: (c.dttcp + 0.2 * min(c.ttcp), c.ego, c.other))
        names = Names([*problem.instance.vehicles, *sorted({h for each in problem.passages.values() for h in each})])
        both = [(names(c.ego), names(c.other)) for c in by_urgency]
        pairs = dict(zip(pair_names(both, self.model.prompts.informed), by_urgency, strict=True))
        [answer] = self.model.ask([self._question(scenes, problem, pairs, names)])
        if answer.value is None:
            return None, False
        said = first_of_pairs(cast(OrderReply, answer.value))
        agreed: AgreedPairs = {}
        for name, (first, reason) in said.items():
            c = pairs[name]
            pair = (c.ego, c.other) if first == names(c.ego) else (c.other, c.ego)
            agreed[pair] = reason or f"{first} was told to go first"
        apart = {frozenset((c.ego, c.other)): c.dttcp for c in pairs.values()}
        # The least severe link of a circle goes.
        acyclic = without_circles(
            agreed, problem.instance, lambda links: max(links, key=lambda pair: (apart[frozenset(pair)], pair))
        )
        if len(acyclic) < len(pairs):
            self.model.ledger.count("repaired_orders")
        return acyclic, answer.mended

    def _question(
        self, scenes: Mapping[str, SceneDescription], problem: Problem, pairs: OpenPairs, names: Names
    ) -> Question:
        shown = _shown(pairs, names)
        listed, rules = list(pairs.items()), self.rules
        told = rules.previous, names, rules.binding, problem.passages, self.model.thoughts
        values = negotiation_view(scenes, problem.instance, listed, *told)

        def check(reply: object) -> str:
            if first_of_pairs(cast(OrderReply, reply)):
                return ""
            wanted = "; ".join(f"{name}: {one} or {other}" for name, (one, other) in shown.items())
            return f"no pair was ordered; say who goes first in each pair ({wanted})"

        def shorter() -> Question | None:
            """Ask about the more urgent half; the rest is decided by the rules."""
            half = dict(list(pairs.items())[: len(pairs) // 2])
            return self._question(scenes, problem, half, names) if half else None

        messages = self.model.prompts.messages("negotiate", values)
        more = TOKENS_A_PAIR * len(pairs) + (THOUGHTS if self.model.thoughts else 0)
        return Question("negotiate", "", messages, order_reply(shown, self.model.thoughts), check, shorter, more)


def most_urgent(problem: Problem, conflicts: Mapping[str, tuple[Conflict, ...]]) -> dict[Pair, Conflict]:
    """Return the most urgent conflict of each pair of CAVs, seen from the one with the lower id."""
    vehicles = problem.instance.vehicles
    found: dict[Pair, Conflict] = {}
    for ego in sorted(vehicles):
        for c in conflicts[ego]:
            if c.other in vehicles and (c.other, ego) not in found:
                found.setdefault((ego, c.other), c)
    return found


def _shown(pairs: OpenPairs, names: Names) -> dict[str, tuple[str, str]]:
    return {name: (names(c.ego), names(c.other)) for name, c in pairs.items()}


def _decided(order: PassingOrder, asked: Iterable[Pair]) -> AgreedPairs:
    """Return what has become of the pairs that were asked about."""
    wanted = {frozenset(pair) for pair in asked}
    return {(p.first, p.second): p.reason for p in order.precedences if frozenset((p.first, p.second)) in wanted}
