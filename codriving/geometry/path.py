"""A centre line as a polyline, measured by arc length, and places and tracks projected on it."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from codriving.geometry.curve import FloatArray

_BEHIND, _AHEAD = 5.0, 30.0  # How far around the expected place a projection looks [m]

STRAIGHT = 1e-7  # Points no farther from a straight line than this are on it [m]; headings no farther apart [rad]

_Segment = tuple[float, float, float, float, float]  # Where it begins, its way [m] and its squared length [m2]


@dataclass(frozen=True, slots=True, eq=False)
class Path:
    """A centre line sampled uniformly by arc length."""

    points: FloatArray  # Points of the centre line (n, 2) [m], n at least 2
    headings: FloatArray  # Unwrapped headings at the points (n,) [rad]
    length: float  # Arc length of the whole path [m]
    spacing: float = field(init=False, repr=False)  # Arc length between two points [m]
    # The same numbers once more: contiguous for all points at once, and as plain numbers for one place.
    _x: FloatArray = field(init=False, repr=False)
    _y: FloatArray = field(init=False, repr=False)
    _places: list[list[float]] = field(init=False, repr=False)
    _turns: list[float] = field(init=False, repr=False)
    _segments: list[_Segment] = field(init=False, repr=False)
    axes: FloatArray = field(init=False, repr=False)  # x and y of the points (2, n) [m]
    _squares: FloatArray = field(init=False, repr=False)  # Their squared distances from the origin (n,) [m2]
    is_straight: bool = field(init=False, repr=False)
    directions: FloatArray = field(init=False, repr=False)  # Unit vectors along the path (2, n)

    def __post_init__(self) -> None:
        x, y = self.points.T
        for name, value in (
            ("spacing", self.length / (len(self.points) - 1)),
            ("_x", np.ascontiguousarray(x)),
            ("_y", np.ascontiguousarray(y)),
            ("_places", self.points.tolist()),
            ("_turns", self.headings.tolist()),
            ("_segments", [_segment(*ends) for ends in pairwise(self.points.tolist())]),
            ("axes", np.array((x, y))),
            ("_squares", x * x + y * y),
            ("is_straight", _is_straight(self.points, self.headings, self.length)),
            ("directions", np.array((np.cos(self.headings), np.sin(self.headings)))),
        ):
            object.__setattr__(self, name, value)

    @property
    def arc_lengths(self) -> FloatArray:
        """Arc length of every point (n,) [m]."""
        return np.linspace(0.0, self.length, len(self.points))

    def position(self, s: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Return x and y [m] at arc lengths s [m]; the path goes straight on before its start and past its end."""
        s = np.asarray(s, dtype=np.float64)
        inside = np.clip(s, 0.0, self.length)
        k = np.minimum((inside / self.spacing).astype(np.intp), len(self.points) - 2)
        t = inside / self.spacing - k
        x, y = self._x, self._y
        overshoot = s - inside
        heading = np.where(overshoot < 0, self.headings[0], self.headings[-1])
        beyond_x, beyond_y = overshoot * np.cos(heading), overshoot * np.sin(heading)
        return x[k] + t * (x[k + 1] - x[k]) + beyond_x, y[k] + t * (y[k + 1] - y[k]) + beyond_y

    def place(self, s: float) -> tuple[float, float, float]:
        """Return x and y [m] and heading [rad] at one arc length [m], as `position` and `heading` do, without numpy."""
        inside = min(max(s, 0.0), self.length)
        k = min(int(inside / self.spacing), len(self._places) - 2)
        t = inside / self.spacing - k
        turn = self._turns[k] + t * (self._turns[k + 1] - self._turns[k])
        if inside != s:
            # Numpy's cosine is not that of the mathematics library to the last bit.
            x, y = self.position(s)
            return float(x), float(y), turn
        (x0, y0), (x1, y1) = self._places[k], self._places[k + 1]
        return x0 + t * (x1 - x0), y0 + t * (y1 - y0), turn

    def heading(self, s: ArrayLike) -> FloatArray:
        """Return the unwrapped heading [rad] at arc length s [m]; constant before the start and past the end."""
        s = np.clip(np.asarray(s, dtype=np.float64), 0.0, self.length)
        k = np.minimum((s / self.spacing).astype(np.intp), len(self.points) - 2)
        t = s / self.spacing - k
        heading: FloatArray = self.headings[k] + t * (self.headings[k + 1] - self.headings[k])
        return heading

    def project(self, x: float, y: float, near: float | None = None) -> tuple[float, float]:
        """Return arc length and lateral offset of a point [m].

        Args:
            x: Point [m].
            y: Point [m].
            near: Arc length at which the point was seen last [m]; only 5 m before it and 30 m past it are searched.

        Returns:
            Arc length of the nearest place on the path (negative before the start, beyond `length` past the end),
            and the offset from it, positive on the right hand of the direction of travel on screen.
        """
        first, last = 0, len(self.points)
        if near is None and self.is_straight:
            return self.project_at(self.nearest_on_straight(x, y, 0, last - 1), x, y)
        if near is not None:
            first = min(max(math.floor((near - _BEHIND) / self.spacing), 0), last - 2)
            last = min(max(math.ceil((near + _AHEAD) / self.spacing) + 1, 2), last)
        dx, dy = self._x[first:last] - x, self._y[first:last] - y
        return self.project_at(first + int((dx * dx + dy * dy).argmin()), x, y)

    def project_all(self, x: FloatArray, y: FloatArray) -> list[tuple[float, float]]:
        """Return what `project` returns for each of several points (m,) [m]."""
        if self.is_straight:
            return [self.project(*one) for one in zip(x.tolist(), y.tolist(), strict=True)]
        dx, dy = self._x - x[:, None], self._y - y[:, None]
        nearest = (dx * dx + dy * dy).argmin(axis=1)
        return [self.project_at(*one) for one in zip(nearest.tolist(), x.tolist(), y.tolist(), strict=True)]

    def nearest_on_straight(self, x: float, y: float, first: int, last: int) -> int:
        """Return which of some points of a straight path is the nearest to a place [m]."""
        (x0, y0), cos, sin = self._places[0], math.cos(self._turns[0]), math.sin(self._turns[0])
        k = round(((x - x0) * cos + (y - y0) * sin) / self.spacing)
        return nearest_from(self._places, k, x, y, first, last)

    def project_at(self, k: int, x: float, y: float) -> tuple[float, float]:
        """Return arc length and lateral offset [m] of a point whose nearest path point is the k-th."""
        last = len(self._places) - 1
        if k in (0, last):
            cos, sin = math.cos(self._turns[k]), math.sin(self._turns[k])
            dx, dy = x - self._places[k][0], y - self._places[k][1]
            along = dx * cos + dy * sin
            if along < 0 if k == 0 else along > 0:
                return (self.length if k else 0.0) + along, cos * dy - sin * dx
        if k in (0, last):
            k = min(k, last - 1)
            return self._along(k, _on_segment(self._segments[k], x, y))
        # What is nearest along either segment; if both are as near, the one before wins.
        before, after = _on_segment(self._segments[k - 1], x, y), _on_segment(self._segments[k], x, y)
        if before[0] == after[0]:
            return min(self._along(k - 1, before), self._along(k, after))
        return self._along(k - 1, before) if before[0] < after[0] else self._along(k, after)

    def _along(self, k: int, nearest: tuple[float, float, float]) -> tuple[float, float]:
        """Return arc length and lateral offset [m] of a place by what is nearest to it on the k-th segment."""
        square, t, side = nearest
        return (k + t) * self.spacing, math.copysign(math.sqrt(square), side)


