"""What was driven: every vehicle at every simulation step."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from codriving.datatypes.vehicle import Kind


@dataclass(frozen=True, slots=True)
class Track:
    """The recorded motion of one vehicle, from its start until it left the road."""

    id: str
    kind: Kind
    route: str
    first_step: int
    x: NDArray[np.float64]  # Position of the centre (n,) [m]
    y: NDArray[np.float64]  # Position of the centre (n,) [m]
    heading: NDArray[np.float64]  # (n,) [rad]
    speed: NDArray[np.float64]  # (n,) [m/s]
    acceleration: NDArray[np.float64]  # (n,) [m/s2]
    action: tuple[str, ...]  # Name of the action in force at each row (n,); empty for HDVs
    arrived: float | None  # Time of arrival [s], or None
    length: float = 5.0  # [m]
    width: float = 2.0  # [m]


@dataclass(frozen=True, slots=True)
class Trajectory:
    """The motion of all vehicles of one episode."""

    step: float  # Time between two rows [s]
    tracks: tuple[Track, ...]
