"""Which part of the world is seen where on the frame, how large, and where there is room for words."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Points = NDArray[np.float64]

LARGEST = 12.0  # Beyond this many pixels a metre nothing is gained

MOST_ROWS = 8

GAP = 12.0  # Between two rows [px]

TWICE = 12.0  # How much of the road is seen at the end of one row and again at the beginning of the next, at least [m]


@dataclass(frozen=True, slots=True)
class Area:
    """An upright rectangle of the frame or of the world."""

    left: float
    top: float
    width: float
    height: float

    @property
    def centre(self) -> tuple[float, float]:
        """Its middle."""
        return self.left + self.width / 2, self.top + self.height / 2

    def padded(self, by: float) -> "Area":
        """Return it with a margin all round."""
        return Area(self.left - by, self.top - by, self.width + 2 * by, self.height + 2 * by)


@dataclass(frozen=True, slots=True)
class Window:
    """A part of the frame through which a part of the world is seen."""

    area: Area  # Where on the frame [px]
    x: float  # Point of the world in its middle [m]
    y: float  # Point of the world in its middle [m]
    zoom: float
    turned: bool = False
    # Width of the ends that are seen in the row before and in the next one, too [px].
    dim: tuple[float, float] = (0.0, 0.0)

    @property
    def core(self) -> Area:
        """The part of it that no other row shows [px]."""
        a, (left, right) = self.area, self.dim
        return Area(a.left + left, a.top, a.width - left - right, a.height)

    def place(self, points: ArrayLike) -> Points:
        """Return where points of the world are on the frame."""
        offset = (np.asarray(points, dtype=float) - (self.x, self.y)) * self.zoom
        if self.turned:
            offset = np.stack((offset[..., 1], -offset[..., 0]), axis=-1)
        placed: Points = offset + self.area.centre
        return placed

    @property
    def matrix(self) -> NDArray[np.float64]:
        """The same as a matrix (3, 3) for points that are columns (x, y, 1)."""
        z = self.zoom
        linear = np.array([(0.0, z), (-z, 0.0)] if self.turned else [(z, 0.0), (0.0, z)])
        shift = np.array(self.area.centre) - linear @ (self.x, self.y)
        return np.array([(*linear[0], shift[0]), (*linear[1], shift[1]), (0.0, 0.0, 1.0)])

    def sees(self, points: ArrayLike, margin: float = 0.0) -> bool:
        """Tell whether any of some points of the world, or what lies between them, can be seen."""
        return self._within(self.area.padded(margin), points)

    def owns(self, point: ArrayLike) -> bool:
        """Tell whether a point of the world is seen here and in no other row."""
        return self._within(self.core, point)

    def _within(self, a: Area, points: ArrayLike) -> bool:
        placed = self.place(points).reshape(-1, 2)
        low, high = placed.min(0), placed.max(0)
        return bool(
            high[0] >= a.left and low[0] <= a.left + a.width and high[1] >= a.top and low[1] <= a.top + a.height
        )


def bounds(points: Points) -> Area:
    """Return the smallest upright rectangle around points."""
    low, high = points.min(0), points.max(0)
    return Area(float(low[0]), float(low[1]), float(high[0] - low[0]), float(high[1] - low[1]))


def rows(box: Area, area: Area) -> tuple[Window, ...]:
    """Show a part of the world as large as it gets; one that is long and narrow is cut into rows, as text is."""
    turned = box.height > 1.5 * box.width
    long, wide = (box.height, box.width) if turned else (box.width, box.height)

    def zoom(n: int) -> float:
        along = area.width / (long / n + (TWICE if n > 1 else 0.0))
        return min(along, (area.height - GAP * (n - 1)) / n / wide, LARGEST)

    # More rows must be worth it: a road that nearly fits is easier to follow in one piece.
    n = max(range(1, MOST_ROWS + 1), key=lambda k: zoom(k) * (1.0 if k > 1 else 1.3))
    height = min((area.height - GAP * (n - 1)) / n, wide * zoom(n)) if n > 1 else area.height
    step = height + (area.height - n * height) / max(n - 1, 1) if n > 1 else 0.0
    windows = []
    # A point in two rows belongs to the one whose half of the common part it is in.
    shared = (area.width - long / n * zoom(n)) / 2 if n > 1 else 0.0
    for k in range(n):
        middle = (box.top if turned else box.left) + (k + 0.5) * long / n
        x, y = (box.centre[0], middle) if turned else (middle, box.centre[1])
        dim = (shared if k else 0.0, shared if k < n - 1 else 0.0)
        windows.append(Window(Area(area.left, area.top + k * step, area.width, height), x, y, zoom(n), turned, dim))
    return tuple(windows)


class FreeSpace:
    """What is taken of a part of the frame."""

    def __init__(self, frame: Area) -> None:
        self._frame = frame
        self._taken: list[Area] = []

    def take(self, area: Area) -> None:
        """Let nothing be written here, if it can be helped."""
        self._taken.append(area)

    def find(self, options: Sequence[Area]) -> Area:
        """Take the first place that covers nothing, or the one that covers least."""
        best, least = self._inside(options[0]), float("inf")
        for option in options:
            place = self._inside(option)
            cost = sum(overlap(place, other) for other in self._taken)
            if cost < least:
                best, least = place, cost
            if cost == 0:
                break
        self._taken.append(best)
        return best

    def _inside(self, area: Area) -> Area:
        frame = self._frame
        left = max(min(area.left, frame.left + frame.width - area.width - 2), frame.left + 2)
        top = max(min(area.top, frame.top + frame.height - area.height - 2), frame.top + 2)
        return Area(left, top, area.width, area.height)


def overlap(a: Area, b: Area) -> float:
    """Return how much two areas have in common [px²]."""
    across = min(a.left + a.width, b.left + b.width) - max(a.left, b.left)
    return max(across, 0.0) * max(min(a.top + a.height, b.top + b.height) - max(a.top, b.top), 0.0)


def beside(own: Area, width: float, height: float) -> list[Area]:
    """Return the places around something, first those where people look first."""
    (x, y), right, bottom = own.centre, own.left + own.width, own.top + own.height
    over = [Area(x - width / 2, own.top - height - 1, width, height), Area(x - width / 2, bottom + 1, width, height)]
    sides = [Area(right + 3, y - height / 2, width, height), Area(own.left - width - 3, y - height / 2, width, height)]
    further = [
        Area(left, top, width, height)
        for top in (own.top - 2 * height - 1, bottom + height + 1)
        for left in (x - width / 2, right + 3, own.left - width - 3)
    ]
    # What stands upright on the frame leaves its sides free.
    return [*(sides + over if own.height > own.width else over + sides), *further]
