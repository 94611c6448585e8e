"""Small signs: one for each action, told apart by shape as well as by colour; and those of the ends."""

import numpy as np

from codriving.animation.canvas import Canvas
from codriving.animation.style import ACTIONS, PAPER, VERMILION
from codriving.datatypes import Action

_UP = np.array([(-0.5, 0.1), (0.0, -0.4), (0.5, 0.1)])
_LEFT = np.array([(0.5, 0.0), (-0.5, 0.0), (-0.1, -0.4), (-0.5, 0.0), (-0.1, 0.4)])
_BAR = np.array([(-0.5, 0.0), (0.5, 0.0)])
_DOWN, _RIGHT = _UP * (1, -1), _LEFT * (-1, 1)
_LOW = np.array([0.0, 0.45])

# Lines of each sign, as parts of its size.
SIGNS = {
    Action.FASTER: (_UP, _UP + _LOW),
    Action.SLOWER: (_DOWN, _DOWN - _LOW),
    Action.IDLE: (_BAR - _LOW / 2, _BAR + _LOW / 2),
    Action.HOLD: (_BAR,),
    Action.LANE_LEFT: (_LEFT,),
    Action.LANE_RIGHT: (_RIGHT,),
}


def action_glyph(canvas: Canvas, action: Action, x: float, y: float, size: float) -> None:
    """Draw the sign of an action."""
    for colour, extra in ((PAPER, 2.0), (ACTIONS[action], 0.0)):
        for line in SIGNS[action]:
            canvas.line(line * size + (x, y), colour, max(size / 5, 1.5) + extra)


def tick(canvas: Canvas, x: float, y: float, size: float, colour: str) -> None:
    """Draw the sign of success."""
    canvas.line(np.array([(-0.45, 0.0), (-0.1, 0.35), (0.5, -0.4)]) * size + (x, y), colour, size / 5)


def target(canvas: Canvas, x: float, y: float, radius: float) -> None:
    """Draw a ring with four ticks around something, which stays in sight."""
    angles = np.linspace(0.0, 2 * np.pi, 49)
    ring = np.column_stack((np.cos(angles), np.sin(angles)))
    for colour, width in ((PAPER, 7.0), (VERMILION, 4.0)):
        canvas.line(ring * radius + (x, y), colour, width)
        for way in ring[6:48:12]:
            canvas.line(way * np.array([[radius], [radius * 1.5]]) + (x, y), colour, width)


def cross(canvas: Canvas, x: float, y: float, size: float, colour: str = VERMILION) -> None:
    """Draw the sign of failure."""
    arm = np.array([(-0.4, -0.4), (0.4, 0.4)])
    for line in (arm, arm * (1, -1)):
        canvas.line(line * size + (x, y), colour, size / 5)
