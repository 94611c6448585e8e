"""What a learned driver observes: the road and the others in conflict coordinates, the same wherever it comes from."""

from itertools import combinations
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from codriving.datatypes import DrivingModel, TrackedVehicle, Turn, VehicleState, WorldState
from codriving.geometry import RoadMap
from codriving.methods.learned.known import Knowledge
from codriving.methods.learned.layout import FAR, JUNCTION, LANES
from codriving.methods.learned.slots import Beside, Slot, conflict_slots, filled, leader_ahead, leader_slot
from codriving.reasoning import OPEN

Observation: TypeAlias = NDArray[np.float32]  # Features (feature_count,), each within -1 and 1

TURNS = (Turn.LEFT, Turn.STRAIGHT, Turn.RIGHT)


class Features:
    """Turns a world into what each CAV observes (baseline after Egorov, 2016; features of our own).

    The same object goes through an episode from its beginning, since human drivers' routes are guessed by watching.

    Args:
        family: ``junction`` or ``lanes``.
    """

    def __init__(self, road_map: RoadMap, model: DrivingModel, family: str, shared: bool) -> None:
        self._road_map, self._top, self._family = road_map, model.target_speeds[-1], family
        self._range, self._shared = model.detection_range, shared
        # Where no two routes have a zone in which the order is open, no route matters.
        pairs = combinations(sorted(road_map.routes), 2)
        self._meets = family == JUNCTION or any(z.relation in OPEN for pair in pairs for z in road_map.zones(*pair))
        self._beside = Beside(road_map, self._top) if family == LANES else None
        self.reset()

    def reset(self) -> None:
        """Begin an episode: forget whom one has watched."""
        self._knowledge = Knowledge(self._road_map, self._range, self._shared, self._meets)

    def observe(self, world: WorldState) -> dict[str, Observation]:
        """Return what each CAV on the road observes.

        Returns:
            Features (feature_count,) by id of the CAV, each within -1 and 1.
        """
        others = self._knowledge.others(world)
        return {cav.id: self._observation(cav, world, others[cav.id]) for cav in world.cavs}

    def _observation(self, ego: VehicleState, world: WorldState, others: tuple[TrackedVehicle, ...]) -> Observation:
        intent, top = world.intents[ego.id], self._top
        if self._beside is None:
            self._road_map.project_all(intent.route, [(ego.x, ego.y), *((other.x, other.y) for other in others)])
        place, _ = self._road_map.project(intent.route, ego.x, ego.y)
        route = self._road_map.routes[intent.route]
        far = FAR * top
        numbers = [ego.speed / top, intent.target_speed / top, (route.entry - place) / far, (route.goal - place) / far]
        numbers += [*(float(route.turn is turn) for turn in TURNS), 1.0]
        slots: list[Slot] = []
        if self._meets:
            priority = self._knowledge.priority(ego)
            slots += conflict_slots(ego, route.id, place, others, self._road_map, top, priority)
        beside: list[float] = []
        if self._beside is None:
            ahead = leader_ahead(ego, route.id, place, others, self._road_map)
        else:
            ahead, beside = self._beside.look(ego, intent, place, others, world.available[ego.id])
        if ahead is not None:
            slots.append(leader_slot(*ahead, top))
        return np.clip(np.array(numbers + filled(slots) + beside, dtype=np.float32), -1.0, 1.0)
