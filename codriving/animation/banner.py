"""How it ended, across the foot of the road."""

from codriving.animation.canvas import Canvas
from codriving.animation.glyphs import cross, tick
from codriving.animation.style import GREEN, INK, PAPER, VERMILION
from codriving.animation.window import Area
from codriving.animation.words import shortened
from codriving.datatypes.outcome import Ending, Outcome


def sentence(outcome: Outcome, cavs: int) -> str:
    """Say how an episode ended."""
    after = f"after {outcome.time:.1f} s"
    arrived = f"{len(outcome.arrivals)} of {cavs} CAVs arrived"
    if outcome.ending is Ending.SUCCESS:
        return f"Success: all {cavs} CAVs arrived {after}"
    if outcome.ending is Ending.COLLISION and outcome.collision is not None:
        c = outcome.collision
        return f"Collision: {c.striker} ran into {c.struck} {after}; {arrived}"
    if outcome.ending is Ending.TIMEOUT:
        return f"Timeout {after}; {arrived}"
    if outcome.ending is Ending.OFF_ROAD:
        return f"{', '.join(outcome.off_road)} left the road {after}; {arrived}"
    return f"Error {after}: {outcome.message}"


def draw_banner(canvas: Canvas, area: Area, outcome: Outcome, cavs: int) -> None:
    """Draw the banner."""
    good = outcome.ending is Ending.SUCCESS
    colour = GREEN if good else VERMILION
    words = shortened(canvas, sentence(outcome, cavs), 17, area.width - 120, bold=True)
    width = canvas.width_of(words, 17, bold=True) + 74
    left, top = area.centre[0] - width / 2, area.top + area.height - 70
    canvas.box(left, top, width, 44, PAPER + "f0", colour)
    canvas.box(left, top, 8, 44, colour)
    sign = tick if good else cross
    sign(canvas, left + 30, top + 22, 18, colour)
    canvas.text(left + 52, top + 22, words, 17, INK, bold=True)
