"""One frame put together: road, plans, conflicts, vehicles, names, panel, and how it ended."""

import numpy as np
from numpy.typing import NDArray

from codriving.animation.canvas import Canvas, shortened
from codriving.animation.conflicts import ConflictLayer
from codriving.animation.content import FrameContent
from codriving.animation.ground import Ground
from codriving.animation.panel import SidePanel
from codriving.animation.signs import cross, target, tick
from codriving.animation.style import GREEN, GROUND, INK, PANEL, PAPER, VERMILION
from codriving.animation.vehicles import draw_names, draw_plan, draw_vehicles, way_ahead
from codriving.animation.window import Area, FreeSpace, Window
from codriving.datatypes import Ending, Kind, Outcome
from codriving.geometry import RoadMap


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
    if outcome.ending is Ending.COUNTED:
        return f"The window is over {after}; {len(outcome.arrivals)} vehicles have left"
    return f"Error {after}: {outcome.message}"


def draw_banner(canvas: Canvas, area: Area, outcome: Outcome, cavs: int) -> None:
    """Draw the banner."""
    good = outcome.ending in (Ending.SUCCESS, Ending.COUNTED)
    colour = GREEN if good else VERMILION
    words = shortened(canvas, sentence(outcome, cavs), 17, area.width - 120, bold=True)
    width = canvas.width_of(words, 17, bold=True) + 74
    left, top = area.centre[0] - width / 2, area.top + area.height - 70
    canvas.box(left, top, width, 44, PAPER + "f0", colour)
    canvas.box(left, top, 8, 44, colour)
    (tick if good else cross)(canvas, left + 30, top + 22, 18, colour)
    canvas.text(left + 52, top + 22, words, 17, INK, bold=True)


class Picture:
    """Draws the moments of one episode.

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
        self._panel = SidePanel(Area(self.view.width, 0.0, PANEL, height), title, cavs) if panel else None
        self._ground = Ground(road_map)
        self._cached: tuple[tuple[Window, ...], NDArray[np.uint8]] | None = None

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns of a frame."""
        rows, columns = self._canvas.pixels.shape[:2]
        return rows, columns

    def draw(self, moment: FrameContent, windows: tuple[Window, ...]) -> NDArray[np.uint8]:
        """Draw a frame."""
        canvas = self._canvas
        self._lay_ground(windows)
        meetings = ConflictLayer(moment.meetings, moment.bodies, self.road_map)
        ways = [way for b in moment.bodies if b.kind is Kind.CAV and (way := way_ahead(self.road_map, b)) is not None]
        for window in windows:
            a = window.area
            with canvas.within(a.left, a.top, a.width, a.height):
                meetings.lines(canvas, window)
                for way in ways:
                    draw_plan(canvas, window, way)
                meetings.marks(canvas, window)
                draw_vehicles(canvas, window, moment.bodies)
                _veil(canvas, window)
                space = FreeSpace(a)
                meetings.claim(window, space)
                draw_names(canvas, window, space, moment)
                meetings.label(canvas, window, space)
                self._crash(window, moment)
        if moment.outcome is not None:
            draw_banner(canvas, self.view, moment.outcome, len(self.cavs))
        if self._panel is not None:
            self._panel.draw(canvas, moment)
        return canvas.pixels

    def rgb(self, moment: FrameContent, windows: tuple[Window, ...]) -> NDArray[np.uint8]:
        """Draw a frame that may be kept."""
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

    def _crash(self, window: Window, moment: FrameContent) -> None:
        """Mark where a collision was."""
        if moment.outcome is None or moment.outcome.collision is None:
            return
        collision = moment.outcome.collision
        hit = [(body.x, body.y) for body in moment.bodies if body.id in (collision.striker, collision.struck)]
        if hit:
            x, y = window.place(np.mean(hit, axis=0))
            target(self._canvas, float(x), float(y), max(4.5 * window.zoom, 20.0))


def _veil(canvas: Canvas, window: Window) -> None:
    """Pale ends of a row say that it goes on in another one."""
    a, core = window.area, window.core
    canvas.box(a.left, a.top, core.left - a.left, a.height, GROUND + "a0")
    canvas.box(core.left + core.width, a.top, a.left + a.width - core.left - core.width, a.height, GROUND + "a0")
