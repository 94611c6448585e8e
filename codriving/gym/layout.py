"""How an observation is laid out: rows, coordinates, scale, and the bounds that follow from the road."""

from dataclasses import dataclass
from functools import reduce

import numpy as np
from numpy.typing import NDArray

from codriving.environment.scenarios.pace import TOP_SPEED
from codriving.errors import ConfigError
from codriving.geometry.lane_path import lane_path
from codriving.geometry.road_map import RoadMap
from codriving.gym.intention import Intention

FEATURES = ("x", "y", "vx", "vy", "lane", "intention")
"""The columns of an observation (paper Section II)."""

COORDINATES = ("relative", "absolute")
MOST_ROWS = 100

MARGIN = 10.0
"""A vehicle is at most this far from the nearest centre line: a collision or leaving the road ends the episode [m]."""

FloatArray = NDArray[np.float32]


@dataclass(frozen=True, slots=True)
class Layout:
    """What an observation looks like.

    Attributes:
        coordinates: ``relative``: places of others are seen from the ego vehicle; ``absolute``: on the map.

    Raises:
        ConfigError: If a setting is not one of the allowed values.
    """

    rows: int = 8
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
        paths = [lane_path(lane).points for lane in road_map.road.lanes]
        least = reduce(np.minimum, [points.min(axis=0) for points in paths]) - MARGIN
        most = reduce(np.maximum, [points.max(axis=0) for points in paths]) + MARGIN
        low, high = np.zeros(self.shape, np.float32), np.zeros(self.shape, np.float32)
        low[:, :2], high[:, :2] = np.minimum(least, 0.0), np.maximum(most, 0.0)
        if self.coordinates == "relative":
            low[1:, :2], high[1:, :2] = least - most, most - least
        low[:, 2:4], high[:, 2:4] = -TOP_SPEED, TOP_SPEED
        high[:, 4], high[:, 5] = len(road_map.road.lanes), max(Intention)
        return low, high
