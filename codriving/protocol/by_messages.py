"""The negotiation of one CAV by messages: what is agreed on with others, and its own estimates for the rest."""

from collections.abc import Mapping
from dataclasses import replace

from codriving.datatypes import Pair, PassingOrder
from codriving.protocol.negotiator import Negotiator
from codriving.protocol.refusal import not_in, without_circles
from codriving.reasoning import Moment, Negotiation, Problem, RuleCoordinator, pose


class ByMessages(Negotiation):
    """Goes by the agreements in force; of CAVs with which there is none it makes up its own mind."""

    def __init__(self, party: Negotiator, own: Negotiation) -> None:
        self.party, self._own = party, own
        self._rules = RuleCoordinator(False)

    def orders(self, moment: Moment) -> Mapping[str, PassingOrder]:
        """Return the order that the party goes by; none if it is no CAV."""
        problem, ego = pose(moment), self.party.settings.party
        agreed = self.party.step(moment, problem)
        return {ego: self._completed(moment, ego, problem, agreed)} if ego in moment.scenes else {}

    def _completed(self, moment: Moment, ego: str, problem: Problem, agreed: Mapping[Pair, str]) -> PassingOrder:
        """Return an order with what is agreed on and the CAV's own estimates in it; the rest is as the rules say."""
        there, settled = problem.instance.vehicles.keys(), {frozenset(pair) for pair in agreed}
        own = self._own.orders(replace(moment, scenes={ego: moment.scenes[ego]}))[ego]
        ours = {(p.first, p.second): p.reason for p in own.precedences if frozenset((p.first, p.second)) not in settled}
        given = {pair: why for pair, why in {**agreed, **ours}.items() if there >= set(pair)}
        self._rules.binding = self.party.directed(ego)
        return self._rules.settle(moment, problem, without_circles(given, problem.instance, not_in(agreed)))
