"""The others as a learned driver knows them: what is shared, or only what its own sensors and the map tell."""

from dataclasses import replace

from codriving.datatypes import Kind, Told, TrackedVehicle, VehicleState, WorldState
from codriving.geometry import RoadMap
from codriving.reasoning import Places, Tracking

SHARED = ""  # In whose name the CAVs watch together when they share what they see


class Knowledge:
    """Watches the others from one decision to the next; the intent of a human driver is never known."""

    def __init__(self, road_map: RoadMap, detection_range: float, shared: bool, routes: bool) -> None:
        self._road_map, self._range, self._shared, self._routes = road_map, detection_range, shared, routes
        self._tracking = Tracking(road_map)

    def others(self, world: WorldState) -> dict[str, tuple[TrackedVehicle, ...]]:
        """Return whom each CAV knows of, itself left out."""
        self._tracking.begin_step()
        cavs, vehicles = world.cavs, world.vehicles
        if not self._shared:
            return {
                cav.id: tuple(
                    self._stranger(cav.id, v) for v in vehicles if v.id != cav.id and world.senses(cav, v, self._range)
                )
                for cav in cavs
            }
        known = [
            self._partner(v, world) if v.kind is Kind.CAV else self._human(v, world)
            for v in vehicles
            if v.kind is Kind.CAV or world.known_to_cavs(v, self._range)
        ]
        return {cav.id: tuple(other for other in known if other.id != cav.id) for cav in cavs}

    def priority(self, v: VehicleState) -> int | None:
        """Return the rank of a vehicle by the rules of the road, which those who share agree to mind."""
        return self._road_map.lanes[v.lane].priority if self._shared and self._road_map.road.regulated else None

    def _partner(self, v: VehicleState, world: WorldState) -> TrackedVehicle:
        """A CAV that has told its route and its target speed."""
        intent = world.intents[v.id]
        places: Places = ()
        if self._routes:
            s, _ = self._road_map.project(intent.route, v.x, v.y)
            lane = self._road_map.lane_at(intent.route, s)
            places = ((intent.route, s), *self._road_map.changes.covered(intent.route, lane, v.x, v.y))
        return replace(_detected(v), kind=v.kind, lane=v.lane, routes=places, intent=intent)

    def _human(self, v: VehicleState, world: WorldState) -> TrackedVehicle:
        """A human driver whom all CAVs watch together."""
        human = self._stranger(SHARED, v, world.told.get(v.id))
        return replace(human, kind=v.kind, acceleration=v.acceleration)

    def _stranger(self, watcher: str, v: VehicleState, told: Told | None = None) -> TrackedVehicle:
        seen = _detected(v, told)
        return replace(seen, routes=self._tracking.places(watcher, seen, None)) if self._routes else seen


def _detected(v: VehicleState, told: Told | None = None) -> TrackedVehicle:
    """What sensors tell of a vehicle."""
    return TrackedVehicle(v.id, None, v.x, v.y, v.speed, v.heading, None, None, v.length, told=told)
