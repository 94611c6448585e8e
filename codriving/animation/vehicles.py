"""Vehicles with their names, and the routes that CAVs plan."""

import math
from collections.abc import Sequence

import numpy as np

from codriving.animation.canvas import Canvas
from codriving.animation.content import DrawnVehicle, FrameContent
from codriving.animation.signs import action_glyph
from codriving.animation.style import BLUE, HALO, INK, KINDS, PAPER
from codriving.animation.window import FreeSpace, Points, Window, beside, bounds
from codriving.datatypes import Kind
from codriving.geometry import RoadMap

_SMALLEST = 15.0  # A vehicle is never drawn shorter [px]; far away it is a symbol

_LETTERS = 12.0  # Size of a name [px]


def draw_vehicles(canvas: Canvas, window: Window, bodies: Sequence[DrawnVehicle]) -> None:
    """Draw vehicles."""
    for body in bodies:
        if not window.sees([(body.x, body.y)], 40.0):
            continue
        colour = KINDS[body.kind]
        if body.kind is Kind.CAV:
            canvas.polygon(_outline(window, body, _CAV), colour, INK, 1.2)
            canvas.polygon(_outline(window, body, _ROOF), "#ffffffd0")
        else:
            canvas.polygon(_outline(window, body, _HDV), PAPER, INK, 3.2)
            canvas.polygon(_outline(window, body, _HDV), None, colour, 2.0)
            canvas.line(_outline(window, body, _GLASS), INK, 1.8)


_CAV = np.array([(0.5, 0.0), (0.28, 0.5), (-0.5, 0.5), (-0.5, -0.5), (0.28, -0.5)])
_ROOF = np.array([(0.30, 0.0), (0.08, 0.26), (0.08, -0.26)])
_HDV = np.array([(0.44, 0.36), (-0.44, 0.36), (-0.44, -0.36), (0.44, -0.36)])
# Outlines in lengths and widths of the vehicle, its front to the right.
_GLASS = np.array([(0.22, 0.30), (0.22, -0.30)])


def _outline(window: Window, body: DrawnVehicle, shape: Points) -> Points:
    along, across = (shape * (body.length, body.width) * max(_SMALLEST / (body.length * window.zoom), 1.0)).T
    cos, sin = math.cos(body.heading), math.sin(body.heading)
    return window.place(np.column_stack((body.x + along * cos - across * sin, body.y + along * sin + across * cos)))


def draw_names(canvas: Canvas, window: Window, space: FreeSpace, moment: FrameContent) -> None:
    """Write at each vehicle who it is, what it does and how fast; on the side where there is room."""
    shown = [body for body in moment.bodies if window.owns((body.x, body.y))]
    boxes = [bounds(_outline(window, body, _CAV)) for body in shown]
    for box in boxes:
        space.take(box)
    for body, box in zip(shown, boxes, strict=True):
        thought = moment.thoughts.get(body.id)
        action = thought.action if thought else None
        name = canvas.width_of(body.id, _LETTERS, bold=True)
        sign = 17.0 if action else 5.0
        # As wide as with the widest digits, so that it does not hop about with the speed.
        width = name + sign + canvas.width_of("00.0" if body.speed >= 9.95 else "0.0", _LETTERS - 1)
        spot = space.find(beside(box, width + 2, _LETTERS + 3))
        x, y = spot.left + 1, spot.centre[1]
        canvas.text(x, y, body.id, _LETTERS, INK, bold=True, halo=HALO)
        if action:
            action_glyph(canvas, action, x + name + 8.5, y, 9.0)
        canvas.text(x + name + sign, y, f"{body.speed:.1f}", _LETTERS - 1, INK, halo=HALO)


_AHEAD = 70.0  # How far a plan is shown [m]

_STEP = 2.0  # Distance between two points of a plan [m]


def way_ahead(road_map: RoadMap, body: DrawnVehicle) -> Points | None:
    """Return the way that a vehicle plans to drive next."""
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
    """Draw a way with an arrow at its end."""
    if not window.sees(way, 10.0):
        return
    placed = window.place(way)
    canvas.line(placed, BLUE, 1.6)
    along = placed[-1] - placed[-2]
    along = along / max(float(np.hypot(*along)), 1e-9)
    across = np.array([-along[1], along[0]])
    tip = placed[-1]
    canvas.polygon([tip + 4 * along, tip - 6 * along + 4.5 * across, tip - 6 * along - 4.5 * across], BLUE)
