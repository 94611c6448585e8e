"""The paper's algorithm: share states, share intents, negotiate, check, recall, decide (Algorithm 1)."""

from dataclasses import dataclass, field

from codriving.briefing import Briefing
from codriving.datatypes import CaseMemory, ReasonedDeliberation, Situation, WorldState
from codriving.judgement import judgements_of
from codriving.llm import Ledger
from codriving.methods.experience_log import recall
from codriving.reasoning import (
    Decider,
    Negotiation,
    Perception,
    SafetyCheck,
    SafetyInput,
    clear_time,
    expect_all,
    safety_input,
)


@dataclass(slots=True)
class Pipeline:
    """One episode of the paper's reasoning; an ablation puts another object into a slot."""

    perception: Perception
    negotiation: Negotiation
    safety: SafetyCheck
    decider: Decider
    margin: float  # Time that should lie between one vehicle's leaving a zone and the next one's entering it [s]
    memory: CaseMemory | None = None  # Experiences of like situations; None without the memory module
    ledger: Ledger | None = None  # What is asked of a language model; None if none is
    briefing: Briefing = field(default_factory=Briefing)

    def act(self, world: WorldState) -> ReasonedDeliberation:
        """Decide for every CAV on the road."""
        moment = self.perception.perceive(world)
        orders = self.negotiation.orders(moment)
        orders = {ego: orders[ego] for ego in world.deciding}
        lag = round(self.margin / moment.forecast.sample)
        expected = expect_all(moment, orders, lag)
        if self.ledger is not None:
            self.briefing.note(moment)
        inputs = [safety_input(moment, ego, orders[ego], expected[ego], lag) for ego in orders]
        situations = recall(self.memory, [self._situation(given) for given in inputs])
        decisions = tuple(self.decider.decide(situations))
        counts, lines = self.ledger.close_step(world.time) if self.ledger is not None else ({}, [])
        if self.memory is not None:
            recalled, reconsidered = sum(len(s.memories) for s in situations), sum(bool(d.recalled) for d in decisions)
            counts = {**counts, "recalled": recalled, "reconsidered": reconsidered}
        return ReasonedDeliberation(world.time, world.step, tuple(situations), decisions, counts, tuple(lines))

    def _situation(self, given: SafetyInput) -> Situation:
        clear_times = tuple(clear_time(given, c) for c in given.conflicts)
        told, assessed = judgements_of(given.moment, given.ego), self.safety.assess(given)
        outlook = self.briefing.outlook(given) if self.ledger is not None else None
        known = given.scene, given.conflicts, given.order, clear_times, assessed
        return Situation(*known, judgements=told, outlook=outlook)
