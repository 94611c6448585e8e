"""What stands in a driver's way: the nearest body on the route, also one that is crossing it."""

import math
from collections.abc import Sequence

import numpy as np
from highway_env.vehicle.objects import RoadObject

from codriving.environment.traffic.on_way import OnWay

BODY_MARGIN = 0.6
"""Lateral room that a driver wants beside a body before it counts as out of the way [m]."""

LARGE = 8.0
"""Longer bodies may be in the way even if their centre is not near it [m]."""


def body_ahead(driver: OnWay, others: Sequence[RoadObject], sight: float) -> tuple[RoadObject | None, float]:
    """Find the nearest body on the route of a driver.

    Args:
        sight: How far the driver looks [m].

    Returns:
        The body, or None, and the free distance to it [m].
    """
    way, end = driver.way, len(driver.way.points) - 2
    first = _row((driver.s - driver.LENGTH) / way.spacing, end)
    last = _row((driver.s + sight) / way.spacing, end)
    # The quick look must leave out nobody who could be in the way; it doesn't know large bodies, other lanes than that
    # of the route, nor what lies beyond the end of the route.
    plain = abs(driver.shift) < 0.5 and last < end
    x, y = driver.position.tolist()
    seen = []
    for other in others:
        if other is not driver and other.solid:
            px, py = other.position.tolist()
            if math.hypot(px - x, py - y) < sight and (way.is_near(px, py) or not plain or other.LENGTH > LARGE):
                seen.append((other, px, py))
    best: tuple[RoadObject | None, float] = (None, math.inf)
    if not seen:
        return best
    rows = slice(first, last + 2)
    places = np.array([(px, py) for _, px, py in seen])
    dx, dy = way.x[rows] - places[:, :1], way.y[rows] - places[:, 1:]
    nearest = (dx**2 + dy**2).argmin(axis=1).tolist()
    for (other, px, py), k in zip(seen, nearest, strict=True):
        if 0 < k == last + 1 - first and last < end:
            continue
        gap = _gap(driver, other, px, py, first + k)
        if gap < best[1]:
            best = (other, gap)
    return best


def _gap(driver: OnWay, other: RoadObject, x: float, y: float, k: int) -> float:
    """Free distance to a body closest to the k-th point of the route [m]; inf if it isn't ahead and in the way."""
    way = driver.way
    dx, dy = x - way.points[k][0], y - way.points[k][1]
    heading = way.headings[k]
    cos, sin = float(np.cos(heading)), float(np.sin(heading))
    across = abs(dy * cos - dx * sin - driver.shift)
    ahead = k * way.spacing + (dx * cos + dy * sin) - driver.s
    if ahead <= 0 or across > _widest(driver, other):
        return math.inf
    half, side = other.LENGTH / 2, other.WIDTH / 2
    turn = other.heading - heading
    c, s = abs(float(np.cos(turn))), abs(float(np.sin(turn)))
    if across > driver.WIDTH / 2 + (s * half + c * side) + BODY_MARGIN:
        return math.inf
    return float(ahead - (c * half + s * side) - driver.LENGTH / 2)


def _widest(driver: OnWay, other: RoadObject) -> float:
    """Largest lateral distance at which a body could be in the way, however it is turned [m]."""
    return float(driver.WIDTH / 2 + other.LENGTH / 2 + other.WIDTH / 2 + BODY_MARGIN)


def _row(row: float, end: int) -> int:
    return int(min(max(row, 0), end))
