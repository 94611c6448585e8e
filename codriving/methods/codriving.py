"""CoDrivingLLM: the paper's method, with its CDA level, its reasoner and its memory put into the slots."""

from collections.abc import Sequence
from dataclasses import replace

from codriving.datatypes import (
    EACH,
    NEAREST,
    UNITS,
    Account,
    CaseMemory,
    Coordination,
    Decision,
    DrivingModel,
    HumanJudge,
    Model,
    Outcome,
    ReasonedDeliberation,
    Shares,
    Situation,
    WorldState,
)
from codriving.errors import require, require_range
from codriving.geometry import RoadMap
from codriving.judgement import Judging
from codriving.methods.chosen_order import ChosenOrder, order_variant
from codriving.methods.experience_log import ConflictLog, learn
from codriving.methods.language_model.prompted_model import ModelMethod, PromptedModel, reasons_by
from codriving.methods.pipeline import Pipeline
from codriving.protocol import ByMessages, Negotiator
from codriving.reasoning import (
    CONTINUATIONS,
    HIDDEN_INTENTS,
    SHARED_INTENTS,
    AgreedOrder,
    CdaLevel,
    Coordinator,
    Decider,
    Forecast,
    Negotiation,
    NoCheck,
    OrderRule,
    OwnOrders,
    Perception,
    RuleCoordinator,
    RuleDecider,
    SensedStates,
    SharedStates,
    ThreeLayers,
    Tracking,
    decide_one,
    plan_library,
)


class CoDriving(Judging, ModelMethod):
    """The framework of the paper."""

    name, reflects, orders = "codriving", "reflect", True

    def __init__(
        self,
        cda: CdaLevel,
        llm: Model,
        memory: CaseMemory | None,
        margin: float,
        order: OrderRule | None = None,
        by_zone: bool = True,
        judgement: HumanJudge | None = None,
    ) -> None:
        require_range("margin", margin, 0, 5, " s")
        require(
            order is None or cda.negotiation,
            "with cda.negotiation=false each CAV goes by an order of its own, so that there is no place for order=; "
            "leave order= out, or choose a cda= with negotiation",
        )
        super().__init__(llm, memory)
        self.reasoner = reasons_by(llm)
        self.cda, self.margin, self.variant = cda, margin, order_variant(cda.variant, order)
        self.shares = Shares(cda.state_sharing, cda.intent_sharing, cda.negotiation)
        self.order, self.most_cavs = order, order.most_cavs if order is not None else None
        self.is_checked, self.by_zone = cda.safety_check, by_zone and not cda.binding
        self.asked = ("negotiate", "decide") if order is None else ("decide",)
        self.rely_on(judgement, asks_model=llm.chat() is not None, memory=memory)
        self.asked = (*self.asked, *(("judge",) if self.judge is not None and self.judge.asks_model else ()))

    def cooperate(self, coordination: Coordination) -> None:
        require(
            coordination.by not in (NEAREST, EACH) or not self.cda.binding,
            f"cda.binding=true needs one who may direct, and v2x.coordination.by={coordination.by} has none; choose "
            "v2x.coordination.by=road_side_unit or fleet, or a cda= that does not bind",
        )
        super().cooperate(coordination)

    def reset(self, road_map: RoadMap, model: DrivingModel, seed: int) -> None:
        """Fill the slots for a new episode."""
        super().reset(road_map, model, seed)
        coordinator, decider = ports(self._model, self.llm.ask_plain, self.cda.binding, self.cda.intent_sharing)
        if self.order is not None:
            self.order.reset(seed)
            coordinator = ChosenOrder(self.order, self.cda.binding, self.margin)
        perception = self.judged(perception_at(self.cda, road_map, model, self.by_zone), self._model)
        own = OwnOrders(self.cda.own_order, seed)
        negotiation: Negotiation = AgreedOrder(coordinator) if self.cda.negotiation else own
        if self.coordination is not None:
            authority = UNITS[self.coordination.by] if self.cda.binding else ""
            self.party = Negotiator(replace(self.coordination, authority=authority), coordinator)
            negotiation = ByMessages(self.party, own)
        safety = ThreeLayers() if self.cda.safety_check else NoCheck()
        ledger = self._model.ledger if self._model is not None else None
        self.pipeline = Pipeline(perception, negotiation, safety, decider, self.margin, self.memory, ledger)
        self._road_map = road_map
        self._log = ConflictLog(road_map, model) if self.memory is not None and self.memory.learns else None

    def act(self, world: WorldState) -> ReasonedDeliberation:
        deliberation = self.pipeline.act(world)
        if self._log is not None:
            self._log.note(world, deliberation.situations, deliberation.decisions)
        return deliberation

    def ask_once(self, world: WorldState) -> ReasonedDeliberation:
        self.pipeline.decider = _ForOne(self.pipeline.decider)
        return self.pipeline.act(world)

    def conclude(self, world: WorldState, outcome: Outcome) -> Account:
        if self._log is None or self.memory is None:
            return {}, []
        experiences = self._log.conclude(world, outcome)
        account: Account = {}, []
        if self.memory.reflections and self._model is not None:
            from codriving.methods.language_model.reflection import reflect

            experiences = reflect(self._model, experiences, self.memory.reflections)
            account = self.unfinished_step(world.time)
        learnt = learn(self.memory, experiences, self.judge.encounters() if self.judge is not None else ())
        return {**account[0], **learnt}, account[1]


def perception_at(cda: CdaLevel, road_map: RoadMap, model: DrivingModel, by_zone: bool = False) -> Perception:
    """Return what CAVs perceive that cooperate so far."""
    forecast = Forecast(model, (*plan_library(model), *CONTINUATIONS), road_map)
    states = SharedStates() if cda.state_sharing else SensedStates()
    intents = SHARED_INTENTS if cda.intent_sharing else HIDDEN_INTENTS
    return Perception(road_map, forecast, Tracking(road_map), states, intents, by_zone=by_zone)


class _ForOne(Decider):
    """Asks the decider for the CAV with the most conflicts alone; the rules decide for the others."""

    def __init__(self, decider: Decider) -> None:
        self.decider = decider

    def decide(self, situations: Sequence[Situation]) -> list[Decision]:
        """Return one decision a situation, in the same order."""
        chosen = max(situations, key=lambda s: (len(s.allowed) > 1, len(s.conflicts)))
        return [self.decider.decide([s])[0] if s is chosen else decide_one(s) for s in situations]


def ports(
    model: PromptedModel | None, ask_plain: bool, binding: bool, sees_conflicts: bool
) -> tuple[Coordinator, Decider]:
    """Return what negotiates and what decides."""
    if model is None:
        return RuleCoordinator(binding), RuleDecider()
    # pydantic is needed only if a model is asked.
    from codriving.methods.language_model.model_coordinator import ModelCoordinator
    from codriving.methods.language_model.model_decider import CheckedDecider

    return ModelCoordinator(model, binding), CheckedDecider(model, ask_plain, sees_conflicts)
