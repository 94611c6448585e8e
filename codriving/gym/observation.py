"""The paper's observation (Section II): one row a vehicle, and in it no more than the CDA level lets the CAV know."""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from enum import IntEnum
from itertools import pairwise
from math import cos, hypot, sin

import numpy as np
from gymnasium.spaces import Box
from numpy.typing import NDArray

from codriving.datatypes import DrivingModel, Intent, LaneId, Route, TrackedVehicle, VehicleState, WorldState, beside
from codriving.environment import TOP_SPEED
from codriving.errors import ConfigError
from codriving.geometry import RoadMap, lane_path
from codriving.reasoning import HIDDEN_INTENTS, SHARED_INTENTS, CdaLevel, SensedStates, SharedStates


class Intention(IntEnum):
    """Where a vehicle is bound; numbered from left to right."""

    HIDDEN = 0
    LEFT = 1
    STRAIGHT = 2
    RIGHT = 3


def intention(intent: Intent | None, lane: LaneId | None, routes: Mapping[str, Route]) -> Intention:
    """Reduce an intent to one number.

    A lane change under way comes first, then one that the route still asks for (a ramp that ends, say), and then what
    the route does at the junction.
    """
    if intent is None:
        return Intention.HIDDEN
    if lane is not None and beside(lane, intent.target_lane):
        return _side(lane, intent.target_lane)
    route = routes[intent.route]
    for place, (one, other) in enumerate(pairwise(route.lanes)):
        if beside(one, other) and (lane is None or lane in route.lanes[: place + 1]):
            return _side(one, other)
    return Intention[route.turn.name]


def _side(lane: LaneId, other: LaneId) -> Intention:
    return Intention.LEFT if other[2] < lane[2] else Intention.RIGHT


FEATURES = ("x", "y", "vx", "vy", "lane", "intention")  # The columns of an observation (paper Section II)

COORDINATES = ("relative", "absolute")
MOST_ROWS = 100

# A vehicle is at most this far from the nearest centre line: a collision or leaving the road ends the episode [m].
MARGIN = 10.0

FloatArray = NDArray[np.float32]


@dataclass(frozen=True, slots=True)
class Layout:
    """What an observation looks like."""

    rows: int = 8
    # ``relative``: places of others are seen from the ego vehicle; ``absolute``: on the map.
    coordinates: str = "relative"
    normalise: bool = False

    def __post_init__(self) -> None:
        if isinstance(self.rows, bool) or not isinstance(self.rows, int) or not 1 <= self.rows <= MOST_ROWS:
            raise ConfigError(f"rows must be a whole number from 1 to {MOST_ROWS}, got {self.rows!r}")
        if self.coordinates not in COORDINATES:
            raise ConfigError(f"coordinates must be {' or '.join(COORDINATES)}, got {self.coordinates!r}")
        if not isinstance(self.normalise, bool):
            raise ConfigError(f"normalise must be True or False, got {self.normalise!r}")

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and features."""
        return self.rows, len(FEATURES)

    def bounds(self, road_map: RoadMap) -> tuple[FloatArray, FloatArray]:
        """Return the smallest and largest values on a road (rows, 6) each, in SI units; 0 is always within."""
        points = np.concatenate([lane_path(lane).points for lane in road_map.road.lanes])
        least, most = points.min(axis=0) - MARGIN, points.max(axis=0) + MARGIN
        low, high = np.zeros(self.shape, np.float32), np.zeros(self.shape, np.float32)
        low[:, :2], high[:, :2] = np.minimum(least, 0.0), np.maximum(most, 0.0)
        if self.coordinates == "relative":
            low[1:, :2], high[1:, :2] = least - most, most - least
        low[:, 2:4], high[:, 2:4] = -TOP_SPEED, TOP_SPEED
        high[:, 4], high[:, 5] = len(road_map.road.lanes), max(Intention)
        return low, high


class Observer(ABC):
    """Turns a world into what each CAV observes of it."""

    @abstractmethod
    def observe(self, world: WorldState) -> dict[str, FloatArray]:
        """Return the observation of each CAV on the road, by id."""

    @abstractmethod
    def nothing(self) -> FloatArray:
        """Return the observation of a CAV that has left the road."""


class CdaObserver(Observer):
    """The paper's matrix, in which the CDA level hides what a CAV is not told."""

    def __init__(self, road_map: RoadMap, model: DrivingModel, cda: CdaLevel, layout: Layout) -> None:
        self._road_map, self._model, self._layout = road_map, model, layout
        # The same objects as in the reasoning, so that the same things are hidden.
        self._states = SharedStates() if cda.state_sharing else SensedStates()
        self._intents = SHARED_INTENTS if cda.intent_sharing else HIDDEN_INTENTS
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
        """Return what each CAV on the road observes."""
        views = self._states.detections(world, self._model)
        intents = self._intents.intents(world)
        return {cav.id: self._matrix(cav, world.intents[cav.id], views[cav.id], intents) for cav in world.cavs}

    def _matrix(
        self, ego: VehicleState, own: Intent, view: tuple[TrackedVehicle, ...], intents: Mapping[str, Intent]
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

    def _row(self, seen: VehicleState | TrackedVehicle, intent: Intent | None, x: float, y: float) -> tuple[float, ...]:
        # A speed without a direction stands in vx; the unknown lane beside it says that it is one.
        vx, vy = seen.speed, 0.0
        if seen.heading is not None:
            vx, vy = seen.speed * cos(seen.heading), seen.speed * sin(seen.heading)
        lane = 0 if seen.lane is None else self.lanes[seen.lane]
        return seen.x - x, seen.y - y, vx, vy, float(lane), float(intention(intent, seen.lane, self._road_map.routes))
