"""A way through the road as a polyline, measured by arc length."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from codriving.geometry.curve import FloatArray

_BEHIND, _AHEAD = 5.0, 30.0
"""How far around the expected place a projection looks [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class Path:
    """A centre line sampled uniformly by arc length.

    Attributes:
        points: Points of the centre line (n, 2) [m], n at least 2.
        headings: Unwrapped headings at the points (n,) [rad].
        length: Arc length of the whole path [m].
    """

    points: FloatArray
    headings: FloatArray
    length: float

    @property
    def spacing(self) -> float:
        """Arc length between two points [m]."""
        return self.length / (len(self.points) - 1)

    @property
    def arc_lengths(self) -> FloatArray:
        """Arc length of every point (n,) [m]."""
        return np.linspace(0.0, self.length, len(self.points))

    def position(self, s: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Return x and y [m] at arc length s [m]; the path goes straight on before its start and past its end.

        Args:
            s: Arc length, a number or an array of any shape [m].
        """
        s = np.asarray(s, dtype=np.float64)
        inside = np.clip(s, 0.0, self.length)
        k = np.minimum((inside / self.spacing).astype(np.intp), len(self.points) - 2)
        t = inside / self.spacing - k
        x, y = self.points[:, 0], self.points[:, 1]
        overshoot = s - inside
        heading = np.where(overshoot < 0, self.headings[0], self.headings[-1])
        return (
            x[k] + t * (x[k + 1] - x[k]) + overshoot * np.cos(heading),
            y[k] + t * (y[k + 1] - y[k]) + overshoot * np.sin(heading),
        )

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
        if near is not None:
            first = min(max(math.floor((near - _BEHIND) / self.spacing), 0), last - 2)
            last = min(max(math.ceil((near + _AHEAD) / self.spacing) + 1, 2), last)
        offset = self.points[first:last] - (x, y)
        return self.project_at(first + int(np.einsum("ij,ij->i", offset, offset).argmin()), x, y)

    def project_at(self, k: int, x: float, y: float) -> tuple[float, float]:
        """Return arc length and lateral offset [m] of a point whose nearest path point is the k-th."""
        last = len(self.points) - 1
        if k in (0, last):
            cos, sin = math.cos(self.headings[k]), math.sin(self.headings[k])
            dx, dy = x - float(self.points[k, 0]), y - float(self.points[k, 1])
            along = dx * cos + dy * sin
            if along < 0 if k == 0 else along > 0:
                return (self.length if k else 0.0) + along, cos * dy - sin * dx
        options = [self._on_segment(j, x, y) for j in (k - 1, k) if 0 <= j < last]
        _, s, lateral = min(options)
        return s, lateral

    def _on_segment(self, k: int, x: float, y: float) -> tuple[float, float, float]:
        """Return squared distance, arc length and lateral offset against the k-th segment."""
        (x0, y0), (x1, y1) = self.points[k].tolist(), self.points[k + 1].tolist()
        dx, dy, px, py = x1 - x0, y1 - y0, x - x0, y - y0
        square = dx * dx + dy * dy
        t = min(max((px * dx + py * dy) / square, 0.0), 1.0)
        distance = (px - t * dx) ** 2 + (py - t * dy) ** 2
        side = dx * py - dy * px
        return distance, (k + t) * self.spacing, math.copysign(math.sqrt(distance), side)
