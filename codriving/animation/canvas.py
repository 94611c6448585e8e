"""A sheet to draw on: smooth shapes by Matplotlib's Agg, letters by Pillow, and no display."""

from bisect import bisect_right
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.backends import backend_agg
from matplotlib.colors import to_rgba
from matplotlib.path import Path as Outline
from matplotlib.transforms import Affine2D, Bbox
from numpy.typing import ArrayLike, NDArray
from PIL import Image, ImageDraw, ImageFont

_CAPITAL = 0.73  # Height of a capital of DejaVu Sans, as a part of the size

Floats = NDArray[np.float32]


@dataclass(frozen=True, slots=True, eq=False)
class Stamp:
    """A line of text in its colours, ready to be pressed onto a sheet."""

    ink: Floats
    keep: Floats
    dx: int  # From the beginning of the line to the left edge [px]
    dy: int  # From the middle of the capitals to the upper edge [px]


@lru_cache(maxsize=64)
def _font(size: float, bold: bool) -> ImageFont.FreeTypeFont:
    file = Path(mpl.get_data_path(), "fonts", "ttf", "DejaVuSans-Bold.ttf" if bold else "DejaVuSans.ttf")
    # Another layout engine may be on the machine or not, and gives other pixels.
    return ImageFont.truetype(str(file), size, layout_engine=ImageFont.Layout.BASIC)


@lru_cache(maxsize=8192)
def text_width(words: str, size: float, bold: bool) -> float:
    """Return the width of a line of text [px]."""
    return _font(size, bold).getlength(words)


@lru_cache(maxsize=4096)
def stamp(words: str, size: float, bold: bool, colour: str, halo: str | None, rim: int) -> Stamp:
    """Cut the stamp of a line of text."""
    font = _font(size, bold)
    left, top, right, bottom = font.getbbox(words, stroke_width=rim, anchor="ls")
    x, y = int(np.floor(left)), int(np.floor(top))
    shape = max(int(np.ceil(right)) - x, 1), max(int(np.ceil(bottom)) - y, 1)
    ink, keep = np.zeros((shape[1], shape[0], 3), np.float32), np.ones((shape[1], shape[0], 1), np.float32)
    for paint, width in ((halo, rim), (colour, 0)):
        if paint is not None:
            sheet = Image.new("L", shape)
            ImageDraw.Draw(sheet).text((-x, -y), words, font=font, fill=255, stroke_width=width, anchor="ls")
            *pigment, alpha = to_rgba(paint)
            cover = np.asarray(sheet, dtype=np.float32)[..., None] * np.float32(alpha / 255)
            ink = ink * (1 - cover) + np.array(pigment, dtype=np.float32) * 255 * cover
            keep = keep * (1 - cover)
    return Stamp(ink, keep, x, y + round(_CAPITAL * size / 2))


class Shape:
    """Lines or areas, any number of them."""

    def __init__(self, parts: Iterable[ArrayLike], closed: bool = False) -> None:
        points = [np.asarray(part, dtype=float) for part in parts]
        if closed:
            points = [np.vstack((corners, corners[:1])) for corners in points]
        self.outline = Outline.make_compound_path(*(Outline(part, closed=closed) for part in points))
        # Whether points are left out is a setting of the user's otherwise.
        self.outline.should_simplify = False


Pixels = NDArray[np.uint8]

_RENDERER: Any = backend_agg.RendererAgg  # Its module has no annotations

_DPI = 72  # At which Agg's points are pixels


