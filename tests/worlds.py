"""Worlds made by hand on a configured road, and what the reasoning makes of them."""

from dataclasses import dataclass, replace
from typing import Any

from codriving.datatypes.action import Action
from codriving.datatypes.conflict import Conflict
from codriving.datatypes.order import PassingOrder, Precedence
from codriving.datatypes.scene import Scene, Start
from codriving.datatypes.scene_description import SceneDescription
from codriving.datatypes.vehicle import Intent, Kind, VehicleState
from codriving.datatypes.world import WorldState
from codriving.environment.environment import Environment
from codriving.prediction.forecast import Forecast
from codriving.reasoning.conflicts import find_conflicts
from codriving.reasoning.expectation import expect
from codriving.reasoning.movers import movers
from codriving.reasoning.negotiation.coordinator import RuleCoordinator
from codriving.reasoning.plans import PLANS
from codriving.reasoning.safety.outlook import CONTINUATIONS, LONGITUDINAL, Outlook, motions
from codriving.reasoning.scenes import describe_scenes, lane_at, with_conflicts
from codriving.reasoning.state_sharing import SharedStates, StateSharing
from codriving.reasoning.tracking import Tracking

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
    """One vehicle on a route."""

    id: str
    route: str
    place: float
    speed: float
    target: float
    acceleration: float = 0.0

    @property
    def kind(self) -> Kind:
        """Who drives."""
        return Kind.CAV if self.id.startswith("CAV") else Kind.HDV


def car(name: str, route: str, place: float, speed: float, target: float | None = None, pedal: float = 0.0) -> Car:
    """A vehicle; who drives is told by its name, and it keeps its speed unless a target is given."""
    return Car(name, route, place, speed, speed if target is None else target, pedal)


def order_of(*pairs: str, binding: bool = False) -> PassingOrder:
    """A passing order from ``"CAV1 HDV1"``: first, then second; the sequence is that of their first mention."""
    precedences = tuple(Precedence(*pair.split(), "told so") for pair in pairs)
    names = dict.fromkeys(name for pair in pairs for name in pair.split())
    return PassingOrder(tuple(names), precedences, binding)


@dataclass
class ByHand:
    """A scenario with given starts on the road of another one."""

    environment: Environment
    starts: tuple[Start, ...]
    name: str = "by hand"

    def __post_init__(self) -> None:
        self.road, self.pace = self.environment.scenario.road, self.environment.scenario.pace

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

    def negotiate(self, coordinator: RuleCoordinator | None = None) -> PassingOrder:
        """The order of the built-in coordinator."""
        who = coordinator or RuleCoordinator(self.junction.road_map, self.forecast, False)
        who.forecast = self.forecast
        return who.negotiate(self.scenes, self.conflicts)

    def outlook(
        self, ego: str, order: PassingOrder | None = None, actions: tuple[Action, ...] = LONGITUDINAL
    ) -> Outlook:
        """The view of one CAV that goes by an order: the coordinator's, or the one given."""
        order = order or self.negotiate()
        scene, road_map = self.scenes[ego], self.junction.road_map
        known = movers(scene)
        expected = expect(known, order, road_map, self.forecast, LAG, minds_conflicts=True)
        stops, goes = motions(scene, actions, self.forecast)
        return Outlook(
            scene, self.conflicts[ego], order, known, expected, actions, stops, goes, road_map, self.forecast, LAG
        )


@dataclass
class Junction:
    """A configured road and its vehicle model, for worlds made by hand."""

    environment: Environment

    def __post_init__(self) -> None:
        self.road_map, self.model = self.environment.road_map, self.environment.driving_model

    def state(self, car: Car) -> VehicleState:
        """A vehicle on the centre line of its route."""
        path = self.road_map.paths[car.route]
        x, y = path.position(car.place)
        lane = lane_at(self.road_map, car.route, car.place)
        heading = float(path.heading(car.place))
        return VehicleState(car.id, car.kind, float(x), float(y), heading, car.speed, car.acceleration, lane)

    def world(self, *cars: Car, time: float = 0.0, step: int = 0) -> WorldState:
        """The world with some vehicles in it."""
        cars = tuple(sorted(cars, key=lambda c: c.id))
        states = {c.id: self.state(c) for c in cars}
        cavs = [c for c in cars if c.kind is Kind.CAV]
        intents = {c.id: Intent(c.route, c.target, states[c.id].lane) for c in cavs}
        return WorldState(time, step, tuple(states.values()), intents, {c.id: LONGITUDINAL for c in cavs})

    def think(
        self, world: WorldState, sharing: StateSharing | None = None, tracking: Tracking | None = None
    ) -> Thoughts:
        """Share states and intents, and find the conflicts."""
        forecast = self.forecast()
        forecast.begin_step([(c.speed, world.intents[c.id].target_speed) for c in world.cavs])
        views = (sharing or SharedStates()).views(world, self.model)
        scenes = describe_scenes(world, views, world.intents, tracking or Tracking(self.road_map))
        conflicts = {ego: find_conflicts(scene, self.road_map) for ego, scene in scenes.items()}
        scenes = {ego: with_conflicts(scene, conflicts[ego], self.road_map) for ego, scene in scenes.items()}
        return Thoughts(self, forecast, scenes, conflicts)

    def thoughts(self, *cars: Car) -> Thoughts:
        """What is thought of some vehicles."""
        return self.think(self.world(*cars))

    def outlook(self, *cars: Car, ego: str = "CAV1", order: PassingOrder | None = None) -> Outlook:
        """What one CAV sees of some vehicles."""
        return self.thoughts(*cars).outlook(ego, order)

    def forecast(self) -> Forecast:
        """Predictions with every plan that the reasoning asks for."""
        return Forecast(self.model, (*CONTINUATIONS, *PLANS))

    def drive(self, *starts: Start) -> Environment:
        """An environment in which given vehicles start."""
        e = self.environment
        return Environment(ByHand(e, starts), e.control, e.drivers, e.corrections)


def standing(outlook: Outlook, name: str, time: float) -> Outlook:
    """The same view, but of somebody who has been standing for some time."""
    others = {**outlook.others, name: replace(outlook.others[name], standing=time)}
    return replace(outlook, others=others)
