"""The paper's reasoning module: share states, share intents, negotiate, check, decide; and the executors of orders."""

from codriving.reasoning.conflicts import OPEN, SLOWEST, find_conflicts, is_behind, is_open, ttcp
from codriving.reasoning.decision.cases import favour
from codriving.reasoning.decision.rules import Decider, RuleDecider, decide_one, is_plain
from codriving.reasoning.execution.joint_planner import JointPlans
from codriving.reasoning.execution.lane_requests import LaneRequests
from codriving.reasoning.execution.planned import Drive, Executor, humans_expected
from codriving.reasoning.exits import full_exit
from codriving.reasoning.ordering.coordinator import Coordinator, RuleCoordinator, agreement
from codriving.reasoning.ordering.negotiation import AgreedOrder, Negotiation, OwnOrders
from codriving.reasoning.ordering.order_search import Coded, Found, Prefix, SearchedOrder
from codriving.reasoning.ordering.premise import Premise, find_circle, open_pairs, premise
from codriving.reasoning.ordering.problem import Problem, pose, window
from codriving.reasoning.ordering.protocol import (
    JointPlan,
    JointPlanner,
    Ordering,
    OrderRule,
    Request,
    best_subset,
    in_order,
)
from codriving.reasoning.ordering.schedule import (
    LONGEST_WAIT,
    Objective,
    after_windows,
    carried_over,
    evacuation_time,
    inserted,
    repaired,
    schedule,
    sequence,
    timed,
    total_delay,
)
from codriving.reasoning.ordering.tickets import CONTROL_RADIUS, TicketBook, by_slot, by_ticket, reasons
from codriving.reasoning.perception import Moment, Perception, single_vehicle_perception
from codriving.reasoning.prediction.expectation import HEADWAY, Expected, expect_all
from codriving.reasoning.prediction.forecast import HORIZON, Forecast
from codriving.reasoning.prediction.idm import IntelligentDriver
from codriving.reasoning.prediction.right_of_way import GivesWay, gives_way, known_to_give_way
from codriving.reasoning.prediction.rollout import Plan, plan_library, rollout
from codriving.reasoning.safety.assessment import NoCheck, SafetyCheck, ThreeLayers, least_dangerous
from codriving.reasoning.safety.conflict_lane import PAD
from codriving.reasoning.safety.nearest import nearest
from codriving.reasoning.safety.safety_input import (
    CONTINUATIONS,
    LONGITUDINAL,
    SIDES,
    SafetyInput,
    clear_time,
    safety_input,
    then_stop,
)
from codriving.reasoning.safety.same_lane import LANE_END_GAP, forced_braking
from codriving.reasoning.sharing.scenes import ALIGNED, SAME_LANE, describe_scenes, with_roles
from codriving.reasoning.sharing.sharing import HIDDEN_INTENTS, SHARED_INTENTS, CdaLevel, SensedStates, SharedStates
from codriving.reasoning.sharing.tracking import STANDING, Places, Tracking

__all__ = [
    "ALIGNED", "CONTINUATIONS", "CONTROL_RADIUS", "HEADWAY", "HIDDEN_INTENTS", "HORIZON", "LANE_END_GAP",
    "LONGEST_WAIT", "LONGITUDINAL", "OPEN", "PAD", "SAME_LANE", "SHARED_INTENTS", "SIDES", "SLOWEST", "STANDING",
    "AgreedOrder", "CdaLevel", "Coded", "Coordinator", "Decider", "Drive", "Executor", "Expected", "Forecast", "Found",
    "GivesWay", "IntelligentDriver", "JointPlan", "JointPlanner", "JointPlans", "LaneRequests", "Moment", "Negotiation",
    "NoCheck", "Objective", "OrderRule", "Ordering", "OwnOrders", "Perception", "Places", "Plan", "Prefix", "Premise",
    "Problem", "Request", "RuleCoordinator", "RuleDecider", "SafetyCheck", "SafetyInput", "SearchedOrder",
    "SensedStates", "SharedStates", "ThreeLayers", "TicketBook", "Tracking", "after_windows", "agreement",
    "best_subset", "by_slot", "by_ticket", "carried_over", "clear_time", "decide_one", "describe_scenes",
    "evacuation_time", "expect_all", "favour", "find_circle", "find_conflicts", "forced_braking", "full_exit",
    "gives_way", "humans_expected", "in_order", "inserted", "is_behind", "is_open", "is_plain", "known_to_give_way",
    "least_dangerous", "nearest", "open_pairs", "plan_library", "pose", "premise", "reasons", "repaired", "rollout",
    "safety_input", "schedule", "sequence", "single_vehicle_perception", "then_stop", "timed", "total_delay", "ttcp",
    "window", "with_roles",
]  # fmt: skip
