"""Methods whose answers come late, while the world goes on and the safety check stays live at each decision step."""

from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

from codriving.datatypes import (
    ActionAssessment,
    Decision,
    Deliberation,
    DrivingModel,
    Method,
    PassingOrder,
    ReasonedDeliberation,
    Situation,
    WorldState,
    Wrapped,
)
from codriving.geometry import RoadMap
from codriving.methods import CoDriving, Ordered
from codriving.protocol import Negotiator
from codriving.reasoning import (
    AgreedOrder,
    CdaLevel,
    Moment,
    OwnOrders,
    SafetyInput,
    agreement,
    clear_time,
    least_dangerous,
    nearest,
    pose,
)
from codriving.wrappers.delays import Asked, Delays
from codriving.wrappers.filtered import Checked
from codriving.wrappers.late_decisions import LateAnswers, LateDecider
from codriving.wrappers.late_orders import LateCoordinator, LateOrders, LateRule

COUNTED = ("dropped_decisions", "dropped_orders", "late_decisions", "late_orders", "reflexes")


def nothing() -> Asked:
    """Return what rules ask of a language model."""
    return ()


def taken_off(counts: Counter[str]) -> dict[str, float]:
    """Return what has been counted since the last step."""
    found: dict[str, float] = {name: counts[name] for name in COUNTED}
    counts.clear()
    return found


class SlowCoDriving(Wrapped):
    """``codriving`` with late orders and decisions in its slots; its own safety check stays live."""

    def __init__(self, method: CoDriving, delays: Delays) -> None:
        super().__init__(method)
        self.codriving, self.delays = method, delays
        self._counts = Counter[str]()

    def reset(self, road_map: RoadMap, model: DrivingModel, seed: int) -> None:
        """Begin an episode, with nothing thought of yet."""
        super().reset(road_map, model, seed)
        pipeline, cda, delays = self.codriving.pipeline, self.codriving.cda, self.delays
        self._counts.clear()
        self._decider: LateDecider | None = None
        if delays.order > 0 or delays.by_model:
            late = cda.binding, delays, self._asked, self._counts
            if isinstance(pipeline.negotiation, AgreedOrder):
                coordinator = LateCoordinator(pipeline.negotiation.coordinator, *late)
                pipeline.negotiation = LateOrders(coordinator, OwnOrders(cda.own_order, seed))
            elif isinstance(self.party, Negotiator):
                # By messages it is what is proposed that comes late.
                self.party.coordinator = LateCoordinator(self.party.coordinator, *late)
        if delays.mind > 0 or delays.by_model:
            pipeline.decider = self._decider = LateDecider(pipeline.decider, delays, self._asked, self._counts)

    def act(self, world: WorldState) -> ReasonedDeliberation:
        return self._in_time(world, self.codriving.act)

    def ask_once(self, world: WorldState) -> ReasonedDeliberation:
        return self._in_time(world, self.codriving.ask_once)

    def _in_time(self, world: WorldState, decide: Callable[[WorldState], ReasonedDeliberation]) -> ReasonedDeliberation:
        if self._decider is not None:
            self._decider.now = world.time
        found = decide(world)
        return replace(found, counts={**found.counts, **taken_off(self._counts)})

    def _asked(self) -> Asked:
        """Return what a language model was asked in this step so far."""
        ledger = self.codriving.pipeline.ledger
        return ledger.asked() if ledger is not None else ()


