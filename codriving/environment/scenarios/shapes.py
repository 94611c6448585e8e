"""Geometry to lay out a road with: turn a point about the middle, and bend a lane from here to there."""

import math

import numpy as np

from codriving.datatypes import Arc, Point, Straight
from codriving.errors import ScenarioError

_STRAIGHT = 1e-6  # An end that is no farther to the side than this is straight ahead [m]


def turned(point: Point, angle: float) -> Point:
    """Turn a point [m] about the origin from x towards y [rad], clockwise on the screen, where y points down."""
    x, y = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]) @ np.array(point)
    return float(x), float(y)


def bend(start: Point, heading: float, end: Point) -> Straight | Arc:
    """Return the arc that leaves a point in a direction and leads to another point; a straight line if that is ahead.

    Args:
        heading: Direction at the start [rad].

    Raises:
        ScenarioError: If the end is the start or straight behind it.
    """
    dx, dy = end[0] - start[0], end[1] - start[1]
    ahead = dx * math.cos(heading) + dy * math.sin(heading)
    right = dy * math.cos(heading) - dx * math.sin(heading)
    if abs(right) <= _STRAIGHT:
        if ahead <= 0:
            raise ScenarioError(f"no lane bends from {start} to {end}, which is not ahead; move one of the two")
        return Straight(start, end)
    radius, side = (ahead**2 + right**2) / (2 * abs(right)), math.copysign(1.0, right)
    center = start[0] - side * radius * math.sin(heading), start[1] + side * radius * math.cos(heading)
    phase = heading - side * math.pi / 2
    return Arc(center, radius, phase, phase + side * 2 * math.atan2(abs(right), ahead), clockwise=right > 0)
