"""Codriving as it drives, with a notebook of what a language model would have been asked at each step."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, Self

from codriving.briefing import Briefing
from codriving.datatypes import (
    Conflict,
    Decision,
    DrivingModel,
    HumanJudge,
    Instance,
    Method,
    Pair,
    PassingOrder,
    ReasonedDeliberation,
    SceneDescription,
    Situation,
    WorldState,
    Wrapped,
)
from codriving.geometry import RoadMap
from codriving.llm import Ledger
from codriving.methods import CoDriving, Ordered, most_urgent
from codriving.reasoning import (
    AgreedOrder,
    Coordinator,
    Decider,
    Executor,
    JointPlanner,
    Moment,
    Ordering,
    OrderRule,
    Problem,
    Request,
    RuleCoordinator,
    open_pairs,
    pose,
)


@dataclass(frozen=True, slots=True)
class Posed:
    """A negotiation as a model would be asked for it, and the order of the rules."""

    scenes: Mapping[str, SceneDescription]
    problem: Problem
    conflicts: tuple[Conflict, ...]
    previous: PassingOrder | None
    order: PassingOrder


@dataclass(slots=True)
class Notebook:
    """What was decided and negotiated since it was emptied; copies of a method write into the same one."""

    situations: list[tuple[Situation, Moment | None]] = field(default_factory=list)
    posed: list[Posed] = field(default_factory=list)
    closed: bool = False  # Whether only situations are noted, without what a model would be told besides
    forced: dict[Pair, str] = field(default_factory=dict)  # Pairs whose order is given from now on, each with a reason

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        return self

    def empty(self) -> None:
        """Forget all."""
        self.situations.clear()
        self.posed.clear()


class Examined(CoDriving):
    """Drives as ``method=codriving`` does by its rules, and notes what it decides about."""

    @cached_property
    def notebook(self) -> Notebook:
        """What it writes into; asked for before it is copied, the copies have the same."""
        return Notebook()

    def reset(self, road_map: RoadMap, model: DrivingModel, seed: int) -> None:
        """Begin an episode."""
        super().reset(road_map, model, seed)
        pipeline, briefing = self.pipeline, _NotedBriefing()
        pipeline.briefing, self._ledger = briefing, Ledger()
        pipeline.decider = _NotedDecider(pipeline.decider, self.notebook, briefing)
        negotiation = pipeline.negotiation
        if isinstance(negotiation, AgreedOrder) and isinstance(negotiation.coordinator, RuleCoordinator):
            negotiation.coordinator = _NotedCoordinator(negotiation.coordinator, self.notebook)

    def act(self, world: WorldState) -> ReasonedDeliberation:
        # With a ledger it is as where a model is asked, which takes more time.
        self.pipeline.ledger = None if self.notebook.closed else self._ledger
        return super().act(world)


class ExaminedPlans(Ordered):
    """Drives as a method with the planned executor does, and keeps to the order of pairs that are forced."""

    def __init__(self, rule: OrderRule, executor: Executor, judgement: HumanJudge | None = None) -> None:
        self.notebook = Notebook()
        super().__init__(_ForcedRule(rule, self.notebook), executor, judgement)


def notebook_of(method: Method) -> Notebook:
    """Return the notebook of the method within all that is put around it."""
    while isinstance(method, Wrapped):
        method = method.method
    assert isinstance(method, Examined | ExaminedPlans)
    return method.notebook


class _ForcedRule(OrderRule):
    def __init__(self, rule: OrderRule, notebook: Notebook) -> None:
        self.rule, self.notebook = rule, notebook
        self.name, self.variant, self.chosen_as, self.most_cavs = (
            rule.name,
            rule.variant,
            rule.chosen_as,
            rule.most_cavs,
        )

    def reset(self, seed: int) -> None:
        self.rule.reset(seed)

    def order(self, instance: Instance, planner: JointPlanner) -> Ordering:
        pairs = [pair for pair in self.notebook.forced if set(pair) <= instance.vehicles.keys()]
        given = open_pairs(instance, pairs)
        return self.rule.order(replace(instance, before=instance.before | set(given)) if given else instance, planner)

    def grant(self, requests: Sequence[Request]) -> frozenset[str]:
        return self.rule.grant(requests)


class _NotedBriefing(Briefing):
    moment: Moment | None = None

    def note(self, moment: Moment) -> None:
        self.moment = moment
        super().note(moment)


class _NotedDecider(Decider):
    def __init__(self, decider: Decider, notebook: Notebook, briefing: _NotedBriefing) -> None:
        self.decider, self.notebook, self.briefing = decider, notebook, briefing

    def decide(self, situations: Sequence[Situation]) -> list[Decision]:
        self.notebook.situations += [(situation, self.briefing.moment) for situation in situations]
        return self.decider.decide(situations)


class _NotedCoordinator(Coordinator):
    def __init__(self, rules: RuleCoordinator, notebook: Notebook) -> None:
        self.rules, self.notebook = rules, notebook

    def negotiate(self, moment: Moment, given: Mapping[Pair, str] | None = None) -> PassingOrder:
        """Return the order of the rules; of pairs that are forced it is given while it is open."""
        if self.notebook.closed and not self.notebook.forced:
            return self.rules.negotiate(moment, given)
        problem, previous = pose(moment), self.rules.previous
        urgent = most_urgent(problem, moment.conflicts)
        asked = open_pairs(problem.instance, urgent)
        forced = {p: why for p, why in self.notebook.forced.items() if {p, p[::-1]} & set(asked)}
        order = self.rules.negotiate(moment, {**forced, **(given or {})})
        if asked:
            scenes = {name: moment.scenes[name] for name in problem.instance.vehicles}
            conflicts = tuple(urgent[pair] for pair in asked)
            posed = Posed(scenes, problem, conflicts, previous, order)
            self.notebook.posed.append(posed)
        return order