class Canvas:
    """A sheet of `width` by `height` logical pixels; x grows to the right, y downwards.

    Attributes:
        width: Width [px].
        height: Height [px].
    """

    def __init__(self, width: float, height: float, scale: float = 1.0) -> None:
        self.width, self.height, self.scale = width, height, scale
        columns, rows = round(width * scale), round(height * scale)
        self._agg: Any = _RENDERER(columns, rows, _DPI)
        self.pixels: Pixels = np.asarray(self._agg.buffer_rgba())
        self._words = self.pixels.view(np.uint32)
        self._pen: Any = self._agg.new_gc()
        self._pen.set_snap(False)
        self._pen.set_joinstyle("round")
        # Agg's y grows upwards.
        self._matrix = np.array([[scale, 0, 0], [0, -scale, rows], [0, 0, 1]], dtype=float)
        self._place = Affine2D(self._matrix)
        self._clip: Bbox | None = None

    def fill(self, colour: str) -> None:
        """Paint the whole sheet."""
        self._words[:] = np.array([round(part * 255) for part in to_rgba(colour)], dtype=np.uint8).view(np.uint32)

    def polygon(
        self, points: ArrayLike, fill: str | None = None, stroke: str | None = None, width: float = 1.0
    ) -> None:
        """Draw a closed shape."""
        self.shape(Shape([points], closed=True), None, fill, stroke, width)

    def line(self, points: ArrayLike, colour: str, width: float, dash: Sequence[float] = ()) -> None:
        """Draw a line through points."""
        self.shape(Shape([points]), None, None, colour, width, dash)

    def box(
        self, left: float, top: float, width: float, height: float, fill: str | None, stroke: str | None = None
    ) -> None:
        """Draw an upright rectangle."""
        right, bottom = left + width, top + height
        self.polygon([(left, top), (right, top), (right, bottom), (left, bottom)], fill, stroke)

    def shape(
        self,
        shape: Shape,
        matrix: NDArray[np.float64] | None,
        fill: str | None = None,
        stroke: str | None = None,
        width: float = 1.0,
        dash: Sequence[float] = (),
    ) -> None:
        """Draw a shape that was prepared before."""
        pen = self._pen
        pen.set_clip_rectangle(self._clip)
        pen.set_linewidth(width * self.scale if stroke else 0.0)
        if stroke:
            pen.set_foreground(to_rgba(stroke), isRGBA=True)
            pen.set_capstyle("butt" if dash else "round")
            pen.set_dashes(0, [length * self.scale for length in dash] if dash else None)
        place = self._place if matrix is None else Affine2D(self._matrix @ matrix)
        self._agg.draw_path(pen, shape.outline, place, to_rgba(fill) if fill else None)

    def text(
        self,
        x: float,
        y: float,
        words: str,
        size: float,
        colour: str,
        bold: bool = False,
        anchor: float = 0.0,
        halo: str | None = None,
    ) -> None:
        """Write a line of text."""
        words = " ".join(words.split())
        size, rim = size * self.scale, round(1.8 * self.scale) if halo else 0
        cut = stamp(words, size, bold, colour, halo, rim)
        x0 = round(x * self.scale - anchor * text_width(words, size, bold)) + cut.dx
        y0 = round(y * self.scale) + cut.dy
        low_x, low_y, high_x, high_y = self._bounds()
        x1, y1 = max(x0, low_x), max(y0, low_y)
        x2, y2 = min(x0 + cut.keep.shape[1], high_x), min(y0 + cut.keep.shape[0], high_y)
        if x1 < x2 and y1 < y2:
            part = slice(y1 - y0, y2 - y0), slice(x1 - x0, x2 - x0)
            there = self.pixels[y1:y2, x1:x2, :3]
            there[:] = there * cut.keep[part] + cut.ink[part] + np.float32(0.5)

    def width_of(self, words: str, size: float, bold: bool = False) -> float:
        """Return the width of a line of text [px]."""
        return text_width(" ".join(words.split()), size * self.scale, bold) / self.scale

    def part(self, left: float, top: float, width: float, height: float) -> Pixels:
        """Return the pixels of a part of the canvas, to be copied or written over."""
        s = self.scale
        return self.pixels[round(top * s) : round((top + height) * s), round(left * s) : round((left + width) * s)]

    def _bounds(self) -> tuple[int, int, int, int]:
        rows, columns = self.pixels.shape[:2]
        if self._clip is None:
            return 0, 0, columns, rows
        left, low, right, high = (round(v) for v in self._clip.extents)
        return max(left, 0), max(rows - high, 0), min(right, columns), min(rows - low, rows)

    @contextmanager
    def within(self, left: float, top: float, width: float, height: float) -> Iterator[None]:
        """Draw only inside a rectangle while the block lasts."""
        before, rows, s = self._clip, self.pixels.shape[0], self.scale
        self._clip = Bbox([[left * s, rows - (top + height) * s], [(left + width) * s, rows - top * s]])
        try:
            yield
        finally:
            self._clip = before


def shortened(canvas: Canvas, words: str, size: float, room: float, bold: bool = False) -> str:
    """Cut a text so that it fits into a line, and show that it was cut."""
    words = " ".join(words.split())
    if canvas.width_of(words, size, bold) <= room:
        return words
    cut = [words[:k].rstrip() + "…" for k in range(len(words) + 1)]
    return cut[bisect_right(cut, room, lo=1, key=lambda text: canvas.width_of(text, size, bold)) - 1]


def wrapped(canvas: Canvas, words: str, size: float, room: float, lines: int) -> list[str]:
    """Break a text into at most so many lines; the last is cut if there is more."""
    rest, broken = words.split(), list[str]()
    while rest and len(broken) < lines - 1:
        line = rest.pop(0)
        while rest and canvas.width_of(f"{line} {rest[0]}", size) <= room:
            line += " " + rest.pop(0)
        broken.append(shortened(canvas, line, size, room))
    if rest and lines > 0:
        broken.append(shortened(canvas, " ".join(rest), size, room))
    return broken
