"""What one CAV, or a unit, knows: what its sensors see, and else what has reached it, brought up to the present."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from math import cos, hypot, pi, sin, sqrt

import numpy as np

from codriving.datatypes import Action, DrivingModel, Intent, Kind, Told, VehicleState, WorldState
from codriving.geometry import RoadMap
from codriving.v2x.channel import Packet
from codriving.v2x.draws import CUT
from codriving.v2x.messages import (
    CollectivePerception,
    CooperativeAwareness,
    ManoeuvreCoordination,
    RouteSharing,
    V2xMessage,
)
from codriving.v2x.settings import ChannelSettings

PULLS_AWAY = 3.0  # How hard a human driver without limits accelerates from a standstill at most (IDM) [m/s2]

SLIP = 0.3  # Angle between the heading of a vehicle and the direction in which its centre moves, at most [rad]

TYRES = 12.0  # Largest lateral acceleration where vehicles have no limits [m/s2]

LARGEST = 15.0  # Within so much of a told place sight is still judged by eight points [m]


@dataclass(frozen=True, slots=True)
class ToldPlace:
    """Where a vehicle has come to that went straight on since it was told of."""

    x: float  # [m]
    y: float  # [m]
    doubt: float  # How far from there it may be, whatever it has done since [m]


@dataclass(frozen=True, slots=True)
class _Heard:
    state: VehicleState
    signal: str
    time: float  # When it was so [s]
    sender: str


class KnownWorld:
    """What one CAV has heard and sees, from one decision to the next; a unit at the road side has no sensors."""

    def __init__(self, ego: str, settings: ChannelSettings, road_map: RoadMap, model: DrivingModel) -> None:
        self.ego, self._settings, self._road_map, self._model = ego, settings, road_map, model
        self._heard: dict[str, _Heard] = {}
        self._intents: dict[str, tuple[Intent, tuple[Action, ...], float]] = {}
        self._routes: dict[str, tuple[str, float]] = {}  # Of human drivers
        self._lateral = TYRES if model.limits is None else model.limits.lateral

    def hear(self, packets: Iterable[Packet], time: float) -> None:
        """Take in what has reached the CAV, and forget what is no longer valid."""
        for packet in packets:
            for message in packet.messages:
                if isinstance(message, CooperativeAwareness):
                    self._note(message.state, "", message)
                elif isinstance(message, CollectivePerception):
                    for seen in message.objects:
                        self._note(seen.state, seen.signal, message)
                elif isinstance(message, RouteSharing):
                    self._routes[message.sender] = (message.route, message.time)
                elif isinstance(message, ManoeuvreCoordination):
                    known = self._intents.get(message.sender)
                    if known is None or known[2] < message.time:
                        self._intents[message.sender] = (message.intent, message.available, message.time)
        oldest = time - self._settings.validity - 1e-9
        self._heard = {name: heard for name, heard in self._heard.items() if heard.time >= oldest}
        self._intents = {name: intent for name, intent in self._intents.items() if intent[2] >= oldest}
        self._routes = {name: route for name, route in self._routes.items() if route[1] >= oldest}

    def _note(self, state: VehicleState, signal: str, message: V2xMessage) -> None:
        known = self._heard.get(state.id)
        if state.id != self.ego and (known is None or known.time < message.time):
            self._heard[state.id] = _Heard(state, signal, message.time, message.sender)

    def forget(self, sender: str) -> None:
        """Forget all that a CAV has told."""
        self._heard = {name: heard for name, heard in self._heard.items() if heard.sender != sender}
        self._intents.pop(sender, None)
        self._routes.pop(sender, None)

    def of(self, world: WorldState) -> WorldState:
        """Return what is known of a world; a vehicle is forgotten where the sensors see that it is not there."""
        own = [cav for cav in world.cavs if cav.id == self.ego]
        vehicles, signals, told = [*own], {}, {}
        intents, available = dict[str, Intent](), dict[str, tuple[Action, ...]]()
        for v in world.vehicles:
            if any(v.id != cav.id and world.senses(cav, v, self._model.detection_range) for cav in own):
                vehicles.append(self._named(v))
                if v.id in world.signals:
                    signals[v.id] = world.signals[v.id]
                if (way := self._way(v.id)) is not None:
                    told[v.id] = Told(0.0, world.time - way[1], seen=True)
        seen = {v.id for v in vehicles}
        behind_buildings = {name for pair in world.hidden if self.ego in pair for name in pair}
        for name, heard in list(self._heard.items()):
            if name in seen:
                continue
            age = world.time - heard.time
            if name not in behind_buildings and any(self.sees_all_of(c, self.place_of(heard.state, age)) for c in own):
                del self._heard[name]
                continue
            state = self._brought_up(heard.state, age)
            if state is None:
                continue
            vehicles.append(self._named(state))
            if heard.signal:
                signals[name] = heard.signal
            way = self._way(name)
            told[name] = self.told_of(heard.state, age, None if way is None else world.time - way[1])
        for v in vehicles:
            if v.id == self.ego:
                intents[v.id], available[v.id] = world.intents[v.id], world.available[v.id]
            elif v.kind is Kind.CAV:
                intents[v.id], available[v.id], _ = self._intents[v.id]
        hidden = tuple(pair for pair in world.hidden if self.ego in pair)
        ordered = tuple(sorted(vehicles, key=lambda v: v.id))
        routes = {v.id: self._routes[v.id][0] for v in ordered if v.kind is Kind.HDV and v.id in self._routes}
        return WorldState(world.time, world.step, ordered, intents, available, signals, hidden, self.ego, told, routes)

    def _way(self, name: str) -> tuple[str, float] | None:
        """Return the route that a vehicle has told, and when [s]; None if it has told none."""
        intent = self._intents.get(name)
        way = self._routes.get(name) if intent is None else (intent[0].route, intent[2])
        return way if way is not None and way[0] in self._road_map.routes else None

    def _named(self, v: VehicleState) -> VehicleState:
        """Take a vehicle whose intent is not known for one that a human drives."""
        kind = Kind.CAV if v.id in self._intents else Kind.HDV
        return v if v.kind is kind else replace(v, kind=kind)

    def _brought_up(self, v: VehicleState, age: float) -> VehicleState | None:
        """Let a vehicle go on at its speed since a message was made; None if it has left the road since."""
        if age <= 1e-9:
            return v
        way = v.speed * age
        told = self._way(v.id)
        if told is None:
            return replace(v, x=v.x + way * cos(v.heading), y=v.y + way * sin(v.heading))
        route = told[0]
        place = self._road_map.project(route, v.x, v.y)[0] + way
        if place > self._road_map.routes[route].goal:
            return None
        x, y, heading = self._road_map.paths[route].place(place)
        return replace(v, x=x, y=y, heading=heading, lane=self._road_map.lane_at(route, place))

    def place_of(self, v: VehicleState, age: float) -> ToldPlace:
        """Say where a vehicle may be some time [s] after it was told of."""
        way, told = v.speed * age, self.told_of(v, age, None)
        turned = SLIP * way + self._lateral * age**2 / 2
        doubt = max(told.behind, told.ahead) + turned + self._settings.place_tolerance
        return ToldPlace(v.x + way * cos(v.heading), v.y + way * sin(v.heading), doubt)

    def sees_all_of(self, own: VehicleState, place: ToldPlace) -> bool:
        """Whether the CAV's sensors see each place at which a vehicle may be."""
        x, y, doubt = place.x, place.y, place.doubt
        if doubt > LARGEST or hypot(x - own.x, y - own.y) + doubt > self._model.detection_range:
            return False
        if self._road_map.sight is None:
            return True
        around = np.arange(8) * pi / 4
        xs = np.concatenate(([own.x, x], x + doubt * np.cos(around)))
        ys = np.concatenate(([own.y, y], y + doubt * np.sin(around)))
        return not self._road_map.sight.hidden(xs, ys)[0].any()

    def told_of(self, v: VehicleState, age: float, intent_age: float | None) -> Told:
        """Say how far from where it is taken to be a vehicle may be, whatever it has done since."""
        model, settings = self._model, self._settings
        pedal = model.speed_gain * model.top_speed if model.limits is None else model.limits.acceleration
        brake = model.speed_gain * model.top_speed if model.limits is None else model.limits.braking
        if v.kind is Kind.HDV:
            pedal, brake = model.human_acceleration, model.human_braking
            if model.limits is None:
                pedal = max(pedal, PULLS_AWAY)
        place, speed = CUT * sqrt(2.0) * settings.noise, CUT * settings.speed_noise
        braked = min(age, v.speed / brake)
        return Told(
            age,
            intent_age,
            behind=v.speed * age - (v.speed * braked - brake * braked**2 / 2) + speed * age + place,
            ahead=pedal * age**2 / 2 + speed * age + place,
            aside=place,
            slower=min(v.speed, brake * age) + speed,
            faster=pedal * age + speed,
            since=(v.x, v.y, v.heading) if intent_age is None else None,
        )
