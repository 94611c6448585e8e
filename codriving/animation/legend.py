"""What the shapes and lines mean."""

import numpy as np

from codriving.animation.bodies import draw_bodies
from codriving.animation.canvas import Canvas
from codriving.animation.meetings import mark
from codriving.animation.moment import Body
from codriving.animation.plans import draw_plan
from codriving.animation.style import BAND, FAINT, GREEN, HAIR, SEVERITIES
from codriving.animation.window import Area, Window
from codriving.datatypes.vehicle import Kind

LEGEND = 104.0
"""Height of the legend [px]."""

_LETTERS = 11.0
_ROW = 21.0


def draw_legend(canvas: Canvas, area: Area) -> None:
    """Draw the legend.

    Args:
        area: Where on the frame [px].
    """
    canvas.line([(area.left, area.top), (area.left + area.width, area.top)], HAIR, 1.0)
    left, y = area.left, area.top + 20
    for kind, words in ((Kind.CAV, "CAV"), (Kind.HDV, "human driver")):
        draw_bodies(canvas, _window(left, y, 4.6), [Body("", kind, 0.0, 0.0, 0.0, 0.0)])
        canvas.text(left + 34, y, words, _LETTERS, FAINT)
        y += _ROW
    draw_plan(canvas, _window(left, y, 1.0), np.array([(-13.0, 0.0), (4.0, 0.0), (8.0, 0.0)]))
    canvas.text(left + 34, y, "planned route", _LETTERS, FAINT)
    y += _ROW
    canvas.line([(left + 13, y - 7), (left + 13, y + 7)], GREEN, 3.0, (4.0, 3.0))
    canvas.text(left + 34, y, "goal", _LETTERS, FAINT)
    left, y = area.left + area.width * 0.42, area.top + 20
    for severity, stroke in SEVERITIES.items():
        canvas.line([(left, y), (left + 32, y)], stroke.colour + BAND, stroke.width, stroke.dash)
        mark(canvas, left + 16, y, 0.8, severity, True)
        canvas.text(left + 40, y, f"{stroke.word} conflict, {stroke.limit}", _LETTERS, FAINT)
        y += _ROW
    mark(canvas, left + 16, y, 0.8, next(iter(SEVERITIES)), False)
    canvas.text(left + 40, y, "hollow: route is a guess", _LETTERS, FAINT)


def _window(left: float, y: float, zoom: float) -> Window:
    return Window(Area(left, y - 10, 26, 20), 0.0, 0.0, zoom)
