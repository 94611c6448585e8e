"""Letters as stamps: the fonts that Matplotlib ships, so that every machine writes the same."""

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.colors import to_rgba
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

_CAPITAL = 0.73
"""Height of a capital of DejaVu Sans, as a part of the size."""

Floats = NDArray[np.float32]


@dataclass(frozen=True, slots=True, eq=False)
class Stamp:
    """A line of text in its colours, ready to be pressed onto a sheet.

    Attributes:
        dx: From the beginning of the line to the left edge [px].
        dy: From the middle of the capitals to the upper edge [px].
    """

    ink: Floats
    keep: Floats
    dx: int
    dy: int


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
    """Cut the stamp of a line of text.

    Args:
        halo: Colour of a rim around them, or None.
        rim: Width of the rim [px].
    """
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