class Slow(Checked):
    """Any other method: its actions come late, and so does the order of one that orders.

    What is driven passes the safety check, as with ``filter=true``. All CAVs are decided for at once, so that the next
    thought begins when the last answer of the one before is there.
    """

    def __init__(self, method: Method, cda: CdaLevel, margin: float, delays: Delays) -> None:
        super().__init__(method, cda, margin)
        self.delays, self._counts = delays, Counter[str]()
        self._rule: LateRule | None = None
        if isinstance(method, Ordered) and method.orders:
            method.rule = self._rule = LateRule(method.rule, delays.order, self._counts)

    def reset(self, road_map: RoadMap, model: DrivingModel, seed: int) -> None:
        """Begin an episode, with nothing thought of yet."""
        method, rule = self.method, self._rule
        if isinstance(method, Ordered) and rule is not None:
            method.rule = rule.rule
        super().reset(road_map, model, seed)
        if isinstance(method, Ordered) and rule is not None:
            method.rule = rule
            rule.reset(seed)
            if isinstance(self.party, Negotiator) and self.delays.order > 0:
                late = True, self.delays, nothing, self._counts, method.executor.gap
                self.party.coordinator = LateCoordinator(self.party.coordinator, *late)
        self._counts.clear()
        self._answers = LateAnswers(self._counts)

    def act(self, world: WorldState) -> ReasonedDeliberation:
        return self._in_time(world, self.method.act)

    def ask_once(self, world: WorldState) -> ReasonedDeliberation:
        return self._in_time(world, self.method.ask_once)

    def _in_time(self, world: WorldState, decide: Callable[[WorldState], Deliberation]) -> ReasonedDeliberation:
        moment, now = self._perception.perceive(world), world.time
        arrived = self._answers.arrived(now, world.deciding)
        made = None if any(map(self._answers.thinks, world.deciding)) else decide(world)
        fresh = self._begun(now, made) if made is not None else {}
        orders = self._orders_now(moment)
        situations, decisions = [], []
        for ego, (given, assessed) in self._assessed(moment, orders, world.deciding).items():
            clear_times = tuple(clear_time(given, c) for c in given.conflicts)
            situations.append(Situation(given.scene, given.conflicts, given.order, clear_times, assessed))
            answer = fresh.get(ego)
            if answer is None:
                decisions.append(self._answers.driven(ego, now, arrived.get(ego), situations[-1].allowed))
            else:
                decisions.append(_nearest(given, assessed, answer))
        if isinstance(self.method, Ordered):
            wanted = made.actions if made is not None else {}
            self.method.executor.not_driven([d.ego for d in decisions if wanted.get(d.ego) is not d.action])
        counts = {**(made.counts if made is not None else {}), **taken_off(self._counts)}
        lines = made.transcript if made is not None else ()
        return ReasonedDeliberation(now, world.step, tuple(situations), tuple(decisions), counts, lines)

    def _begun(self, now: float, made: Deliberation) -> dict[str, Decision]:
        """Begin the thoughts of this step; return the answers that take no time."""
        asked = [_question(line) for line in made.transcript] if self.delays.by_model else []
        reasons = {d.ego: d.reason for d in made.decisions} if isinstance(made, ReasonedDeliberation) else {}
        found = {}
        for ego, action in made.actions.items():
            decision = Decision(ego, action, reasons.get(ego, f"{action} was decided"))
            answer = self._answers.begin(now, self.delays.of_mind(asked, ego), decision)
            if answer is not None:
                found[ego] = answer
        return found

    def _orders_now(self, moment: Moment) -> Mapping[str, PassingOrder]:
        """Return the order that each CAV is checked by: the one that stands, or that of ``codriving``."""
        if self._ordering is None or self._rule is None or not isinstance(self.method, Ordered):
            return self._negotiation.orders(moment)
        problem = pose(moment, self.method.executor.gap)
        if isinstance(self.party, Negotiator):
            problem = self.party.with_agreed(problem, moment.time)
        ordering = self._rule.now(problem.instance)
        order = agreement(moment, problem, ordering.times, ordering.reason, not self._ordering.by_zone)
        return dict.fromkeys(moment.scenes, order)


def _question(line: Mapping[str, Any]) -> tuple[str, str, list[float]]:
    """Read off a line of a transcript what was asked, and how long it took."""
    return line["purpose"], line["subject"], [call["seconds"] for call in line["calls"]]


def _nearest(given: SafetyInput, assessed: tuple[ActionAssessment, ...], answer: Decision) -> Decision:
    """Return an answer about the present, or the nearest one to it that is allowed."""
    scene, wanted = given.scene, answer.action
    near = nearest(wanted, assessed, scene.ego.speed, scene.intent.target_speed)
    action = near[0] if len(near) == 1 else least_dangerous(given, near)
    if action is wanted:
        return answer
    why = f"{action} in the place of {wanted}, which the safety check removed; {wanted} since: {answer.reason}"
    return Decision(answer.ego, action, why)
