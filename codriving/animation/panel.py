"""The side panel: when it is, who passes first, what every CAV does and why, and what the signs mean."""

from collections.abc import Sequence
from string import ascii_lowercase
from typing import Any

import numpy as np

from codriving.animation.canvas import Canvas, Pixels, shortened, wrapped
from codriving.animation.conflicts import mark, worst_first
from codriving.animation.content import DrawnConflict, DrawnDecision, DrawnVehicle, FrameContent
from codriving.animation.signs import action_glyph, tick
from codriving.animation.style import BAND, BLUE, FAINT, GREEN, HAIR, INK, KINDS, PAPER, SEVERITIES
from codriving.animation.vehicles import draw_plan, draw_vehicles
from codriving.animation.window import Area, Window
from codriving.datatypes import Kind

_FIRST, _LINE, _GAP = 20.0, 16.0, 8.0  # Heights of a card's first line, of its others, and of the space after it [px]

_MOST_LINES = 4
_NAME, _WORD, _SMALL = 14.0, 13.0, 12.0


class Cards:
    """The cards of a panel."""

    def __init__(self, area: Area, cavs: Sequence[str]) -> None:
        room = (area.height - 10) / max(len(cavs), 1)
        self._lines = min(max(int((room - _FIRST - _GAP) / _LINE), 0), _MOST_LINES)
        # A short last resort for many CAVs: the space between cards goes first, then the cards at the end.
        self._height = min(_FIRST + self._lines * _LINE + _GAP, max(room, _FIRST))
        fit = int((area.height - 10) / self._height)
        self._shown = tuple(cavs if len(cavs) <= fit else cavs[: max(fit - 1, 0)])
        self._area, self._more = area, len(cavs) - len(self._shown)

    def draw(self, canvas: Canvas, moment: FrameContent, meetings: Sequence[DrawnConflict]) -> None:
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
                self._words(canvas, y, name, thought, next((m for m in meetings if name in (m.one, m.other)), None))
        if self._more:
            canvas.text(self._area.left, self._middle(len(self._shown)), f"and {self._more} more", _SMALL, FAINT)

    def speeds(self, canvas: Canvas, moment: FrameContent) -> None:
        """Write the speeds, which change with every frame."""
        right = self._area.left + self._area.width
        speeds = {body.id: body.speed for body in moment.bodies}
        for k, name in enumerate(self._shown):
            if name in speeds:
                canvas.text(right, self._middle(k), f"{speeds[name]:.1f} m/s", _WORD, INK, anchor=1.0)

    def _middle(self, k: int) -> float:
        return self._area.top + 10 + k * self._height + _FIRST / 2

    def _words(self, canvas: Canvas, y: float, name: str, thought: DrawnDecision, worst: DrawnConflict | None) -> None:
        """Reason, whom it waits for, its worst conflict; in the lines that there are."""
        left, width, free = self._area.left, self._area.width, self._lines
        waits = "waits for " + ", ".join(thought.waits_for) if thought.waits_for and free > 1 else ""
        conflict = worst if free > 1 + bool(waits) else None
        spare = free - bool(waits) - bool(conflict)
        lines = [(line, FAINT) for line in wrapped(canvas, thought.reason, _SMALL, width, spare)]
        if waits:
            lines.append((shortened(canvas, waits, _SMALL, width), INK))
        y += _FIRST / 2 + _LINE / 2
        for words, colour in lines:
            canvas.text(left, y, words, _SMALL, colour)
            y += _LINE
        if conflict is not None:
            other = conflict.other if conflict.one == name else conflict.one
            mark(canvas, left + 6, y, 0.7, conflict.severity, conflict.certain)
            words = f"{SEVERITIES[conflict.severity].word} conflict with {other}, {conflict.dttcp:.1f} s apart"
            canvas.text(left + 18, y, words, _SMALL, SEVERITIES[conflict.severity].colour)


def _gone(canvas: Canvas, x: float, y: float, name: str, moment: FrameContent) -> None:
    if name not in moment.arrived:
        canvas.text(x + 20, y, "not on the road", _WORD, FAINT)
        return
    time = moment.arrived[name]
    tick(canvas, x + 6, y, 11, GREEN)
    canvas.text(x + 20, y, "arrived" if time is None else f"arrived at {time:.1f} s", _WORD, FAINT)


def natural(name: str) -> tuple[str, int, str]:
    """Order names as people do: ``CAV2`` before ``CAV10``, and ``CAV2a`` before ``CAV10a``."""
    plain = name.rstrip(ascii_lowercase)
    stem = plain.rstrip("0123456789")
    digits = plain[len(stem) :]
    return stem, int(digits) if digits else -1, name


LEGEND = 104.0  # Height of the legend [px]

_LETTERS = 11.0
_ROW = 21.0


def draw_legend(canvas: Canvas, area: Area) -> None:
    """Draw the legend."""
    _rule(canvas, area, area.top)
    left, y = area.left, area.top + 20
    for kind, words in ((Kind.CAV, "CAV"), (Kind.HDV, "human driver")):
        draw_vehicles(canvas, _window(left, y, 4.6), [DrawnVehicle("", kind, 0.0, 0.0, 0.0, 0.0)])
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


_EDGE = 20.0
_HEAD = 64.0  # Height of the title [px]

_PER_ROW, _CHIP, _MOST_ROWS = 5, 21.0, 3


class SidePanel:
    """Draws the panel; what stays from one frame to the next is kept. Without CAVs it shows those on the road."""

    def __init__(self, area: Area, title: tuple[str, str], cavs: Sequence[str]) -> None:
        self._area, self._title, self._cavs = area, title, tuple(cavs)
        self._inner = Area(area.left + _EDGE, area.top, area.width - 2 * _EDGE, area.height)
        self._kept: tuple[Any, Pixels, Cards] | None = None

    def draw(self, canvas: Canvas, moment: FrameContent) -> None:
        """Draw it."""
        a = self._area
        here = tuple((body.id, body.kind) for body in moment.bodies)
        key = (here, moment.thoughts, moment.meetings, moment.order, moment.order_title, moment.arrived, moment.talk)
        if self._kept is None or self._kept[0] != key:
            cards = self._still(canvas, moment)
            self._kept = (key, canvas.part(a.left, a.top, a.width, a.height).copy(), cards)
        else:
            np.copyto(canvas.part(a.left, a.top, a.width, a.height), self._kept[1])
        right = self._inner.left + self._inner.width
        canvas.text(right, a.top + 25, f"{moment.time:.1f} s", 24, INK, bold=True, anchor=1.0)
        self._kept[2].speeds(canvas, moment)

    def _still(self, canvas: Canvas, moment: FrameContent) -> Cards:
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
        there = sorted((body.id for body in moment.bodies if body.kind is Kind.CAV), key=natural)
        cards = Cards(Area(inner.left, y, inner.width, bottom - y), self._cavs or there)
        cards.draw(canvas, moment, worst_first(moment.meetings))
        draw_legend(canvas, Area(inner.left, bottom, inner.width, LEGEND))
        return cards

    def _order(self, canvas: Canvas, y: float, moment: FrameContent) -> float:
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
        for words in moment.talk:
            for line in wrapped(canvas, words, _SMALL, inner.width, 2):
                canvas.text(inner.left, y + 6, line, _SMALL, FAINT)
                y += _LINE
        _rule(canvas, inner, y)
        return y


def _rule(canvas: Canvas, area: Area, y: float) -> None:
    canvas.line([(area.left, y), (area.left + area.width, y)], HAIR, 1.0)
