"""What an executor is, and the planned one: all CAVs are planned in passing order with the exact vehicle model."""

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from codriving.datatypes import Action, OrderExecutor
from codriving.errors import require_range
from codriving.reasoning.execution.joint_planner import Joint, JointPlans
from codriving.reasoning.ordering.protocol import JointPlanner, Ordering
from codriving.reasoning.perception import Moment
from codriving.reasoning.prediction.expectation import Expected, expect_human, progress_by_action
from codriving.reasoning.prediction.rollout import Plan


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


class Executor(OrderExecutor, ABC):
    """Turns passing orders into actions, step after step of one episode."""

    name: str = ""
    gap: float  # Time between one vehicle's leaving a zone and the next one's entering it, for schedules [s]
    margin: float  # The same for motions, and for the gap test of lane changes [s]
    library: tuple[Plan, ...] = ()  # Plans that it uses besides those that all methods predict

    def reset(self) -> None:
        """Begin an episode; nothing is remembered from the one before."""

    @abstractmethod
    def planner(self, moment: Moment) -> JointPlanner:
        """Return what plans all CAVs in an order; the rule uses it to choose the order."""

    @abstractmethod
    def drive(self, moment: Moment, ordering: Ordering) -> Drive:
        """Return what every CAV does now."""


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

    The motions of those that go first are known exactly, so that the others enter gaps at speed. What each planned a
    step ago is among its plans of the next step, so that CAVs alone never lose a plan that works.
    """

    name = "planned"

    def __init__(self, gap: float, margin: float, pad: float, headway: float) -> None:
        for key, value in (("gap", gap), ("margin", margin), ("pad", pad), ("headway", headway)):
            require_range(key, value, 0, 5)
        self.gap, self.margin, self.pad, self.headway = gap, margin, pad, headway
        self.reset()

    def reset(self) -> None:
        """Begin an episode; nothing is remembered from the one before."""
        self._before: dict[str, Plan] = {}
        self._plans: JointPlans | None = None

    def planner(self, moment: Moment) -> JointPlans:
        """Return what plans all CAVs in an order."""
        if self._plans is None or self._plans.moment is not moment:
            self._plans = JointPlans(moment, self._before, self.margin, self.pad, self.headway)
        return self._plans

    def drive(self, moment: Moment, ordering: Ordering) -> Drive:
        """Return the first action of each CAV's plan."""
        plans = self.planner(moment)
        joint = plans.joint(ordering.sequence, ordering.not_before)
        self._before = {name: plans.plan_of(name, k)[1:] or plans.plan_of(name, k) for name, k in joint.chosen.items()}
        return drive_of(moment, plans, joint, ordering)


def drive_of(moment: Moment, plans: JointPlans, joint: Joint, ordering: Ordering) -> Drive:
    """Write down what a joint plan means for the step."""
    actions, reasons, expected, progress = {}, {}, {}, {}
    for name, k in joint.chosen.items():
        actions[name] = plans.plan_of(name, k)[0]
        reasons[name] = _reason(plans, joint, name, ordering.sequence)
        n = len(plans.plans)
        gains = progress_by_action(np.where(joint.works[name][:n], plans.gains[name][:n], -np.inf), plans.plans)
        progress[name] = gains
        expected[name] = tuple(
            Expected(route, place + plans.travels[name][k], k == 0, gains if r == 0 else {})
            for r, (route, place) in enumerate(plans.vehicles[name].routes)
        )
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
