"""What each CAV does: one card a CAV, with as many words as there is room for."""

from collections.abc import Sequence

from codriving.animation.canvas import Canvas
from codriving.animation.glyphs import action_glyph, tick
from codriving.animation.meetings import mark
from codriving.animation.moment import Meeting, Moment, Thought
from codriving.animation.style import BLUE, FAINT, GREEN, INK, SEVERITIES
from codriving.animation.window import Area
from codriving.animation.words import shortened, wrapped

_HEAD, _LINE, _GAP = 20.0, 16.0, 8.0
"""Heights of a card's first line, of its others, and of the space after it [px]."""

_MOST_LINES = 4
_NAME, _WORD, _SMALL = 14.0, 13.0, 12.0


class Cards:
    """The cards of a panel.

    Args:
        area: Where on the frame [px].
    """

    def __init__(self, area: Area, cavs: Sequence[str]) -> None:
        room = (area.height - 10) / max(len(cavs), 1)
        self._lines = min(max(int((room - _HEAD - _GAP) / _LINE), 0), _MOST_LINES)
        # A short last resort for many CAVs: the space between cards goes first, then the cards at the end.
        self._height = min(_HEAD + self._lines * _LINE + _GAP, max(room, _HEAD))
        fit = int((area.height - 10) / self._height)
        self._shown = tuple(cavs if len(cavs) <= fit else cavs[: max(fit - 1, 0)])
        self._area, self._more = area, len(cavs) - len(self._shown)

    def draw(self, canvas: Canvas, moment: Moment, meetings: Sequence[Meeting]) -> None:
        """Draw all that does not change with every frame."""
        here = {body.id for body in moment.bodies}
        for k, name in enumerate(self._shown):
            left, y = self._area.left, self._middle(k)
            canvas.text(left, y, name, _NAME, BLUE if name in here else FAINT, bold=True)
            start = left + max(canvas.width_of(name, _NAME, bold=True), 44) + 16
            thought = moment.thoughts.get(name)
            if name not in here:
                _gone(canvas, start, y, name, moment)
            elif thought is not None:
                if thought.action:
                    action_glyph(canvas, thought.action, start + 6, y, 12.0)
                    canvas.text(start + 20, y, thought.action.value, _WORD, INK, bold=True)
                worst = next((m for m in meetings if name in (m.one, m.other)), None)
                self._words(canvas, y, name, thought, worst)
        if self._more:
            canvas.text(self._area.left, self._middle(len(self._shown)), f"and {self._more} more", _SMALL, FAINT)

    def speeds(self, canvas: Canvas, moment: Moment) -> None:
        """Write the speeds, which change with every frame."""
        right = self._area.left + self._area.width
        speeds = {body.id: body.speed for body in moment.bodies}
        for k, name in enumerate(self._shown):
            if name in speeds:
                canvas.text(right, self._middle(k), f"{speeds[name]:.1f} m/s", _WORD, INK, anchor=1.0)

    def _middle(self, k: int) -> float:
        return self._area.top + 10 + k * self._height + _HEAD / 2

    def _words(self, canvas: Canvas, y: float, name: str, thought: Thought, worst: Meeting | None) -> None:
        """Reason, whom it waits for, its worst conflict; in the lines that there are."""
        left, width, free = self._area.left, self._area.width, self._lines
        waits = "waits for " + ", ".join(thought.waits_for) if thought.waits_for and free > 1 else ""
        conflict = worst if free > 1 + bool(waits) else None
        spare = free - bool(waits) - bool(conflict)
        lines = [(line, FAINT) for line in wrapped(canvas, thought.reason, _SMALL, width, spare)]
        if waits:
            lines.append((shortened(canvas, waits, _SMALL, width), INK))
        y += _HEAD / 2 + _LINE / 2
        for words, colour in lines:
            canvas.text(left, y, words, _SMALL, colour)
            y += _LINE
        if conflict is not None:
            other = conflict.other if conflict.one == name else conflict.one
            mark(canvas, left + 6, y, 0.7, conflict.severity, conflict.certain)
            words = f"{SEVERITIES[conflict.severity].word} conflict with {other}, {conflict.dttcp:.1f} s apart"
            canvas.text(left + 18, y, words, _SMALL, SEVERITIES[conflict.severity].colour)


def _gone(canvas: Canvas, x: float, y: float, name: str, moment: Moment) -> None:
    if name not in moment.arrived:
        canvas.text(x + 20, y, "not on the road", _WORD, FAINT)
        return
    time = moment.arrived[name]
    tick(canvas, x + 6, y, 11, GREEN)
    canvas.text(x + 20, y, "arrived" if time is None else f"arrived at {time:.1f} s", _WORD, FAINT)


def natural(name: str) -> tuple[str, int, str]:
    """Order names as people do: ``CAV2`` before ``CAV10``."""
    stem = name.rstrip("0123456789")
    digits = name[len(stem) :]
    return stem, int(digits) if digits else -1, name
