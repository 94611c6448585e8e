"""One frame put together: road, plans, conflicts, vehicles, names, panel, banner."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from codriving.animation.banner import draw_banner
from codriving.animation.bodies import draw_bodies, draw_names
from codriving.animation.canvas import Canvas
from codriving.animation.glyphs import target
from codriving.animation.ground import Ground
from codriving.animation.meetings import Meetings
from codriving.animation.moment import Moment
from codriving.animation.panel import Panel
from codriving.animation.plans import draw_plan, way_ahead
from codriving.animation.sizes import PANEL
from codriving.animation.space import Space
from codriving.animation.style import GROUND
from codriving.animation.window import Area, Window
from codriving.datatypes.vehicle import Kind
from codriving.geometry.road_map import RoadMap


class Picture:
    """Draws the moments of one episode.

    Args:
        width: Width of a frame [px].
        height: Height of a frame [px].

    Attributes:
        view: The part of a frame that shows the road [px].
    """

    def __init__(
        self,
        road_map: RoadMap,
        cavs: tuple[str, ...],
        title: tuple[str, str],
        width: float,
        height: float,
        scale: float,
        panel: bool = True,
    ) -> None:
        self.road_map, self.cavs = road_map, cavs
        self._canvas = Canvas(width, height, scale)
        self.view = Area(0.0, 0.0, width - (PANEL if panel else 0.0), height)
        self._panel = Panel(Area(self.view.width, 0.0, PANEL, height), title, cavs) if panel else None
        self._ground = Ground(road_map)
        self._cached: tuple[tuple[Window, ...], NDArray[np.uint8]] | None = None

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns of a frame."""
        rows, columns = self._canvas.pixels.shape[:2]
        return rows, columns

    def draw(self, moment: Moment, windows: tuple[Window, ...]) -> NDArray[np.uint8]:
        """Draw a frame.

        Returns:
            The frame (rows, columns, 4), RGBA; valid until the next one is drawn.
        """
        canvas = self._canvas
        self._lay_ground(windows)
        meetings = Meetings(moment.meetings, moment.bodies, self.road_map)
        ways = [way for b in moment.bodies if b.kind is Kind.CAV and (way := way_ahead(self.road_map, b)) is not None]
        for window in windows:
            a = window.area
            with canvas.within(a.left, a.top, a.width, a.height):
                meetings.lines(canvas, window)
                for way in ways:
                    draw_plan(canvas, window, way)
                meetings.marks(canvas, window)
                draw_bodies(canvas, window, moment.bodies)
                _veil(canvas, window)
                space = Space(a)
                meetings.claim(window, space)
                draw_names(canvas, window, space, moment)
                meetings.label(canvas, window, space)
                self._crash(window, moment)
        if moment.outcome is not None:
            draw_banner(canvas, self.view, moment.outcome, len(self.cavs))
        if self._panel is not None:
            self._panel.draw(canvas, moment)
        return canvas.pixels

    def rgb(self, moment: Moment, windows: tuple[Window, ...]) -> NDArray[np.uint8]:
        """Draw a frame that may be kept.

        Returns:
            The frame (rows, columns, 3), RGB.
        """
        from PIL import Image

        # Pillow drops the opacity several times faster than slicing does.
        return np.array(Image.fromarray(self.draw(moment, windows)).convert("RGB"))

    def _lay_ground(self, windows: tuple[Window, ...]) -> None:
        """Draw what does not move, or take it from the last frame if the view has not moved either."""
        canvas = self._canvas
        if self._cached is not None and self._cached[0] == windows:
            np.copyto(canvas.pixels, self._cached[1])
            return
        canvas.fill(GROUND)
        self._ground.draw(canvas, windows)
        self._cached = (windows, canvas.pixels.copy())

    def _crash(self, window: Window, moment: Moment) -> None:
        """Mark where a collision was."""
        if moment.outcome is None or moment.outcome.collision is None:
            return
        collision = moment.outcome.collision
        hit: Sequence[tuple[float, float]] = [
            (body.x, body.y) for body in moment.bodies if body.id in (collision.striker, collision.struck)
        ]
        if hit:
            x, y = window.place(np.mean(hit, axis=0))
            target(self._canvas, float(x), float(y), max(4.5 * window.zoom, 20.0))


def _veil(canvas: Canvas, window: Window) -> None:
    """Pale ends of a row say that it goes on in another one."""
    a, core = window.area, window.core
    canvas.box(a.left, a.top, core.left - a.left, a.height, GROUND + "a0")
    canvas.box(core.left + core.width, a.top, a.left + a.width - core.left - core.width, a.height, GROUND + "a0")
