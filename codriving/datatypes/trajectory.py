"""What was driven: every vehicle at every simulation step."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from codriving.datatypes.vehicle import Kind


@dataclass(frozen=True, slots=True)
class Track:
    """The recorded motion of one vehicle, from its start until it left the road.

    Attributes:
        x: Position of the centre (n,) [m].
        y: Position of the centre (n,) [m].
        heading: Heading (n,) [rad].
        speed: Speed (n,) [m/s].
        acceleration: Acceleration (n,) [m/s2].
        action: Name of the action in force at each row (n,); empty for HDVs.
        arrived: Time of arrival [s], or None.
        length: Vehicle length [m].
        width: Vehicle width [m].
    """

    id: str
    kind: Kind
    route: str
    first_step: int
    x: NDArray[np.float64]
    y: NDArray[np.float64]
    heading: NDArray[np.float64]
    speed: NDArray[np.float64]
    acceleration: NDArray[np.float64]
    action: tuple[str, ...]
    arrived: float | None
    length: float = 5.0
    width: float = 2.0


@dataclass(frozen=True, slots=True)
class Trajectory:
    """The motion of all vehicles of one episode.

    Attributes:
        step: Time between two rows [s].
    """

    step: float
    tracks: tuple[Track, ...]
