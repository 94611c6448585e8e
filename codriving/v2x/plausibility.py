"""Does what others say agree with what a CAV's own sensors see? Who says something else is not believed for a while."""

from collections.abc import Iterable, Mapping
from math import cos, hypot, pi, sin

import numpy as np

from codriving.datatypes import DrivingModel, Intent, VehicleState, WorldState, beside
from codriving.geometry import RoadMap
from codriving.v2x.channel import Packet
from codriving.v2x.knowledge import KnownWorld
from codriving.v2x.messages import (
    CollectivePerception,
    CooperativeAwareness,
    ManoeuvreCoordination,
    V2xMessage,
)
from codriving.v2x.settings import ChannelSettings

SLIP = 0.3  # Angle between the heading of a vehicle and the direction in which its centre moves, at most [rad]

TYRES = 12.0  # Largest lateral acceleration where vehicles have no limits [m/s2]

LARGEST = 15.0  # Within so much of a claimed place sight is still judged by eight points [m]

PEDAL = 1.25  # The acceleration of the last step exceeds what the speed asks for after it, by at most this factor


class Plausibility:
    """What one CAV makes of messages before it uses them."""

    def __init__(
        self, knowledge: KnownWorld, settings: ChannelSettings, road_map: RoadMap, model: DrivingModel
    ) -> None:
        self._knowledge, self._settings, self._road_map, self._model = knowledge, settings, road_map, model
        self._until: dict[str, float] = {}
        self._lateral = TYRES if model.limits is None else model.limits.lateral

    def believed(self, packets: Iterable[Packet], world: WorldState) -> tuple[list[Packet], list[Packet]]:
        """Part packets whose sender is believed from those whose sender is not, and forget what the latter said.

        Args:
            world: The world as it is, of which only what the CAV's sensors see is looked at.
        """
        ego, reach = self._knowledge.ego, self._model.detection_range
        own = next(v for v in world.vehicles if v.id == ego)
        seen = {v.id: v for v in world.vehicles if v.id != ego and world.senses(own, v, reach)}
        kept: list[Packet] = []
        rejected: list[Packet] = []
        for packet in packets:
            if self._until.get(packet.sender, -1.0) <= world.time + 1e-9:
                if not any(self._is_false(m, world.time, own, seen) for m in packet.messages):
                    kept.append(packet)
                    continue
                self._until[packet.sender] = world.time + self._settings.distrust
                self._knowledge.forget(packet.sender)
            rejected.append(packet)
        return kept, rejected

    def _is_false(self, message: V2xMessage, time: float, own: VehicleState, seen: Mapping[str, VehicleState]) -> bool:
        age = time - message.time
        if isinstance(message, CooperativeAwareness):
            return self._misplaced(message.state, age, own, seen)
        if isinstance(message, CollectivePerception):
            return any(self._misplaced(o.state, age, own, seen) for o in message.objects if o.state.id != own.id)
        if isinstance(message, ManoeuvreCoordination) and message.sender in seen:
            return not self._fits(message.intent, seen[message.sender], age)
        return False

    def _misplaced(self, v: VehicleState, age: float, own: VehicleState, seen: Mapping[str, VehicleState]) -> bool:
        """Whether a vehicle is seen elsewhere, or where it is said to be none is seen."""
        way = v.speed * age
        x, y = v.x + way * cos(v.heading), v.y + way * sin(v.heading)
        told = self._knowledge.told_of(v, age, None)
        turned = SLIP * way + self._lateral * age**2 / 2
        doubt = max(told.behind, told.ahead) + turned + self._settings.place_tolerance
        if (found := seen.get(v.id)) is not None:
            return hypot(found.x - x, found.y - y) > doubt
        return self._overlooks(own, x, y, doubt) and not self._may_have_left(v, way + doubt)

    def _overlooks(self, own: VehicleState, x: float, y: float, doubt: float) -> bool:
        """Whether the CAV's sensors see all of the places around one."""
        if doubt > LARGEST or hypot(x - own.x, y - own.y) + doubt > self._model.detection_range:
            return False
        if self._road_map.sight is None:
            return True
        around = np.arange(8) * pi / 4
        xs, ys = (
            np.concatenate(([own.x, x], x + doubt * np.cos(around))),
            np.concatenate(([own.y, y], y + doubt * np.sin(around))),
        )
        return not self._road_map.sight.hidden(xs, ys)[0].any()

    def _may_have_left(self, v: VehicleState, way: float) -> bool:
        """Whether a vehicle may have come to the end of a route since it was seen."""
        near = self._road_map.nearby.routes(v.x, v.y, v.heading, tolerance=self._road_map.widest)
        return any(place + way >= self._road_map.routes[route].goal for route, place in near)

    def _fits(self, intent: Intent, v: VehicleState, age: float) -> bool:
        """Whether a vehicle drives as one that has an intent."""
        lanes = self._road_map.lanes
        room = self._settings.route_tolerance
        if any(beside(v.lane, lane) for lane in lanes):
            room += self._road_map.widest  # It may have changed lanes since
        if intent.route not in (route for route, _ in self._road_map.nearby.routes(v.x, v.y, v.heading, room)):
            return False
        if age > self._model.decision_interval - 1e-9:
            return True  # It may have decided otherwise since
        wanted = self._model.speed_gain * (intent.target_speed - v.speed)
        if self._model.limits is not None:
            wanted = max(wanted, -self._model.limits.braking)
        return v.acceleration <= wanted * (PEDAL if wanted > 0 else 1.0) + self._settings.speed_tolerance
