"""CoDrivingLLM: the paper's method, with its CDA level, its reasoner and its memory put into the slots."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from codriving.datatypes.parts import Account, CaseMemory, Method, Model
from codriving.datatypes.record import Outcome
from codriving.datatypes.road import Road
from codriving.datatypes.situation import Decision, ReasonedDeliberation, Situation
from codriving.datatypes.world import DrivingModel, WorldState
from codriving.errors import ConfigError
from codriving.geometry.road_map import RoadMap
from codriving.methods.experience_log import ConflictLog, learn
from codriving.methods.language_model.ports import ports
from codriving.methods.language_model.prompted_model import check_model, prompt_files, prompted
from codriving.methods.pipeline import Pipeline
from codriving.reasoning.decision.rules import Decider, decide_one
from codriving.reasoning.ordering.negotiation import AgreedOrder, OwnOrders
from codriving.reasoning.perception import Perception
from codriving.reasoning.prediction.forecast import Forecast
from codriving.reasoning.prediction.rollout import PLANS
from codriving.reasoning.safety.assessment import NoCheck, ThreeLayers
from codriving.reasoning.safety.safety_input import CONTINUATIONS
from codriving.reasoning.sharing.sharing import HIDDEN_INTENTS, SHARED_INTENTS, CdaLevel, SensedStates, SharedStates
from codriving.reasoning.sharing.tracking import Tracking


class CoDriving(Method):
    """The framework of the paper.

    Args:
        memory: Experiences to recall, and perhaps to learn from; None for the framework without its memory module.
        margin: Time that should lie between one vehicle's leaving a zone and the next one's entering it [s].

    Raises:
        ConfigError: If the margin is out of range.
    """

    name = "codriving"

    def __init__(self, cda: CdaLevel, llm: Model, memory: CaseMemory | None, margin: float) -> None:
        if not 0 <= margin <= 5:
            raise ConfigError(f"margin must be 0 to 5 s, got {margin:g}")
        check_model(llm, memory)
        self.cda, self.llm, self.memory, self.margin = cda, llm, memory, margin
        self.variant, self.reasoner = cda.variant, llm.name
        self.remembers = memory.label if memory is not None else ""

    def files(self, road: Road) -> Mapping[str, Path]:
        return prompt_files(self.llm, self.memory, ("negotiate", "decide"), "reflect")

    def reset(self, road_map: RoadMap, model: DrivingModel, seed: int) -> None:
        """Fill the slots for a new episode."""
        forecast = Forecast(model, (*CONTINUATIONS, *PLANS))
        self._model = prompted(self.llm)
        coordinator, decider = ports(self._model, self.llm.ask_plain, self.cda.binding, self.cda.intent_sharing)
        self._pipeline = Pipeline(
            perception=Perception(
                road_map=road_map,
                forecast=forecast,
                tracking=Tracking(road_map),
                state_sharing=SharedStates() if self.cda.state_sharing else SensedStates(),
                intent_sharing=SHARED_INTENTS if self.cda.intent_sharing else HIDDEN_INTENTS,
            ),
            negotiation=AgreedOrder(coordinator) if self.cda.negotiation else OwnOrders(self.cda.own_order, seed),
            safety=ThreeLayers() if self.cda.safety_check else NoCheck(),
            decider=decider,
            margin=self.margin,
            memory=self.memory,
            ledger=self._model.ledger if self._model is not None else None,
        )
        self._road_map, self._seed = road_map, seed
        self._log = ConflictLog(road_map, model) if self.memory is not None and self.memory.learns else None
        if self.memory is not None:
            self.memory.begin(seed)

    def act(self, world: WorldState) -> ReasonedDeliberation:
        deliberation = self._pipeline.act(world)
        if self._log is not None:
            self._log.note(world, deliberation.situations, deliberation.decisions)
        return deliberation

    def ask_once(self, world: WorldState) -> ReasonedDeliberation:
        self._pipeline.decider = _ForOne(self._pipeline.decider)
        return self._pipeline.act(world)

    def conclude(self, world: WorldState, outcome: Outcome) -> Account:
        if self._log is None or self.memory is None:
            return {}, []
        experiences = self._log.conclude(world, outcome)
        account: Account = {}, []
        if self.memory.reflections and self._model is not None:
            from codriving.methods.language_model.reflection import reflect

            experiences = reflect(self._model, experiences, self.memory.reflections)
            account = self.unfinished_step(world.time)
        learnt = learn(self.memory, self, self._road_map.road.name, self._seed, experiences)
        return {**account[0], **learnt}, account[1]

    def unfinished_step(self, time: float) -> Account:
        return self._model.ledger.close_step(time) if self._model is not None else ({}, [])


class _ForOne(Decider):
    """Asks the decider for the CAV with the most conflicts alone; the rules decide for the others."""

    def __init__(self, decider: Decider) -> None:
        self.decider = decider

    def decide(self, situations: Sequence[Situation]) -> list[Decision]:
        """Return one decision a situation, in the same order."""
        chosen = max(situations, key=lambda s: (len(s.allowed) > 1, len(s.conflicts)))
        return [self.decider.decide([s])[0] if s is chosen else decide_one(s) for s in situations]