def _segment(begin: list[float], end: list[float]) -> _Segment:
    dx, dy = end[0] - begin[0], end[1] - begin[1]
    return begin[0], begin[1], dx, dy, dx * dx + dy * dy


def _on_segment(segment: _Segment, x: float, y: float) -> tuple[float, float, float]:
    """Return squared distance [m2], how far along a segment the nearest place is (0 to 1), and a sign for the side."""
    x0, y0, dx, dy, length = segment
    px, py = x - x0, y - y0
    t = (px * dx + py * dy) / length
    t = 0.0 if t < 0.0 else 1.0 if t > 1.0 else t
    return (px - t * dx) ** 2 + (py - t * dy) ** 2, t, dx * py - dy * px


def nearest_from(places: Sequence[Sequence[float]], k: int, x: float, y: float, first: int, last: int) -> int:
    """Return which of some points of a straight line is the nearest to a place, the first one of two; k is about it."""
    k = min(max(k, first), last)
    here = squared_distance(places[k], x, y)
    while k < last and (there := squared_distance(places[k + 1], x, y)) < here:
        k, here = k + 1, there
    while k > first and (there := squared_distance(places[k - 1], x, y)) <= here:
        k, here = k - 1, there
    return k


def squared_distance(point: Sequence[float], x: float, y: float) -> float:
    """Return the squared distance of a place from a point [m2]."""
    dx, dy = point[0] - x, point[1] - y
    return dx * dx + dy * dy


def _is_straight(points: FloatArray, headings: FloatArray, length: float) -> bool:
    """Whether points lie on one line, as far apart as they ought to."""
    along = np.linspace(0.0, length, len(points))[:, None] * [math.cos(headings[0]), math.sin(headings[0])]
    return bool((headings == headings[0]).all() and np.abs(points - points[0] - along).max() < STRAIGHT)


def progress(path: Path, x: FloatArray, y: FloatArray, heading: FloatArray) -> FloatArray:
    """Project a whole track on its route.

    Where the route passes a place twice (both directions of a leg), the heading tells which is meant. A vehicle that
    drives forward never loses ground, so sideways motion and corner cutting cannot move it back.

    Args:
        x: Positions (n,) [m].
        y: Positions (n,) [m].
        heading: Headings (n,) [rad].

    Returns:
        Arc length (n,) that never falls [m].
    """
    (px, py), (ux, uy) = path.axes, path.directions
    # Squared distance, but for what is the same at all points of the path.
    square = path._squares - 2 * (np.column_stack((x, y)) @ path.axes)
    towards = np.column_stack((np.cos(heading), np.sin(heading))) @ path.directions
    square[towards < math.cos(math.pi / 3)] += 1e6
    nearest = square.argmin(axis=1)
    # Linear refinement: how far past the nearest point, along the path there.
    along = ux[nearest] * (x - px[nearest]) + uy[nearest] * (y - py[nearest])
    inner = (nearest > 0) & (nearest < len(px) - 1)
    along = np.where(inner, np.clip(along, -path.spacing / 2, path.spacing / 2), along)
    return np.asarray(np.maximum.accumulate(nearest * path.spacing + along))
