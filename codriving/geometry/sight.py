"""Which places see each other past the buildings beside a road."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from codriving.datatypes import Block
from codriving.geometry.box import BoolArray
from codriving.geometry.curve import FloatArray


class Sight:
    """The buildings of a road, turned so that lines of sight are quickly told; worked out once."""

    def __init__(self, buildings: Sequence[Block]) -> None:
        rows = [(*b.position, b.heading, b.length / 2, b.width / 2) for b in buildings]
        self._x, self._y, heading, *halves = np.array(rows, dtype=np.float64).reshape(-1, 5).T
        self._halves = np.stack(halves)
        self._cos, self._sin = np.cos(heading), np.sin(heading)

    def _inside_coordinates(self, x: ArrayLike, y: ArrayLike) -> FloatArray:
        """Along and across each building, from its centre (2, n, buildings) [m]."""
        dx, dy = (np.asarray(v, dtype=np.float64)[:, None] - c for v, c in ((x, self._x), (y, self._y)))
        return np.stack((dx * self._cos + dy * self._sin, dy * self._cos - dx * self._sin))

    def covers(self, x: ArrayLike, y: ArrayLike, margin: float = 0.0) -> BoolArray:
        """Return which buildings reach over any of some places, or nearer to it than a margin [m] (buildings,)."""
        beyond = np.abs(self._inside_coordinates(x, y)) - self._halves[:, None]
        near = (np.hypot(*np.maximum(beyond, 0.0)) < margin) | (beyond < 0).all(axis=0)
        return np.asarray(near.any(axis=0))

    def hidden(self, x: ArrayLike, y: ArrayLike) -> BoolArray:
        """Return between which of some places [m] a building stands (n, n); a line that only touches one is free.

        A line is followed from one place (0) to the other (1): it runs through a box while it is between both pairs of
        opposite sides (Kay and Kajiya, 1986).
        """
        place = self._inside_coordinates(x, y)
        start, way = place[:, :, None], place[:, None] - place[:, :, None]
        halves = self._halves[:, None, None]
        with np.errstate(divide="ignore", invalid="ignore"):
            one, other = (-halves - start) / way, (halves - start) / way
        enters, leaves = np.minimum(one, other), np.maximum(one, other)
        # Along a side, a line is between the two all the way or nowhere.
        along, between = way == 0, np.abs(start) < halves
        enters = np.where(along, np.where(between, -np.inf, np.inf), enters).max(axis=0)
        leaves = np.where(along, np.where(between, np.inf, -np.inf), leaves).min(axis=0)
        return np.asarray((np.maximum(enters, 0.0) < np.minimum(leaves, 1.0)).any(axis=-1))
