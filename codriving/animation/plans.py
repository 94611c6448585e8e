"""The routes that CAVs plan: a thin line ahead of each, up to its goal or the end of what is near."""

import numpy as np

from codriving.animation.canvas import Canvas
from codriving.animation.moment import Body
from codriving.animation.style import BLUE
from codriving.animation.window import Points, Window
from codriving.geometry.road_map import RoadMap

_AHEAD = 70.0
"""How far a plan is shown [m]."""

_STEP = 2.0
"""Distance between two points of a plan [m]."""


def way_ahead(road_map: RoadMap, body: Body) -> Points | None:
    """Return the way that a vehicle plans to drive next.

    Returns:
        Points (n, 2) [m], or None if it is not known or has been driven.
    """
    path = road_map.paths.get(body.route or "")
    if path is None or body.route is None:
        return None
    s, lateral = path.project(body.x, body.y)
    end = min(road_map.routes[body.route].goal, s + _AHEAD)
    start = s + body.length / 2
    if end - start < _STEP:
        return None
    along = np.append(np.arange(start, end, _STEP), end)
    x, y = path.position(along)
    heading = path.heading(along)
    # A vehicle beside its way, as in a lane change, comes back to it.
    beside = lateral * np.clip(1 - (along - start) / 25.0, 0.0, 1.0)
    return np.column_stack((x - beside * np.sin(heading), y + beside * np.cos(heading)))


def draw_plan(canvas: Canvas, window: Window, way: Points) -> None:
    """Draw a way with an arrow at its end.

    Args:
        way: Points (n, 2) [m].
    """
    if not window.sees(way, 10.0):
        return
    placed = window.place(way)
    canvas.line(placed, BLUE, 1.6)
    along = placed[-1] - placed[-2]
    along = along / max(float(np.hypot(*along)), 1e-9)
    across = np.array([-along[1], along[0]])
    tip = placed[-1]
    canvas.polygon([tip + 4 * along, tip - 6 * along + 4.5 * across, tip - 6 * along - 4.5 * across], BLUE)
