"""What an executor is, and the planned one: all CAVs are planned in passing order with the exact vehicle model."""

from abc import ABC, abstractmethod
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Literal, get_args

from codriving.datatypes import Action, OrderExecutor
from codriving.errors import require, require_range
from codriving.reasoning.execution.checked_humans import CheckedHumans
from codriving.reasoning.execution.joint_planner import EarlyPassing, Joint, JointPlans
from codriving.reasoning.ordering.problem import pose
from codriving.reasoning.ordering.protocol import JointPlanner, Ordering
from codriving.reasoning.perception import Moment
from codriving.reasoning.prediction.expectation import Expected, expect_human
from codriving.reasoning.prediction.rollout import Plan

# How human drivers are minded: where they are likely to be, or as the safety check of ``codriving`` does.
Humans = Literal["planned", "checked"]


@dataclass(frozen=True, slots=True)
class Drive:
    """What an executor makes of an order."""

    actions: Mapping[str, Action]
    reasons: Mapping[str, str]
    expected: Mapping[str, tuple[Expected, ...]]
    # How far each CAV gets within the horizon after each first action with which it can keep the order [m], by id; no
    # entry for an action with which it cannot.
    progress: Mapping[str, Mapping[Action, float]]
    counts: Mapping[str, int] = field(default_factory=dict)
    removed: Mapping[str, Mapping[Action, tuple[str, ...]]] = field(default_factory=dict)  # By the safety check, by id


class Executor(OrderExecutor, ABC):
    """Turns passing orders into actions, step after step of one episode."""

    name: str = ""
    variant: str = ""  # What tells it from its default settings, in tables
    gap: float  # Time between one vehicle's leaving a zone and the next one's entering it, for schedules [s]
    margin: float  # The same for motions, and for the gap test of lane changes [s]
    orders: bool = True  # Whether CAVs drive by the order at all
    by_zone: bool = False  # Whether a CAV may pass a zone before one that precedes it in the order
    own_plans: tuple[Plan, ...] = ()  # Those that it uses besides those that all methods predict

    def reset(self) -> None:
        """Begin an episode; nothing is remembered from the one before."""

    @abstractmethod
    def planner(self, moment: Moment) -> JointPlanner:
        """Return what plans all CAVs in an order; the rule uses it to choose the order."""

    @abstractmethod
    def drive(self, moment: Moment, ordering: Ordering) -> Drive:
        """Return what every CAV does now."""

    def not_driven(self, names: Collection[str]) -> None:
        """Hear which CAVs did something else than it said."""


def humans_expected(moment: Moment) -> dict[str, tuple[Expected, ...]]:
    """Expect each human driver that any CAV knows to keep its speed, on every way that it may take."""
    found: dict[str, tuple[Expected, ...]] = {}
    for known in moment.vehicles.values():
        for v in known.values():
            if not v.is_cav and v.id not in found:
                found[v.id] = expect_human(moment, v)
    return found


class Planned(Executor):
    """Prioritised planning over a library of plans, in passing order.

    The motions of those that are planned first are known exactly, so that the others enter gaps at speed: by zone, each
    passes after them or, where it is out of their way in time, before them. What each planned a step ago is among its
    plans of the next step; those that meant to be passed let pass.
    """

    name = "planned"

    def __init__(
        self,
        gap: float,
        margin: float,
        pad: float,
        headway: float,
        humans: Humans = "planned",
        human_margin: float = 1.5,
        by_zone: bool = True,
    ) -> None:
        settings = {"gap": gap, "margin": margin, "pad": pad, "headway": headway, "human_margin": human_margin}
        for key, value in settings.items():
            require_range(key, value, 0, 5)
        require(humans in get_args(Humans), f"humans must be planned or checked, got {humans}")
        self.gap, self.margin, self.pad, self.headway = gap, margin, pad, headway
        self.humans, self.human_margin, self.by_zone = humans, human_margin, by_zone
        told = [f"humans={humans}"] * (humans != "planned") + ["by_zone=false"] * (not by_zone)
        self.variant = ",".join(told)
        self.reset()

    def reset(self) -> None:
        """Begin an episode; nothing is remembered from the one before."""
        self._before: dict[str, Plan] = {}
        self._plans: JointPlans | None = None
        self._kept: list[EarlyPassing] = []

    def not_driven(self, names: Collection[str]) -> None:
        """Forget whom the others were to let pass: a CAV that was held back is not waited for."""
        self._kept = [passage for passage in self._kept if passage.first not in names]

    def planner(self, moment: Moment) -> JointPlans:
        """Return what plans all CAVs in an order."""
        if self._plans is None or self._plans.moment is not moment:
            checked = self.humans == "checked"
            humans = CheckedHumans(moment, pose(moment, self.gap), self.human_margin) if checked else None
            margins = self.margin, self.pad, self.headway
            self._plans = JointPlans(moment, self._before, *margins, humans, self._kept)
        return self._plans

    def drive(self, moment: Moment, ordering: Ordering) -> Drive:
        """Return the first action of each CAV's plan."""
        plans = self.planner(moment)
        plan = plans.rescued if self.by_zone else plans.joint
        joint = plan(ordering.sequence, ordering.not_before, ordering.times)
        decided = {}
        if plans.humans is not None:
            agreed = plans.humans.order(ordering.sequence, ordering.times)
            decided = plans.humans.decide(agreed, plans.expected(joint), round(self.margin / moment.forecast.sample))
            joint = plans.beginning(joint, {name: decision.action for name, (decision, _) in decided.items()})
        self._before = {name: plans.plan_of(name, k)[1:] or plans.plan_of(name, k) for name, k in joint.chosen.items()}
        self._kept = plans.passages(joint) if self.by_zone else []
        drive = drive_of(moment, plans, joint, ordering)
        reasons = {name: decision.reason for name, (decision, _) in decided.items()}
        removed = {name: {a.action: a.reasons for a in each if not a.safe} for name, (_, each) in decided.items()}
        return replace(drive, reasons={**drive.reasons, **reasons}, removed=removed)


def drive_of(moment: Moment, plans: JointPlans, joint: Joint, ordering: Ordering) -> Drive:
    """Write down what a joint plan means for the step."""
    actions = {name: plans.plan_of(name, k)[0] for name, k in joint.chosen.items()}
    reasons = {name: _reason(plans, joint, name, ordering.sequence) for name in joint.chosen}
    expected = plans.expected(joint)
    progress = {name: motions[0].progress for name, motions in expected.items()}
    return Drive(actions, reasons, expected | humans_expected(moment), progress, {"plans_infeasible": len(joint.stuck)})


def _reason(plans: JointPlans, joint: Joint, name: str, sequence: Sequence[str]) -> str:
    if name in joint.stuck:
        return "no plan keeps clear of all vehicles; this one does for longest"
    if joint.chosen[name] == 0:
        return "no vehicle has to be waited for"
    earlier = sequence[: sequence.index(name)] if name in sequence else sequence
    waits = [other for other in earlier if other in joint.chosen and plans.meetings(other, name)]
    action = plans.plan_of(name, joint.chosen[name])[0]
    what = {Action.FASTER: "accelerates", Action.SLOWER: "slows down"}.get(action, "keeps its speed")
    return f"{what} to arrive after {', '.join(waits)}" if waits else f"{what} because of human drivers or those ahead"
