"""highway-env's lanes with the same numbers sooner: places on a lane without the detours of numpy's functions."""

import math

import numpy as np
from highway_env.road.lane import CircularLane, StraightLane
from numpy.typing import NDArray


class PlainStraightLane(StraightLane):
    """A straight lane."""

    def local_coordinates(self, position: NDArray[np.float64]) -> tuple[float, float]:
        """Return arc length and lateral offset of a place [m].

        Args:
            position: The place (2,) [m].
        """
        delta = position - self.start
        # The method, since plain products may be rounded differently from numpy's fused ones.
        return float(delta.dot(self.direction)), float(delta.dot(self.direction_lateral))


class PlainCircularLane(CircularLane):
    """An arc."""

    def local_coordinates(self, position: NDArray[np.float64]) -> tuple[float, float]:
        """Return arc length and lateral offset of a place [m].

        Args:
            position: The place (2,) [m].
        """
        delta = position - self.center
        turn = float(np.arctan2(delta[1], delta[0])) - self.start_phase
        # Not simplified: adding the start phase and taking it off again rounds, and highway-env does it.
        phase = self.start_phase + (((turn + math.pi) % (2 * math.pi)) - math.pi)
        radius = math.sqrt(delta.dot(delta))
        return self.direction * (phase - self.start_phase) * self.radius, self.direction * (self.radius - radius)
