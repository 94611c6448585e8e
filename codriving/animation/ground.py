"""What does not move: asphalt, painted lines, goals and what stands on the road."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from codriving.animation.canvas import Canvas, Shape
from codriving.animation.style import ASPHALT, BUILDING, FAINT, GREEN, GROUND, INK, ORANGE, PAINT
from codriving.animation.window import Points, Window
from codriving.datatypes import Lane, Line, Straight
from codriving.geometry import Path, RoadMap, corners, lane_path

_DASH, _SPACE = 3.0, 4.5  # A painted dash and the gap after it [m]

_PAINT = 0.18  # Width of a painted line [m]

_MARKS = 50.0  # Distance between two marks beside a long road [m]


@dataclass(frozen=True, slots=True)
class GroundShapes:
    """What does not move, as polygons and lines [m]."""

    asphalt: tuple[Points, ...]
    full: tuple[Points, ...]  # Painted lines
    striped: tuple[Points, ...]
    goals: tuple[Points, ...]
    blocks: tuple[Points, ...]
    buildings: tuple[Points, ...]


def ground_shapes(road_map: RoadMap) -> GroundShapes:
    """Work out what of a road does not move."""
    ways = [(lane, _way(lane)) for lane in road_map.road.lanes]
    lines = [
        (paint, side(way, sign * lane.width / 2))
        for lane, way in ways
        for sign, paint in zip((-1, 1), lane.lines, strict=True)
    ]
    blocks, buildings = (
        tuple(corners(*b.position, b.heading, b.length, b.width) for b in solid)
        for solid in (road_map.road.blocks, road_map.road.buildings)
    )
    return GroundShapes(
        tuple(np.concatenate((side(way, -lane.width / 2), side(way, lane.width / 2)[::-1])) for lane, way in ways),
        tuple(line for paint, line in lines if paint in (Line.CONTINUOUS, Line.CONTINUOUS_LINE)),
        tuple(line for paint, line in lines if paint is Line.STRIPED),
        tuple(_goals(road_map)),
        blocks,
        buildings,
    )


class Ground:
    """The road as shapes in metres, worked out once."""

    def __init__(self, road_map: RoadMap) -> None:
        shapes = ground_shapes(road_map)
        self._asphalt = Shape(shapes.asphalt, closed=True)
        self._full, self._striped, self._goals = Shape(shapes.full), Shape(shapes.striped), Shape(shapes.goals)
        self._buildings, self._blocks = Shape(shapes.buildings, closed=True), Shape(shapes.blocks, closed=True)
        self._crosses = Shape(block[pair] for block in shapes.blocks for pair in ([0, 2], [1, 3]))

    def draw(self, canvas: Canvas, windows: tuple[Window, ...]) -> None:
        """Draw it through each window."""
        for number, window in enumerate(windows):
            a = window.area
            with canvas.within(a.left, a.top, a.width, a.height):
                canvas.box(a.left, a.top, a.width, a.height, GROUND)
                self._road(canvas, window)
                if len(windows) > 1:
                    _marks(canvas, window, number)
                else:
                    _ruler(canvas, window)

    def _road(self, canvas: Canvas, window: Window) -> None:
        matrix, paint = window.matrix, max(_PAINT * window.zoom, 1.0)
        canvas.shape(self._buildings, matrix, BUILDING, FAINT, 1.0)
        # The rim closes the seams between lanes.
        canvas.shape(self._asphalt, matrix, ASPHALT, ASPHALT, 1.0)
        canvas.shape(self._full, matrix, None, PAINT, paint)
        canvas.shape(self._striped, matrix, None, PAINT, paint, (_DASH * window.zoom, _SPACE * window.zoom))
        canvas.shape(self._goals, matrix, None, GREEN, 3.0, (4.0, 3.0))
        canvas.shape(self._blocks, matrix, INK, ORANGE, 1.5)
        canvas.shape(self._crosses, matrix, None, ORANGE, 1.5)


def side(way: Path, offset: float) -> Points:
    """Return the line that runs beside a way."""
    points: Points = way.points + offset * np.column_stack((-np.sin(way.headings), np.cos(way.headings)))
    return points


def _way(lane: Lane) -> Path:
    """The centre line, with no more points than it takes."""
    if isinstance(lane.shape, Straight):
        return lane_path(lane, spacing=float(np.hypot(*np.subtract(lane.shape.end, lane.shape.start))))
    return lane_path(lane, spacing=1.0)


def _goals(road_map: RoadMap) -> Iterator[Points]:
    """A line across the road at each place of arrival."""
    seen = set()
    for route in road_map.road.routes:
        path, width = road_map.paths[route.id], road_map.lanes[route.lanes[-1]].width
        x, y = (float(v) for v in path.position(route.goal))
        key = (round(x), round(y))
        if key not in seen:
            seen.add(key)
            heading = float(path.heading(route.goal))
            half_x, half_y = -np.sin(heading) * width / 2, np.cos(heading) * width / 2
            yield np.array([(x - half_x, y - half_y), (x + half_x, y + half_y)])


def _marks(canvas: Canvas, window: Window, number: int) -> None:
    """Write the place along a long road under it, every 50 m."""
    middle = window.y if window.turned else window.x
    half = window.area.width / window.zoom / 2
    low = window.area.top + window.area.height
    for at in np.arange(np.ceil((middle - half) / _MARKS), np.floor((middle + half) / _MARKS) + 1) * _MARKS:
        x = window.area.centre[0] + (at - middle) * window.zoom
        canvas.line([(x, low - 5), (x, low)], FAINT, 1.0)
        canvas.text(x + 4, low - 6, f"{at + 0.0:g} m", 10, FAINT)


def _ruler(canvas: Canvas, window: Window) -> None:
    """Draw a ruler in the corner."""
    length = next(v for v in (50.0, 20.0, 10.0, 5.0, 2.0, 1.0) if v * window.zoom <= 130 or v == 1.0)
    x, y = window.area.left + 16, window.area.top + window.area.height - 16
    end = x + length * window.zoom
    for a, b in pairwise([(x, y - 4), (x, y), (end, y), (end, y - 4)]):
        canvas.line([a, b], FAINT, 1.5)
    canvas.text(end + 8, y - 2, f"{length:g} m", 11, FAINT)
