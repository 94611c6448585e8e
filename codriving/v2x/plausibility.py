"""Does what others say agree with what a CAV's own sensors see? Who says something else is not believed for a while."""

from collections.abc import Iterable, Mapping
from math import hypot

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

PEDAL = 1.25  # The acceleration of the last step exceeds what the speed asks for after it, by at most this factor


class Plausibility:
    """What one CAV makes of messages before it uses them."""

    def __init__(
        self, knowledge: KnownWorld, settings: ChannelSettings, road_map: RoadMap, model: DrivingModel
    ) -> None:
        self._knowledge, self._settings, self._road_map, self._model = knowledge, settings, road_map, model
        self._until: dict[str, float] = {}

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
        place = self._knowledge.place_of(v, age)
        if (found := seen.get(v.id)) is not None:
            return hypot(found.x - place.x, found.y - place.y) > place.doubt
        return self._knowledge.sees_all_of(own, place) and not self._may_have_left(v, v.speed * age + place.doubt)

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
