"""Shapes that are prepared once and drawn in one stroke as often as wanted."""

from collections.abc import Iterable

import numpy as np
from matplotlib.path import Path as Outline
from numpy.typing import ArrayLike


class Shape:
    """Lines or areas, any number of them.

    Args:
        parts: Points of each part (n, 2).
    """

    def __init__(self, parts: Iterable[ArrayLike], closed: bool = False) -> None:
        points, codes = [], []
        for part in parts:
            corners = np.asarray(part, dtype=float)
            points.append(np.vstack((corners, corners[:1])) if closed else corners)
            kinds = np.full(len(points[-1]), Outline.LINETO, dtype=Outline.code_type)
            kinds[0] = Outline.MOVETO
            if closed:
                kinds[-1] = Outline.CLOSEPOLY
            codes.append(kinds)
        self.outline = Outline(
            np.concatenate(points) if points else np.empty((0, 2)), np.concatenate(codes) if codes else None
        )
        # Whether points are left out is a setting of the user's otherwise.
        self.outline.should_simplify = False
