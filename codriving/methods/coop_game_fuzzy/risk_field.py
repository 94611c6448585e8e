"""The risk of being near a vehicle: a Gaussian field around it, longer along its way, and longest at top speed."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

ALONG, ACROSS = 8.0, 2.5
"""Semi-axes at which the risk has fallen to 1/e, along the vehicle at top speed and across it [m]."""

STANDING = 0.5
"""Share of the length of the field that is left around a standing vehicle."""


@dataclass(frozen=True, slots=True)
class Body:
    """Where a vehicle is over time; the shapes of all four can be broadcast.

    Attributes:
        x: Place of its middle [m].
        y: Place of its middle [m].
        heading: Heading [rad].
        speed: Speed [m/s].
    """

    x: Array
    y: Array
    heading: Array
    speed: Array


def risk(x: ArrayLike, y: ArrayLike, source: Body, top_speed: float) -> Array:
    """Return the risk of being at a place.

    Args:
        x: The place [m].
        y: The place [m].
        top_speed: Speed at which the field has its full length [m/s].

    Returns:
        1 at the middle of the vehicle, falling to 0 far from it.
    """
    dx, dy = np.asarray(x) - source.x, np.asarray(y) - source.y
    cos, sin = np.cos(source.heading), np.sin(source.heading)
    length = ALONG * (STANDING + (1 - STANDING) * np.clip(source.speed / top_speed, 0.0, 1.0))
    return np.asarray(np.exp(-(((cos * dx + sin * dy) / length) ** 2) - ((cos * dy - sin * dx) / ACROSS) ** 2))
