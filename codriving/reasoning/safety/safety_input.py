"""What one CAV is checked by: where it would go after each action, here or as if it had changed lanes already."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from codriving.datatypes import Action, Conflict, PassingOrder, Precedence, SceneDescription, TrackedVehicle
from codriving.geometry import Array, RoadMap
from codriving.reasoning.conflicts import find_conflicts
from codriving.reasoning.perception import Moment
from codriving.reasoning.prediction.expectation import Expected
from codriving.reasoning.prediction.forecast import Forecast
from codriving.reasoning.prediction.rollout import Plan
from codriving.reasoning.sharing.scenes import with_conflicts, with_roles

LONGITUDINAL = (Action.SLOWER, Action.IDLE, Action.HOLD, Action.FASTER)

# By how much a lane change changes the index of the lane.
SIDES: Mapping[Action, int] = {Action.LANE_LEFT: -1, Action.LANE_RIGHT: 1}

CAR_LENGTH = 5.0  # Length of a vehicle [m]


def then_stop(action: Action) -> Plan:
    """Carry out an action once, then brake to a stop."""
    return (action, Action.SLOWER)


def then_go(action: Action) -> Plan:
    """Carry out an action once, then accelerate."""
    return (action, Action.FASTER)


# Every plan that the safety layers look at.
CONTINUATIONS: tuple[Plan, ...] = tuple(f(a) for f in (then_stop, then_go) for a in LONGITUDINAL)


@dataclass(frozen=True, slots=True)
class SafetyInput:
    """What the actions of one CAV are checked against."""

    moment: Moment
    ego: str
    order: PassingOrder  # The order that the CAV goes by
    expected: Mapping[str, tuple[Expected, ...]]  # How each vehicle that it knows of is expected to move, by id
    lag: int  # Samples that should lie between one vehicle's leaving a zone and the next one's entering it
    stops: Array  # Arc length if it brakes after each action (actions, n) [m]
    goes: Array  # Arc length if it accelerates after each action (actions, n) [m]
    _sides: "dict[Action, SafetyInput | None]" = field(default_factory=dict)

    @property
    def scene(self) -> SceneDescription:
        """The surroundings of the CAV."""
        return self.moment.scenes[self.ego]

    @property
    def conflicts(self) -> tuple[Conflict, ...]:
        """The conflicts of the CAV."""
        return self.moment.conflicts[self.ego]

    @property
    def vehicles(self) -> Mapping[str, TrackedVehicle]:
        """The vehicles that the CAV knows of, itself included, by id."""
        return self.moment.vehicles[self.ego]

    @property
    def actions(self) -> tuple[Action, ...]:
        """The actions to be checked."""
        return self.moment.available[self.ego]

    @property
    def road_map(self) -> RoadMap:
        """The road."""
        return self.moment.road_map

    @property
    def forecast(self) -> Forecast:
        """Predictions of this step."""
        return self.moment.forecast

    def beside(self, action: Action) -> "SafetyInput | None":
        """Return the input as if a lane change were done: same place and speed, the body still on the present lane.

        Each is worked out once.

        Returns:
            The input, with one action: to go on at the same speed. None if no route along that lane leads where the
            CAV goes.
        """
        if action not in self._sides:
            self._sides[action] = _changed(self, action)
        return self._sides[action]


def safety_input(
    moment: Moment, ego: str, order: PassingOrder, expected: Mapping[str, tuple[Expected, ...]], lag: int
) -> SafetyInput:
    """Predict one CAV for every action, braking and accelerating afterwards; a lane change keeps the speed."""
    scene = moment.scenes[ego]
    speed, target = scene.ego.speed, scene.intent.target_speed
    plain = [a if a in LONGITUDINAL else Action.IDLE for a in moment.available[ego]]
    stops = moment.forecast.travel(speed, target, [then_stop(a) for a in plain], scene.where)
    goes = moment.forecast.travel(speed, target, [then_go(a) for a in plain], scene.where)
    return SafetyInput(moment, ego, order, expected, lag, scene.place + stops, scene.place + goes)


def _changed(given: SafetyInput, action: Action) -> SafetyInput | None:
    moment, scene, road_map = given.moment, given.scene, given.road_map
    start, end, index = scene.intent.target_lane
    lane = (start, end, index + SIDES[action])
    beside = road_map.changes.routes_beside(scene.intent.route, scene.intent.target_lane)
    route = next((name for name, side in beside if side == lane), None)
    if route is None:
        return None
    place, _ = road_map.project(route, scene.ego.x, scene.ego.y)
    there = replace(
        scene,
        intent=replace(scene.intent, route=route, target_lane=lane),
        place=place,
        neighbours=with_roles(scene.neighbours, scene.ego, route, place, road_map),
        covers=((scene.intent.route, scene.place),),
        must_change=None,
    )
    conflicts = find_conflicts(there, road_map) if moment.sees_conflicts else ()
    there = with_conflicts(there, conflicts, road_map)
    own = replace(given.vehicles[given.ego], routes=((route, place), *there.covers), intent=there.intent)
    k = given.actions.index(action)
    return SafetyInput(
        moment=replace(
            moment,
            scenes={given.ego: there},
            conflicts={given.ego: conflicts},
            vehicles={given.ego: {**given.vehicles, given.ego: own}},
            available={given.ego: (Action.IDLE,)},
        ),
        ego=given.ego,
        order=_with_pairs(given.order, conflicts, road_map),
        expected=given.expected,
        lag=given.lag,
        stops=given.stops[k : k + 1] - scene.place + place,
        goes=given.goes[k : k + 1] - scene.place + place,
    )


def _with_pairs(order: PassingOrder, conflicts: Iterable[Conflict], road_map: RoadMap) -> PassingOrder:
    """Complete the order by the pairs that meet only after the lane change: who is nearer to the zone goes first."""
    pairs = list(order.precedences)
    for c in conflicts:
        if all({p.first, p.second} != {c.ego, c.other} for p in pairs):
            zone = road_map.zones(*c.routes)[c.zone]
            ahead = zone.point_i - c.places[0] <= zone.point_j - c.places[1]
            first, second = (c.ego, c.other) if ahead else (c.other, c.ego)
            pairs.append(Precedence(first, second, f"{first} is nearer to where they meet"))
    return replace(order, precedences=tuple(pairs))


def clear_time(given: SafetyInput, c: Conflict) -> float:
    """Return when the other vehicle is expected to have left the CAV's way into a conflict zone.

    Returns:
        Time from now [s]; 0 if the CAV goes first, inf if the other one is not expected to leave within the horizon.
    """
    if given.order.first_of(c.ego, c.other) == c.ego:
        return 0.0
    zone = given.road_map.zones(*c.routes)[c.zone]
    # Behind a vehicle that merges, the way is free once it is a car length down the common stretch.
    for motion in given.expected.get(c.other, ()):
        if motion.route == c.routes[1]:
            gone = motion.places > (zone.merge_j + CAR_LENGTH if zone.merge_j is not None else zone.exit_j)
            return float(given.forecast.times[int(np.argmax(gone))]) if gone.any() else float("inf")
    return 0.0
