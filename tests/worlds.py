"""Worlds made by hand on a configured road, and what the reasoning makes of them."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import cos, sin
from typing import Any

from codriving.datatypes.order import Conflict, PassingOrder, Precedence
from codriving.datatypes.parts import Scenario
from codriving.datatypes.road import LaneId, Road, beside
from codriving.datatypes.situation import SceneDescription
from codriving.datatypes.world import Action, Intent, Kind, Scene, Start, VehicleState, WorldState
from codriving.environment.environment import Environment
from codriving.geometry.lane_path import lane_path
from codriving.reasoning.conflicts import find_conflicts
from codriving.reasoning.ordering.coordinator import RuleCoordinator
from codriving.reasoning.perception import Moment, states
from codriving.reasoning.prediction.expectation import expect
from codriving.reasoning.prediction.forecast import Forecast
from codriving.reasoning.prediction.rollout import plan_library
from codriving.reasoning.safety.safety_input import CONTINUATIONS, LONGITUDINAL, SafetyInput, safety_input
from codriving.reasoning.sharing.scenes import describe_scenes, with_conflicts
from codriving.reasoning.sharing.sharing import SharedStates, StateSharing
from codriving.reasoning.sharing.tracking import Tracking

LAG = 5
"""Samples that must lie between two vehicles in a zone, for the expectations of these worlds."""

FULL: dict[str, Any] = {
    "state_sharing": True,
    "intent_sharing": True,
    "negotiation": True,
    "safety_check": True,
    "binding": False,
    "own_order": "own_view",
}
"""Toggles of the whole framework."""


@dataclass(frozen=True)
class Car:
    """One vehicle on a route, or beside its centre line while it changes lanes (to the right is positive)."""

    id: str
    route: str
    place: float
    speed: float
    target: float
    acceleration: float = 0.0
    offset: float = 0.0

    @property
    def kind(self) -> Kind:
        """Who drives."""
        return Kind.CAV if self.id.startswith("CAV") else Kind.HDV


def car(
    name: str,
    route: str,
    place: float,
    speed: float,
    target: float | None = None,
    pedal: float = 0.0,
    offset: float = 0.0,
) -> Car:
    """A vehicle; who drives is told by its name, and it keeps its speed unless a target is given."""
    return Car(name, route, place, speed, speed if target is None else target, pedal, offset)


def order_of(*pairs: str, binding: bool = False) -> PassingOrder:
    """A passing order from ``"CAV1 HDV1"``: first, then second; the sequence is that of their first mention."""
    precedences = tuple(Precedence(*pair.split(), "told so") for pair in pairs)
    names = dict.fromkeys(name for pair in pairs for name in pair.split())
    return PassingOrder(tuple(names), precedences, binding)


@dataclass
class ByHand(Scenario):
    """A scenario with given starts on the road of another one."""

    environment: Environment
    starts: tuple[Start, ...]
    name: str = "by hand"

    def __post_init__(self) -> None:
        self.pace = self.environment.scenario.pace

    @property
    def road(self) -> Road:
        """The road of the other one."""
        return self.environment.scenario.road

    def scene(self, seed: int) -> Scene:
        """The starts, whatever the seed."""
        return Scene(seed, self.starts)


@dataclass
class Thoughts:
    """Everything that comes before the safety check."""

    junction: "Junction"
    forecast: Forecast
    scenes: dict[str, SceneDescription]
    conflicts: dict[str, tuple[Conflict, ...]]
    available: Mapping[str, tuple[Action, ...]]

    def moment(self, time: float = 0.0) -> Moment:
        """All of it as one moment."""
        known = {name: scene.vehicles() for name, scene in self.scenes.items()}
        road_map = self.junction.road_map
        return Moment(time, self.scenes, self.conflicts, known, self.available, road_map, self.forecast)

    def negotiate(self, coordinator: RuleCoordinator | None = None) -> PassingOrder:
        """The order of the built-in coordinator."""
        return (coordinator or RuleCoordinator(False)).negotiate(self.moment())

    def safety_input(
        self, ego: str, order: PassingOrder | None = None, actions: tuple[Action, ...] | None = None
    ) -> SafetyInput:
        """What one CAV is checked by that goes by an order: the coordinator's, or the one given."""
        moment = self.moment()
        if actions is not None:
            moment = replace(moment, available={**moment.available, ego: actions})
        order = order or self.negotiate()
        return safety_input(moment, ego, order, expect(moment, ego, order, LAG), LAG)


