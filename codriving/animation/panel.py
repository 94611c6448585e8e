"""The side panel: when it is, who passes first, what every CAV does and why, and what the signs mean."""

from collections.abc import Sequence
from typing import Any

from codriving.animation.canvas import Canvas, Pixels
from codriving.animation.cards import Cards
from codriving.animation.legend import LEGEND, draw_legend
from codriving.animation.meetings import worst_first
from codriving.animation.moment import Moment
from codriving.animation.style import FAINT, HAIR, INK, KINDS, PAPER
from codriving.animation.window import Area
from codriving.animation.words import shortened

_EDGE = 20.0
_HEAD = 64.0
_SMALL = 12.0
_PER_ROW, _CHIP, _MOST_ROWS = 5, 21.0, 3


class Panel:
    """Draws the panel; what stays from one frame to the next is kept.

    Args:
        area: Where on the frame [px].
    """

    def __init__(self, area: Area, title: tuple[str, str], cavs: Sequence[str]) -> None:
        self._area, self._title, self._cavs = area, title, tuple(cavs)
        self._inner = Area(area.left + _EDGE, area.top, area.width - 2 * _EDGE, area.height)
        self._kept: tuple[Any, Pixels, Cards] | None = None

    def draw(self, canvas: Canvas, moment: Moment) -> None:
        """Draw it."""
        a = self._area
        here = tuple((body.id, body.kind) for body in moment.bodies)
        key = (here, moment.thoughts, moment.meetings, moment.order, moment.order_title, moment.arrived)
        if self._kept is None or self._kept[0] != key:
            cards = self._still(canvas, moment)
            self._kept = (key, canvas.copy(a.left, a.top, a.width, a.height), cards)
        else:
            canvas.paste(a.left, a.top, a.width, a.height, self._kept[1])
        right = self._inner.left + self._inner.width
        canvas.text(right, a.top + 25, f"{moment.time:.1f} s", 24, INK, bold=True, anchor=1.0)
        self._kept[2].speeds(canvas, moment)

    def _still(self, canvas: Canvas, moment: Moment) -> Cards:
        """Everything but the numbers that never rest."""
        a, inner = self._area, self._inner
        canvas.box(a.left, a.top, a.width, a.height, PAPER)
        # Within the panel to the last pixel: no more than that is kept.
        canvas.box(a.left, a.top, 1.0, a.height, HAIR)
        room = inner.width - canvas.width_of("000.0 s", 24, bold=True) - 10
        canvas.text(inner.left, a.top + 26, shortened(canvas, self._title[0], 15, room, bold=True), 15, INK, bold=True)
        canvas.text(inner.left, a.top + 50, shortened(canvas, self._title[1], _SMALL, inner.width), _SMALL, FAINT)
        _rule(canvas, inner, a.top + _HEAD)
        y = self._order(canvas, a.top + _HEAD, moment)
        bottom = a.top + a.height - LEGEND
        cards = Cards(Area(inner.left, y, inner.width, bottom - y), self._cavs)
        cards.draw(canvas, moment, worst_first(moment.meetings))
        draw_legend(canvas, Area(inner.left, bottom, inner.width, LEGEND))
        return cards

    def _order(self, canvas: Canvas, y: float, moment: Moment) -> float:
        """The passing order as numbered chips; returns where the rest begins [px]."""
        if not moment.order_title:
            return y
        inner = self._inner
        canvas.text(inner.left, y + 16, moment.order_title, _SMALL, FAINT)
        y += 28
        kinds = {body.id: body.kind for body in moment.bodies}
        sequence = [name for name in moment.order or () if name in kinds][: _PER_ROW * _MOST_ROWS]
        wide = (inner.width - 4 * (_PER_ROW - 1)) / _PER_ROW
        for k, name in enumerate(sequence):
            left, top = inner.left + k % _PER_ROW * (wide + 4), y + k // _PER_ROW * (_CHIP + 4)
            colour = KINDS[kinds[name]]
            canvas.box(left, top, wide, _CHIP, colour + "24", colour)
            canvas.text(left + 6, top + _CHIP / 2, str(k + 1), 10, FAINT)
            words = shortened(canvas, name, 11, wide - 24, bold=True)
            canvas.text(left + wide / 2 + 6, top + _CHIP / 2, words, 11, INK, bold=True, anchor=0.5)
        y += -(-len(sequence) // _PER_ROW) * (_CHIP + 4) + 4
        _rule(canvas, inner, y)
        return y


def _rule(canvas: Canvas, area: Area, y: float) -> None:
    canvas.line([(area.left, y), (area.left + area.width, y)], HAIR, 1.0)
