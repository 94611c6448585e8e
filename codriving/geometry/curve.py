"""Centre lines as functions of arc length: the exact shapes that paths are sampled from."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from codriving.datatypes import Arc, LaneShape, Point, Sine, Straight

FloatArray = NDArray[np.float64]

_FINE = 0.02  # Step of the numeric integration of arc length [m]


@dataclass(frozen=True, slots=True)
class Curve:
    """A centre line measured by arc length."""

    length: float  # Arc length [m]
    # Maps arc lengths (n,) [m] to points (n, 2) [m] and headings (n,) [rad].
    at: Callable[[FloatArray], tuple[FloatArray, FloatArray]]


def lane_curve(shape: LaneShape) -> Curve:
    """Return the centre line of a lane; positions and headings are those of highway-env's lane of that shape."""
    match shape:
        case Straight():
            return _straight(shape.start, shape.end)
        case Arc():
            return _arc(shape)
        case Sine():
            return _sine(shape)


def bridge(start: Point, heading: float, end: Point, end_heading: float) -> Curve:
    """Return the smooth way over a gap between two lanes, a cubic Hermite curve.

    Networks such as highway-env's roundabout leave metres between the end of a lane and the start of the next.
    """
    p, q = np.array(start), np.array(end)
    chord = float(np.hypot(*(q - p)))
    m = chord * np.array([math.cos(heading), math.sin(heading)])
    n = chord * np.array([math.cos(end_heading), math.sin(end_heading)])

    def point(u: FloatArray) -> FloatArray:
        w = u[:, None]
        return np.asarray(p + (3 * w**2 - 2 * w**3) * (q - p) + (w**3 - 2 * w**2 + w) * m + (w**3 - w**2) * n)

    def slope(u: FloatArray) -> FloatArray:
        w = u[:, None]
        return np.asarray(6 * (w - w**2) * (q - p) + (3 * w**2 - 4 * w + 1) * m + (3 * w**2 - 2 * w) * n)

    u = np.linspace(0.0, 1.0, max(16, math.ceil(2 * chord / _FINE)))
    arc = _integrate(u, np.hypot(*slope(u).T))

    def at(s: FloatArray) -> tuple[FloatArray, FloatArray]:
        v = np.interp(s, arc, u)
        dx, dy = slope(v).T
        return point(v), np.arctan2(dy, dx)

    return Curve(float(arc[-1]), at)


def taper(left: Curve, entered: Curve, length: float) -> Curve:
    """Return the way from the end of one lane over to the lane beside it, half a cosine across."""
    share = min(length / left.length, 1.0)

    def point(u: FloatArray) -> FloatArray:
        along = 1 - share * (1 - u)
        weight = ((1 - np.cos(np.pi * u)) / 2)[:, None]
        one, other = left.at(along * left.length)[0], entered.at(along * entered.length)[0]
        return np.asarray((1 - weight) * one + weight * other)

    u = np.linspace(0.0, 1.0, max(16, math.ceil(2 * share * left.length / _FINE)))
    points = point(u)
    arc = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))))
    dx, dy = np.gradient(points, axis=0).T
    headings = np.unwrap(np.arctan2(dy, dx))

    def at(s: FloatArray) -> tuple[FloatArray, FloatArray]:
        return point(np.interp(s, arc, u)), np.interp(s, arc, headings)

    return Curve(float(arc[-1]), at)


def first_part(curve: Curve, length: float) -> Curve:
    """Return the first metres of a curve [m]."""
    return Curve(length, curve.at)


def _straight(start: Point, end: Point) -> Curve:
    origin, delta = np.array(start, dtype=float), np.array(end, dtype=float) - np.array(start, dtype=float)
    length = float(np.hypot(*delta))
    heading = math.atan2(delta[1], delta[0])

    def at(s: FloatArray) -> tuple[FloatArray, FloatArray]:
        return origin + s[:, None] * (delta / length), np.full(len(s), heading)

    return Curve(length, at)


def _arc(shape: Arc) -> Curve:
    direction = 1 if shape.clockwise else -1

    def at(s: FloatArray) -> tuple[FloatArray, FloatArray]:
        phase = direction * s / shape.radius + shape.start_phase
        points = np.array(shape.center) + shape.radius * np.column_stack((np.cos(phase), np.sin(phase)))
        return points, phase + direction * math.pi / 2

    return Curve(shape.radius * (shape.end_phase - shape.start_phase) * direction, at)


def _sine(shape: Sine) -> Curve:
    base = _straight(shape.start, shape.end)
    along = np.linspace(0.0, base.length, max(2, math.ceil(base.length / _FINE)))

    def slope(x: FloatArray) -> FloatArray:
        return shape.amplitude * shape.pulsation * np.cos(shape.pulsation * x + shape.phase)

    arc = _integrate(along, np.hypot(1.0, slope(along)))

    def at(s: FloatArray) -> tuple[FloatArray, FloatArray]:
        x = np.interp(s, arc, along)
        points, heading = base.at(x)
        lateral = shape.amplitude * np.sin(shape.pulsation * x + shape.phase)
        points = points + lateral[:, None] * np.column_stack((-np.sin(heading), np.cos(heading)))
        return points, heading + np.arctan(slope(x))

    return Curve(float(arc[-1]), at)


def _integrate(x: FloatArray, y: FloatArray) -> FloatArray:
    """Return the running integral of y over x by the trapezium rule, beginning at 0."""
    return np.concatenate(([0.0], np.cumsum(np.diff(x) * (y[1:] + y[:-1]) / 2)))