@dataclass
class Junction:
    """A configured road and its vehicle model, for worlds made by hand."""

    environment: Environment

    def __post_init__(self) -> None:
        self.road_map, self.model = self.environment.road_map, self.environment.driving_model

    def state(self, car: Car) -> VehicleState:
        """A vehicle on the centre line of its route, or beside it."""
        path = self.road_map.paths[car.route]
        x, y = path.position(car.place)
        heading = float(path.heading(car.place))
        x, y = float(x) - car.offset * sin(heading), float(y) + car.offset * cos(heading)
        lane = self._nearest(self.road_map.lane_at(car.route, car.place), x, y)
        return VehicleState(car.id, car.kind, x, y, heading, car.speed, car.acceleration, lane)

    def _nearest(self, lane: LaneId, x: float, y: float) -> LaneId:
        sides = [name for name in self.road_map.lanes if name == lane or beside(name, lane)]
        return min(sides, key=lambda name: abs(lane_path(self.road_map.lanes[name]).project(x, y)[1]))

    def actions(self, lane: LaneId) -> tuple[Action, ...]:
        """What a moving vehicle may do on a lane: change onto one beside it, if that is not forbidden."""
        start, end, index = lane
        found = self.road_map.lanes
        sides = ((Action.LANE_LEFT, (start, end, index - 1)), (Action.LANE_RIGHT, (start, end, index + 1)))
        along = (a for a in LONGITUDINAL if a is not Action.HOLD or self.model.steady)
        return (*along, *(action for action, side in sides if side in found and not found[side].forbidden))

    def world(self, *cars: Car, time: float = 0.0, step: int = 0) -> WorldState:
        """The world with some vehicles in it."""
        cars = tuple(sorted(cars, key=lambda c: c.id))
        states = {c.id: self.state(c) for c in cars}
        cavs = [c for c in cars if c.kind is Kind.CAV]
        lanes = {c.id: self.road_map.lane_at(c.route, c.place) for c in cavs}
        intents = {c.id: Intent(c.route, c.target, lanes[c.id]) for c in cavs}
        available = {c.id: self.actions(lanes[c.id]) for c in cavs}
        return WorldState(time, step, tuple(states.values()), intents, available)

    def think(
        self, world: WorldState, sharing: StateSharing | None = None, tracking: Tracking | None = None
    ) -> Thoughts:
        """Share states and intents, and find the conflicts."""
        forecast = self.forecast()
        forecast.begin_step(states(world, self.road_map, self.model))
        detections = (sharing or SharedStates()).detections(world, self.model)
        scenes = describe_scenes(world, detections, world.intents, tracking or Tracking(self.road_map))
        conflicts = {ego: find_conflicts(scene, self.road_map) for ego, scene in scenes.items()}
        scenes = {ego: with_conflicts(scene, conflicts[ego], self.road_map) for ego, scene in scenes.items()}
        return Thoughts(self, forecast, scenes, conflicts, world.available)

    def thoughts(self, *cars: Car) -> Thoughts:
        """What is thought of some vehicles."""
        return self.think(self.world(*cars))

    def safety_input(self, *cars: Car, ego: str = "CAV1", order: PassingOrder | None = None) -> SafetyInput:
        """What one CAV sees of some vehicles."""
        return self.thoughts(*cars).safety_input(ego, order)

    def forecast(self) -> Forecast:
        """Predictions with every plan that the reasoning asks for."""
        return Forecast(self.model, (*CONTINUATIONS, *plan_library(self.model)), self.road_map)

    def drive(self, *starts: Start) -> Environment:
        """An environment in which given vehicles start."""
        e = self.environment
        return Environment(
            ByHand(e, starts), e.control, e.drivers, e.corrections, e.limits, steady=e.driving_model.steady
        )


def standing(given: SafetyInput, name: str, time: float) -> SafetyInput:
    """The same, but with a vehicle that has been standing for some time."""
    vehicles = {**given.vehicles, name: replace(given.vehicles[name], standing=time)}
    return replace(given, moment=replace(given.moment, vehicles={**given.moment.vehicles, given.ego: vehicles}))
