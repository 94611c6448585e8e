"""The fuzzy coalition: all CAVs choose actions together, each taking part to a degree (after Hang et al., 2022)."""

from collections.abc import Sequence

from codriving.datatypes import Action, TrackedVehicle
from codriving.errors import require_range
from codriving.methods.coop_game_fuzzy.joint_choice import MOST, Costs, Joint, settle, shapley
from codriving.methods.coop_game_fuzzy.joint_costs import Weights, joint_costs
from codriving.methods.fcfs import FirstComeFirstServed
from codriving.methods.ordered import Ordered
from codriving.reasoning import (
    LANE_END_GAP,
    Drive,
    Executor,
    Expected,
    JointPlan,
    JointPlanner,
    Moment,
    Ordering,
    Plan,
    Request,
    best_subset,
    humans_expected,
    then_stop,
)

# What each CAV chooses from; the first one wins where all cost the same.
OPTIONS = (Action.FASTER, Action.IDLE, Action.SLOWER)

LONGEST = 20  # Decisions for which an action can be held

_HELD = [(*(action,) * held, Action.FASTER) for held in range(1, LONGEST + 1) for action in OPTIONS]
# Every plan that is used: an action held for a while, and then going; and an action, and then stopping.
LIBRARY: tuple[Plan, ...] = tuple(dict.fromkeys((*_HELD, *(then_stop(action) for action in OPTIONS))))


class CoopGameFuzzy(Ordered):
    """Joint actions instead of orders; the order of arrival is shown beside them."""

    def __init__(
        self,
        gap: float,
        participation: float,
        risk: float,
        efficiency: float,
        comfort: float,
        reference_acceleration: float,
        hold: float,
        horizon: float,
        shares: bool,
        control_radius: float,
    ) -> None:
        require_range("gap", gap, 0, 5, " s")
        shares_of_one = {"participation": participation, "risk": risk, "efficiency": efficiency, "comfort": comfort}
        for name, value in shares_of_one.items():
            require_range(name, value, 0, 1)
        require_range("reference_acceleration", reference_acceleration, 0.1, 20, " m/s2")
        require_range("hold", hold, 0.2, 4, " s")
        require_range("horizon", horizon, 1, 10, " s")
        weights = Weights(risk, efficiency, comfort, reference_acceleration)
        super().__init__(Arrival(control_radius), JointActions(gap, participation, weights, hold, horizon, shares))


class Arrival(FirstComeFirstServed):
    """The order of tickets, by which no CAV drives; lane changes are granted by what they gain."""

    name = "coop_game"

    def grant(self, requests: Sequence[Request]) -> frozenset[str]:
        return best_subset(requests)


class JointActions(Executor):
    """The joint action that costs least, by risk, loss of speed and acceleration, whatever the order."""

    name, orders = "fuzzy_coalition", False
    own_plans = LIBRARY

    def __init__(
        self, gap: float, participation: float, weights: Weights, hold: float, horizon: float, shares: bool
    ) -> None:
        self.gap = self.margin = gap
        self.participation, self.weights, self.shares = participation, weights, shares
        self.hold, self.horizon = hold, horizon

    def planner(self, moment: Moment) -> JointPlanner:
        """Return a planner that has no plan for any order."""
        return NoPlans(moment.forecast.sample)

    def drive(self, moment: Moment, ordering: Ordering) -> Drive:
        """Return the joint action on which all settle."""
        vehicles = {name: known[name] for name, known in sorted(moment.vehicles.items())}
        if not vehicles:
            return Drive({}, {}, {}, {})
        held = min(max(round(self.hold / moment.forecast.model.decision_interval), 1), LONGEST)
        plans: list[Plan] = [(*(action,) * held, Action.FASTER) for action in OPTIONS]
        travels = {v.id: moment.forecast.travel(v.speed, v.target, plans, v.routes[0]) for v in vehicles.values()}
        samples = round(self.horizon / moment.forecast.sample) + 1
        costs = joint_costs(moment, vehicles, travels, samples, self.weights)
        allowed = [self._allowed(moment, v) for v in vehicles.values()]
        joint = settle(costs, allowed, self.participation)
        shares = self._shares(costs, allowed, joint, list(vehicles)) if self.shares and len(vehicles) <= MOST else {}
        actions, reasons, expected, progress = {}, {}, humans_expected(moment), {}
        for (name, v), k, cost in zip(vehicles.items(), joint, costs.of([joint])[0], strict=True):
            actions[name] = OPTIONS[k]
            share = f", its share of what that saves is {shares[name]:.2f}" if name in shares else ""
            reasons[name] = f"{OPTIONS[k]} goes best with what the others do, it costs {cost:.2f}{share}"
            progress[name] = {a: float(travels[name][i, -1]) for i, a in enumerate(OPTIONS)}
            expected[name] = tuple(
                Expected(route, place + travels[name][k], k == 0, progress[name] if r == 0 else {})
                for r, (route, place) in enumerate(v.routes)
            )
        return Drive(actions, reasons, expected, progress)

    def _allowed(self, moment: Moment, v: TrackedVehicle) -> list[int]:
        """Return the options that the road allows a CAV: where its lane ends it must still be able to stop."""
        found = [k for k, action in enumerate(OPTIONS) if action in moment.available[v.id]] or [0]
        change = moment.scenes[v.id].must_change
        if change is None:
            return found
        plans = [then_stop(action) for action in OPTIONS]
        stops = moment.forecast.travel(v.speed, v.target, plans, v.routes[0])[:, -1]
        return [k for k in found if stops[k] <= change.room - LANE_END_GAP] or found[-1:]

    def _shares(
        self, costs: Costs, allowed: Sequence[Sequence[int]], joint: Joint, names: list[str]
    ) -> dict[str, float]:
        """Share out what all save against each looking after itself."""
        alone = settle(costs, allowed, 0.0)

        def saved(members: frozenset[str]) -> float:
            mixed = tuple(j if name in members else a for name, j, a in zip(names, joint, alone, strict=True))
            before, after = costs.of([alone, mixed]).sum(axis=1)
            return float(before - after)

        return shapley(names, saved)


class NoPlans(JointPlanner):
    """A planner that has no plan for any order."""

    def __init__(self, sample: float) -> None:
        self.sample = sample

    def plan(self, order: Sequence[str]) -> JointPlan:
        """Say that there is no plan."""
        return JointPlan(False, {}, self.sample)

    def gap_time(self, plan: JointPlan, one: str, other: str) -> float:
        """Return inf, since no plan meets another."""
        return float("inf")
