"""How far along its route a recorded vehicle was, row by row."""

import math

import numpy as np

from codriving.geometry.curve import FloatArray
from codriving.geometry.path import Path


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
    px, py = path.points.T
    ux, uy = np.cos(path.headings), np.sin(path.headings)
    square = (x[:, None] - px) ** 2 + (y[:, None] - py) ** 2
    towards = np.outer(np.cos(heading), ux) + np.outer(np.sin(heading), uy)
    square[towards < math.cos(math.pi / 3)] += 1e6
    nearest = square.argmin(axis=1)
    # Linear refinement: how far past the nearest point, along the path there.
    along = ux[nearest] * (x - px[nearest]) + uy[nearest] * (y - py[nearest])
    inner = (nearest > 0) & (nearest < len(px) - 1)
    along = np.where(inner, np.clip(along, -path.spacing / 2, path.spacing / 2), along)
    result: FloatArray = np.maximum.accumulate(nearest * path.spacing + along)
    return result
