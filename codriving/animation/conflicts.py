"""Open conflicts: a mark where two vehicles would meet, and the ways of the two to it, by severity."""

from collections.abc import Mapping, Sequence

import numpy as np

from codriving.animation.canvas import Canvas
from codriving.animation.content import DrawnConflict, DrawnVehicle
from codriving.animation.style import BAND, HALO, PAPER, SEVERITIES
from codriving.animation.window import Area, FreeSpace, Points, Window, beside
from codriving.datatypes import Kind, Severity
from codriving.geometry import Path, RoadMap

_RANK = {severity: rank for rank, severity in enumerate(SEVERITIES)}


def worst_first(meetings: Sequence[DrawnConflict]) -> list[DrawnConflict]:
    """Return the conflicts that are drawn, the most severe first."""
    shown = [m for m in meetings if m.severity in _RANK]
    return sorted(shown, key=lambda m: (_RANK[m.severity], m.dttcp, m.one, m.other))


def pressing(meetings: Sequence[DrawnConflict], bodies: Mapping[str, DrawnVehicle]) -> list[DrawnConflict]:
    """Return the conflicts that get lines and words: the most severe of each CAV."""
    done, chosen = set[str](), []
    for meeting in meetings:
        cavs = {name for name in (meeting.one, meeting.other) if bodies[name].kind is Kind.CAV}
        if cavs - done:
            chosen.append(meeting)
            done |= cavs
    return chosen


class ConflictLayer:
    """The conflicts of a frame."""

    def __init__(self, meetings: Sequence[DrawnConflict], bodies: Sequence[DrawnVehicle], road_map: RoadMap) -> None:
        self._bodies = {body.id: body for body in bodies}
        self._shown = worst_first([m for m in meetings if m.one in self._bodies and m.other in self._bodies])
        self._pressing = pressing(self._shown, self._bodies)
        self._shapes = {id(m): conflict_lines(m, self._bodies, road_map) for m in self._shown}

    def lines(self, canvas: Canvas, window: Window) -> None:
        """Draw the ways of the two to where they meet, for those conflicts that press, the most severe on top."""
        for meeting in reversed(self._pressing):
            stroke = SEVERITIES[meeting.severity]
            for line in self._shapes[id(meeting)][1]:
                if window.sees(line, 5.0):
                    canvas.line(window.place(line), stroke.colour + BAND, stroke.width, stroke.dash)

    def marks(self, canvas: Canvas, window: Window) -> None:
        """Draw a mark for each, the most severe on top."""
        for meeting in reversed(self._shown):
            place = self._shapes[id(meeting)][0]
            if window.sees([place], 20.0):
                x, y = window.place(place)
                mark(canvas, float(x), float(y), 1.0, meeting.severity, meeting.certain)

    def claim(self, window: Window, space: FreeSpace) -> None:
        """Keep words off the marks."""
        for meeting in self._shown:
            space.take(self._box(window, meeting))

    def _box(self, window: Window, meeting: DrawnConflict) -> Area:
        x, y = (float(v) for v in window.place(self._shapes[id(meeting)][0]))
        half = SEVERITIES[meeting.severity].mark
        return Area(x - half, y - half, 2 * half, 2 * half)

    def label(self, canvas: Canvas, window: Window, space: FreeSpace) -> None:
        """Write at the marks of those that press how severe they are."""
        for meeting in self._pressing:
            if window.owns(self._shapes[id(meeting)][0]):
                stroke = SEVERITIES[meeting.severity]
                words = f"{stroke.word} {meeting.dttcp:.1f} s"
                spot = space.find(beside(self._box(window, meeting), canvas.width_of(words, 11, bold=True) + 4, 15.0))
                canvas.text(spot.left + 2, spot.centre[1], words, 11, stroke.colour, bold=True, halo=HALO)


def conflict_lines(
    meeting: DrawnConflict, bodies: Mapping[str, DrawnVehicle], road_map: RoadMap
) -> tuple[Points, list[Points]]:
    """Return where two vehicles would meet, and the ways of the two until there."""
    pair = bodies[meeting.one], bodies[meeting.other]
    ends = np.array([(body.x, body.y) for body in pair])
    middle = ends.mean(axis=0)
    if meeting.ways is None:
        return middle, [np.array([end, middle]) for end in ends]
    paths = [road_map.paths[route] for route, _ in meeting.ways]
    here = [path.project(body.x, body.y)[0] for path, body in zip(paths, pair, strict=True)]
    goals = [s for _, s in meeting.ways]
    if any(s < goal for s, goal in zip(here, goals, strict=True)):
        lines = [
            _stretch(path, s + body.length / 2, goal)
            for path, s, goal, body in zip(paths, here, goals, pair, strict=True)
            if s + body.length / 2 < goal
        ]
        return np.array(paths[0].position(goals[0]), dtype=float), lines
    # Both have come together already: what is left is the way from the one to the other.
    first, last = sorted((here[0], paths[0].project(*ends[1])[0]))
    return np.array(paths[0].position((first + last) / 2), dtype=float), [_stretch(paths[0], first, last)]


def _stretch(path: Path, start: float, end: float) -> Points:
    return np.column_stack(path.position(np.linspace(start, end, max(2, round((end - start) / 2.0) + 1))))


def mark(canvas: Canvas, x: float, y: float, size: float, severity: Severity, certain: bool) -> None:
    """Draw a mark."""
    colour = SEVERITIES[severity].colour
    inside, rim = (colour, PAPER) if certain else (PAPER, colour)
    half = size * SEVERITIES[severity].mark
    canvas.polygon([(x, y - half), (x + half, y), (x, y + half), (x - half, y)], inside, rim, 1.5 * size)
    if severity is Severity.SERIOUS:
        canvas.text(x, y, "!", round(12 * size), rim, bold=True, anchor=0.5)
