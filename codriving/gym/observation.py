"""The paper's observation (Section II): one row a vehicle, and in it no more than the CDA level lets the CAV know."""

from collections.abc import Mapping
from math import cos, hypot, sin

import numpy as np
from gymnasium.spaces import Box

from codriving.datatypes.driving_model import DrivingModel
from codriving.datatypes.road import LaneId
from codriving.datatypes.vehicle import Intent, VehicleState
from codriving.datatypes.world import WorldState
from codriving.geometry.road_map import RoadMap
from codriving.gym.intention import intention
from codriving.gym.layout import FloatArray, Layout
from codriving.reasoning.sharing.cda import CdaLevel
from codriving.reasoning.sharing.detection import Glimpse
from codriving.reasoning.sharing.intent_sharing import HiddenIntents, IntentSharing, SharedIntents
from codriving.reasoning.sharing.state_sharing import SensedStates, SharedStates, StateSharing

Row = tuple[float, float, float, float, float, float]


class Observer:
    """Turns a world into what each CAV observes of it."""

    def __init__(self, road_map: RoadMap, model: DrivingModel, cda: CdaLevel, layout: Layout) -> None:
        self._road_map, self._model, self._layout = road_map, model, layout
        # The same objects as in the reasoning, so that the same things are hidden.
        self._states: StateSharing = SharedStates() if cda.state_sharing else SensedStates()
        self._intents: IntentSharing = SharedIntents() if cda.intent_sharing else HiddenIntents()
        self.lanes: Mapping[LaneId, int] = {lane.id: i for i, lane in enumerate(road_map.road.lanes, start=1)}
        low, high = layout.bounds(road_map)
        self._scale = np.maximum(-low, high) if layout.normalise else np.ones_like(low)
        self._low, self._high = low / self._scale, high / self._scale

    def space(self) -> Box:
        """Return a new space that every observation lies in."""
        return Box(self._low, self._high, dtype=np.float32)

    def nothing(self) -> FloatArray:
        """Return what a CAV observes that has left the road: zeros (rows, 6)."""
        return np.zeros(self._layout.shape, dtype=np.float32)

    def observe(self, world: WorldState) -> dict[str, FloatArray]:
        """Return what each CAV on the road observes.

        Returns:
            A matrix (rows, 6) a CAV, by id: the CAV itself, then the others from near to far, then zeros.
        """
        views = self._states.views(world, self._model)
        intents = self._intents.intents(world)
        return {cav.id: self._matrix(cav, world.intents[cav.id], views[cav.id], intents) for cav in world.cavs}

    def _matrix(
        self, ego: VehicleState, own: Intent, view: tuple[Glimpse, ...], intents: Mapping[str, Intent]
    ) -> FloatArray:
        near = sorted(view, key=lambda seen: (hypot(seen.x - ego.x, seen.y - ego.y), seen.id))
        x, y = (ego.x, ego.y) if self._layout.coordinates == "relative" else (0.0, 0.0)
        rows = [self._row(ego, own, 0.0, 0.0)]
        rows += [self._row(seen, intents.get(seen.id), x, y) for seen in near[: self._layout.rows - 1]]
        matrix = self.nothing()
        matrix[: len(rows)] = rows
        matrix /= self._scale
        # Only a vehicle that a fault of the simulator carries off the map is farther out than the bounds.
        return np.clip(matrix, self._low, self._high, out=matrix)

    def _row(self, seen: VehicleState | Glimpse, intent: Intent | None, x: float, y: float) -> Row:
        # A speed without a direction stands in vx; the unknown lane beside it says that it is one.
        vx, vy = seen.speed, 0.0
        if seen.heading is not None:
            vx, vy = seen.speed * cos(seen.heading), seen.speed * sin(seen.heading)
        lane = 0 if seen.lane is None else self.lanes[seen.lane]
        bound = intention(intent, seen.lane, self._road_map.routes)
        return seen.x - x, seen.y - y, vx, vy, float(lane), float(bound)
