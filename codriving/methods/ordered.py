"""Methods that order: a rule says who passes first, an executor drives; everything else is shared by all of them."""

from copy import deepcopy

from codriving.datatypes import (
    Action,
    ActionAssessment,
    Decision,
    DrivingModel,
    HumanJudge,
    PassingOrder,
    ReasonedDeliberation,
    Shares,
    Situation,
    WorldState,
)
from codriving.geometry import RoadMap
from codriving.judgement import Judging, judgements_of
from codriving.methods.chosen_order import ChosenOrder
from codriving.protocol import Negotiator
from codriving.reasoning import (
    CONTINUATIONS,
    LONGITUDINAL,
    SHARED_INTENTS,
    Drive,
    Executor,
    Forecast,
    LaneRequests,
    Moment,
    OrderRule,
    Perception,
    SharedStates,
    Tracking,
    agreement,
    plan_library,
    pose,
)


class Ordered(Judging):
    """A method that orders all CAVs jointly.

    States and intents are shared as in the full framework. Only the choice of the order differs between such methods.
    """

    shares = Shares(states=True, intents=True, orders=True)

    def __init__(self, rule: OrderRule, executor: Executor, judgement: HumanJudge | None = None) -> None:
        self.rule, self.executor, self.name = rule, executor, rule.name
        self.most_cavs, self.orders, self.by_zone = rule.most_cavs, executor.orders, executor.by_zone
        driven = "" if executor.name == "planned" else executor.name
        self.variant = "/".join(word for word in (rule.variant, driven, executor.variant) if word)
        self.rely_on(judgement)

    def reset(self, road_map: RoadMap, model: DrivingModel, seed: int) -> None:
        """Begin an episode; nothing is remembered from the one before."""
        forecast = Forecast(model, (*plan_library(model), *CONTINUATIONS, *self.executor.own_plans), road_map)
        known = Tracking(road_map), SharedStates(), SHARED_INTENTS
        self._perception = self.judged(Perception(road_map, forecast, *known, by_zone=self.executor.by_zone))
        self._requests, self._lag = LaneRequests(), round(self.executor.margin / forecast.sample)
        self.rule.reset(seed)
        self.executor.reset()
        if self.coordination is not None:
            coordinator = ChosenOrder(deepcopy(self.rule), True, self.executor.margin, self.executor)
            self.party = Negotiator(self.coordination, coordinator)

    def act(self, world: WorldState) -> ReasonedDeliberation:
        """Order all CAVs, and decide for every CAV on the road."""
        moment = self._perception.perceive(world)
        problem = pose(moment, self.executor.gap)
        if isinstance(self.party, Negotiator):
            problem = self.party.agreed_problem(moment, problem)
            if not world.deciding:
                return ReasonedDeliberation(world.time, world.step, (), (), {})
        ordering = self.rule.order(problem.instance, self.executor.planner(moment))
        agreed = agreement(moment, problem, ordering.times, ordering.reason, True)
        drive = self.executor.drive(moment, ordering)
        changes = self._lane_changes(moment, agreed, drive)
        deciding = world.deciding
        situations = tuple(_situation(moment, name, agreed, drive, changes.get(name)) for name in deciding)
        decisions = tuple(
            changes.get(name) or Decision(name, drive.actions[name], drive.reasons[name]) for name in deciding
        )
        return ReasonedDeliberation(world.time, world.step, situations, decisions, {**ordering.counts, **drive.counts})

    def _lane_changes(self, moment: Moment, agreed: PassingOrder, drive: Drive) -> dict[str, Decision]:
        """Return the lane changes that are wanted, pass the gap test and have been granted."""
        requests = self._requests.gather(moment, agreed, drive.expected, self._lag)
        if not requests:
            return {}
        granted = self.rule.grant(requests)
        self._requests.granted(granted, moment.time)
        why = f"was granted among {len(requests)} requests"
        return {r.ego: Decision(r.ego, r.action, f"{r.action} {why}") for r in requests if r.ego in granted}


def _situation(moment: Moment, name: str, agreed: PassingOrder, drive: Drive, change: Decision | None) -> Situation:
    """Write down what a decision rests on, in the form in which every method's decisions are recorded."""
    taken = change.action if change is not None else drive.actions[name]
    progress, removed = drive.progress.get(name, {}), drive.removed.get(name, {})
    assessments = tuple(
        _assessment(action, progress.get(action), taken, removed.get(action, ())) for action in moment.available[name]
    )
    conflicts = moment.conflicts[name]
    told = judgements_of(moment, name)
    return Situation(moment.scenes[name], conflicts, agreed, (0.0,) * len(conflicts), assessments, judgements=told)


def _assessment(action: Action, gain: float | None, taken: Action, why: tuple[str, ...]) -> ActionAssessment:
    if not why and action not in LONGITUDINAL and action is not taken:
        why = ("not asked for, not safe, or granted to another vehicle",)
    elif not why and action in LONGITUDINAL and gain is None:
        why = ("no plan of the library that begins with it keeps the order and clear of all vehicles",)
    return ActionAssessment(action, not why or action is taken, why, (), gain)
