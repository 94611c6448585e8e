"""Oriented boxes and whether they overlap, by the separating axis theorem."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from codriving.geometry.curve import FloatArray

BoolArray = NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class Footprint:
    """The ground that a vehicle covers [m]."""

    length: float
    width: float


# For planning and scheduling: vehicles cut corners by up to 0.8 m. Wider than 3.2 m, opposite 4 m lanes conflict.
PLANNING = Footprint(6.0, 3.2)

TRUE = Footprint(5.0, 2.0)  # For measuring: collisions and post-encroachment times


def corners(x: ArrayLike, y: ArrayLike, heading: ArrayLike, length: float, width: float) -> FloatArray:
    """Return the corner points (..., 4, 2) of boxes [m], in order around the box.

    Args:
        x: Centres (...) [m].
        y: Centres (...) [m].
        heading: Headings (...) [rad].
    """
    cos, sin = np.cos(heading)[..., None], np.sin(heading)[..., None]
    along = np.array([0.5, 0.5, -0.5, -0.5]) * length
    across = np.array([0.5, -0.5, -0.5, 0.5]) * width
    px = np.asarray(x)[..., None] + along * cos - across * sin
    py = np.asarray(y)[..., None] + along * sin + across * cos
    return np.stack((px, py), axis=-1)


def overlap(corners_a: FloatArray, corners_b: FloatArray) -> bool:
    """Return whether two boxes with corner points (4, 2) [m] overlap; touching is not overlapping."""
    return bool(overlaps(corners_a, corners_b))


def overlaps(corners_a: FloatArray, corners_b: FloatArray) -> BoolArray:
    """Return whether many boxes overlap, pair by pair."""
    sides = (c[..., 1:3, :] - c[..., 0:2, :] for c in (corners_a, corners_b))
    axes = np.concatenate(np.broadcast_arrays(*sides), axis=-2)
    a = np.einsum("...kc,...pc->...kp", axes, corners_a)
    b = np.einsum("...kc,...pc->...kp", axes, corners_b)
    apart = (a.max(-1) <= b.min(-1)) | (b.max(-1) <= a.min(-1))
    return np.asarray(~apart.any(-1))


def separation(
    dx: FloatArray,
    dy: FloatArray,
    cos: FloatArray,
    sin: FloatArray,
    footprint: Footprint,
    other: Footprint | None = None,
) -> FloatArray:
    """Return how far apart boxes are along the axis that separates them best.

    The value is negative exactly if the boxes overlap and changes continuously with their places, so that the limit
    of an overlap can be interpolated.

    Args:
        other: Footprint of the second box, if it is another one.
    """
    length, width = footprint.length / 2, footprint.width / 2
    c, s = np.abs(cos), np.abs(sin)
    if other is not None and other != footprint:
        long, wide = other.length / 2, other.width / 2
        ahead = np.abs(dx) - (length + long * c + wide * s)
        beside = np.abs(dy) - (width + wide * c + long * s)
        ahead_of_it = np.abs(cos * dx + sin * dy) - (long + length * c + width * s)
        beside_it = np.abs(cos * dy - sin * dx) - (wide + width * c + length * s)
        first, second = np.maximum(ahead, beside), np.maximum(ahead_of_it, beside_it)
        return np.maximum(first, second)
    along, across = length * (1 + c) + width * s, width * (1 + c) + length * s
    first = np.maximum(np.abs(dx) - along, np.abs(dy) - across)
    second = np.maximum(np.abs(cos * dx + sin * dy) - along, np.abs(cos * dy - sin * dx) - across)
    return np.maximum(first, second)
