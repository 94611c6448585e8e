"""From lanes to paths: one lane, or the lanes of a route joined into one."""

import math
from collections.abc import Sequence

import numpy as np

from codriving.datatypes import Lane, beside
from codriving.geometry.curve import Curve, FloatArray, bridge, first_part, lane_curve, taper
from codriving.geometry.path import Path

SPACING = 0.5  # Nominal distance between two path points [m]

JOINED = 1e-3  # Lanes whose ends are closer than this are joined without a bridge [m]


def lane_path(lane: Lane, spacing: float = SPACING) -> Path:
    """Sample the centre line of one lane; the exact spacing [m] divides the length evenly."""
    return _sample([lane_curve(lane.shape)], spacing)


def route_path(lanes: Sequence[Lane], change: float = 0.0, spacing: float = SPACING) -> Path:
    """Join lanes into one path; a gap between two of them is bridged smoothly, a lane change is a taper."""
    return _sample([curve for _, curve in joined_curves(lanes, change)], spacing)


def lane_starts(lanes: Sequence[Lane], change: float = 0.0) -> tuple[float, ...]:
    """Return the arc length at which each lane begins on the path that joins them [m].

    A lane that is changed to begins in the middle of the change, whose length is given [m].
    """
    starts, s = [], 0.0
    for kind, curve in joined_curves(lanes, change):
        if kind == "lane":
            starts.append(s)
        elif kind == "change":
            starts.append(s + curve.length / 2)
        s += curve.length
    return tuple(starts)


def joined_curves(lanes: Sequence[Lane], change: float) -> list[tuple[str, Curve]]:
    """Return the curves of a route in order, each with what it is: a ``lane``, a ``bridge`` or a lane ``change``."""
    curves: list[tuple[str, Curve]] = []
    for k, lane in enumerate(lanes):
        curve = lane_curve(lane.shape)
        if k and beside(lanes[k - 1].id, lane.id):
            left = lane_curve(lanes[k - 1].shape)
            curves[-1] = ("lane", first_part(left, max(left.length - change, 0.0)))
            curves.append(("change", taper(left, curve, change)))
            continue
        if curves:
            x, y, heading = end_of(curves[-1][1], at_start=False)
            x2, y2, heading2 = end_of(curve, at_start=True)
            if math.hypot(x2 - x, y2 - y) > JOINED:
                curves.append(("bridge", bridge((x, y), heading, (x2, y2), heading2)))
        curves.append(("lane", curve))
    return curves


def end_of(curve: Curve, at_start: bool) -> tuple[float, float, float]:
    """Return x, y [m] and heading [rad] at one end of a curve."""
    points, headings = curve.at(np.array([0.0 if at_start else curve.length]))
    return float(points[0, 0]), float(points[0, 1]), float(headings[0])


def _sample(curves: Sequence[Curve], spacing: float) -> Path:
    starts = np.concatenate(([0.0], np.cumsum([curve.length for curve in curves])))
    length = float(starts[-1])
    grid = np.linspace(0.0, length, max(2, round(length / spacing) + 1))
    piece = np.clip(np.searchsorted(starts, grid, side="right") - 1, 0, len(curves) - 1)
    points: FloatArray = np.empty((len(grid), 2))
    headings: FloatArray = np.empty(len(grid))
    for k, curve in enumerate(curves):
        mine = piece == k
        points[mine], headings[mine] = curve.at(grid[mine] - starts[k])
    # Lanes may state the same heading a whole turn apart; without unwrapping, interpolation would spin there.
    headings = np.unwrap(headings)
    points.flags.writeable = headings.flags.writeable = False
    return Path(points, headings, length)
