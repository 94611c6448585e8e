"""The layered executor, a reference: the first group accelerates, all others hold back and wait for their turn."""

from codriving.datatypes import Action, Role
from codriving.errors import require_range
from codriving.geometry import TRUE
from codriving.reasoning.execution.joint_planner import JointPlans
from codriving.reasoning.execution.planned import Drive, Executor, drive_of
from codriving.reasoning.ordering.problem import window
from codriving.reasoning.ordering.protocol import Ordering
from codriving.reasoning.perception import Moment
from codriving.reasoning.safety.safety_input import then_stop
from codriving.reasoning.safety.same_lane import LANE_END_GAP

LATE = 0.1  # Difference of times that does not count [s]

ROOM = 1.0  # Room that is left to the vehicle ahead [m]


class Layered(Executor):
    """Layers follow from the order; a layer goes when the one before it has left.

    Kept to show how much of a result is owed to the executor and how little to the order.
    """

    name = "layered"

    def __init__(self, gap: float, hold: float, brake_anywhere: bool, headway: float) -> None:
        require_range("gap", gap, 0, 5)
        require_range("hold", hold, 0, 200)
        require_range("headway", headway, 0, 5)
        self.gap = self.margin = gap
        self.hold, self.brake_anywhere, self.headway = hold, brake_anywhere, headway

    def planner(self, moment: Moment) -> JointPlans:
        """Return what plans all CAVs in an order, for rules that look at plans."""
        return JointPlans(moment, {}, self.gap, 1.0, self.headway)

    def drive(self, moment: Moment, ordering: Ordering) -> Drive:
        """Let the first layer go and hold all others back."""
        layers = layers_of(moment, ordering)
        plans = self.planner(moment)
        planned = drive_of(moment, plans, plans.joint(ordering.sequence), ordering)
        actions, reasons = {}, {}
        for name in moment.scenes:
            actions[name], reasons[name] = self._decide(moment, name, layers.get(name, 0), ordering)
        return Drive(actions, reasons, planned.expected, planned.progress, {"layers": max(layers.values(), default=0)})

    def _decide(self, moment: Moment, name: str, layer: int, ordering: Ordering) -> tuple[Action, str]:
        leader = _too_close(moment, name, self.headway, Action.IDLE)
        if leader:
            return Action.SLOWER, f"{leader} ahead is too close"
        inside = _occupied(moment, name)
        if inside:
            return Action.SLOWER, f"{inside} is in the next zone"
        who = _human_first(moment, name, ordering) or _held(moment, name, ordering)
        if layer == 0 and not who:
            leader = _too_close(moment, name, self.headway, Action.FASTER)
            return (Action.IDLE, f"{leader} ahead is close") if leader else (Action.FASTER, "in the first group")
        who = who or f"layer {layer - 1}"
        if self.brake_anywhere or _distance(moment, name) <= self.hold:
            return Action.SLOWER, f"waits for {who}"
        return Action.IDLE, f"will have to wait for {who}, and is still far away"


def layers_of(moment: Moment, ordering: Ordering) -> dict[str, int]:
    """Return each vehicle's layer: one more than the highest of those before it with whom it is in conflict."""
    layers: dict[str, int] = {}
    for name in ordering.sequence:
        others = {c.other for c in moment.conflicts[name]}
        below = [layer for other, layer in layers.items() if other in others]
        layers[name] = 1 + max(below) if below else 0
    return layers


def _distance(moment: Moment, name: str) -> float:
    return min((c.distances[0] for c in moment.conflicts[name]), default=float("inf"))


def _too_close(moment: Moment, name: str, headway: float, action: Action) -> str:
    """Return the vehicle that is so close ahead that after an action there is too little room to stop."""
    scene, forecast = moment.scenes[name], moment.forecast
    speed = scene.ego.speed
    (later,) = forecast.travel(speed, scene.intent.target_speed, [then_stop(action)], scene.where)[:, -1]
    for n in scene.neighbours:
        if n.role is Role.LEADING and n.gap is not None:
            there = moment.vehicles[name][n.id]
            rolls = float(forecast.reach_of(there, there.routes[0]).least[-1])
            if n.gap < max(headway * speed, later - rolls) + ROOM:
                return n.id
    change = scene.must_change
    return "the end of its lane" if change is not None and later > change.room - LANE_END_GAP - ROOM else ""


def _occupied(moment: Moment, name: str) -> str:
    """Return the vehicle that is inside the first zone that a vehicle comes to."""
    ahead = [c for c in moment.conflicts[name] if c.distances[0] > 0]
    nearest = min((c.distances[0] for c in ahead), default=0.0)
    return next((c.other for c in ahead if c.distances[0] <= nearest + TRUE.length and c.distances[1] <= 0), "")


def _human_first(moment: Moment, name: str, ordering: Ordering) -> str:
    """Return a human driver who may be in the zone before the vehicle is through."""
    reference = moment.scenes[name].place + _distance(moment, name)
    for c in moment.conflicts[name]:
        n = moment.scenes[name].neighbour(c.other)
        if n is not None and n.intent is None and c.distances[0] > 0:
            begin, end = window(moment, c, n, reference)
            if begin < ordering.times.get(name, 0.0) and end > 0:
                return n.id
    return ""


def _held(moment: Moment, name: str, ordering: Ordering) -> str:
    """Return what a vehicle waits for that the rule holds back for longer than its conflicts do."""
    distance = _distance(moment, name)
    if name not in ordering.not_before or distance <= 0:
        return ""
    scene, forecast = moment.scenes[name], moment.forecast
    soonest = forecast.time_to(distance, forecast.reach(scene.ego.speed, True, scene.where).most)
    return "its turn" if soonest < ordering.not_before[name] - LATE else ""
