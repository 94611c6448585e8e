"""Figures of a page, as SVG that stands in it: words take the colour of the page, in light and in dark."""

import io
import re
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING

from codriving.reports import FIGURES, CellResults, draw_endings, legend_names

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MOST = 12  # Rows in one figure
IN_TABLES = ("rates",)  # Figures whose numbers stand in the tables of a page

INK = "#010203"  # Stands for the colour of the page's words


def figures(rows: Sequence[tuple[str, CellResults]]) -> list[tuple[str, str]]:
    """Draw what there is to draw of some rows.

    Returns:
        Title and SVG of each figure.
    """
    with plain_matplotlib():
        names = legend_names([name for name, _ in rows[:MOST]])
        return _figures([(name, cell) for name, (_, cell) in zip(names, rows, strict=False)])


@contextmanager
def plain_matplotlib() -> Iterator[None]:
    """Draw as Matplotlib is shipped, whatever its user has set; and a name with dollar signs is no formula."""
    import matplotlib

    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        matplotlib.rcParams["text.parse_math"] = False
        yield


def _figures(rows: Sequence[tuple[str, CellResults]]) -> list[tuple[str, str]]:
    found = []
    for name, kind in FIGURES.items():
        if name not in IN_TABLES and kind.there(rows):
            drawn = _drawn(rows, name) if kind.up else _endings(rows)
            found.append((kind.what[0].upper() + kind.what[1:], drawn))
    return found


def _endings(rows: Sequence[tuple[str, CellResults]]) -> str:
    figure, axis = new_figure(0.9 + 0.36 * len(rows))
    draw_endings(axis, rows, range(len(rows)), INK)
    axis.set_xlabel("episodes [%]")
    axis.set_yticks(range(len(rows)), [name for name, _ in rows])
    axis.invert_yaxis()
    return _svg(figure, axis, "endings", len(axis.get_legend_handles_labels()[1]))


def _drawn(rows: Sequence[tuple[str, CellResults]], name: str) -> str:
    figure, axis = new_figure(3.0)
    FIGURES[name].draw(axis, rows, range(len(rows)), INK)
    axis.set(xlabel=FIGURES[name].along, ylabel=FIGURES[name].up)
    return _svg(figure, axis, name, len(rows))


def new_figure(height: float) -> "tuple[Figure, Axes]":
    """Begin a figure as wide as a page, of a height [inch]."""
    from matplotlib import rc_context
    from matplotlib.figure import Figure

    with rc_context({"axes.edgecolor": INK, "axes.labelcolor": INK, "xtick.color": INK, "ytick.color": INK}):
        figure = Figure(figsize=(7.2, height), layout="constrained")
        axis = figure.subplots()
    axis.spines[["top", "right"]].set_visible(False)
    return figure, axis


def _svg(figure: "Figure", axis: "Axes", name: str, entries: int) -> str:
    columns = 1 if max(map(len, axis.get_legend_handles_labels()[1]), default=0) > 30 else min(entries, 4)
    figure.set_figheight(figure.get_figheight() + 0.26 * -(-entries // columns))
    figure.legend(loc="outside lower left", ncols=columns, frameon=False, labelcolor=INK, fontsize=9)
    return _written(figure, name)


def svg_of(figure: "Figure", axes: "Sequence[Axes]", name: str) -> str:
    """Give a figure whose legend has each label once."""
    handles = {label: h for axis in axes for h, label in zip(*axis.get_legend_handles_labels(), strict=True)}
    columns = min(len(handles), 4) or 1
    figure.set_figheight(figure.get_figheight() + 0.26 * -(-len(handles) // columns))
    marks, labels = list(handles.values()), list(handles)
    figure.legend(marks, labels, loc="outside lower left", ncols=columns, frameon=False, labelcolor=INK, fontsize=9)
    return _written(figure, name)


def _written(figure: "Figure", name: str) -> str:
    from matplotlib import rc_context

    out = io.StringIO()
    with (
        rc_context({"svg.fonttype": "none", "svg.hashsalt": name, "text.color": INK, "hatch.linewidth": 0.6}),
        warnings.catch_warnings(),
    ):
        # Its own font lacks most scripts of the world; a browser takes another one.
        warnings.filterwarnings("ignore", r"Glyph \d+", UserWarning)
        figure.savefig(out, format="svg", transparent=True, metadata={"Date": None, "Creator": None})
    return _for_a_page(out.getvalue(), name)


def _for_a_page(text: str, name: str) -> str:
    """Leave out what a page must not hold twice, and say as attributes what a strict page allows no style for."""
    text = text[text.index("<svg") :]
    text = re.sub(r"\s*<metadata>.*?</metadata>|\s*<style[^>]*>.*?</style>", "", text, flags=re.S)
    used = set(re.findall(r'(?:href="#|url\(#)([^")]+)', text))
    text = re.sub(r' id="([^"]+)"', lambda m: f' id="{name}-{m[1]}"' if m[1] in used else "", text)
    text = re.sub(r'(href="#|url\(#)', rf"\g<1>{name}-", text)
    text = re.sub(r' style="([^"]*)"', lambda m: _attributes(m[1]), text)
    text = text.replace(INK, "currentColor").replace("xlink:href", "href")
    size = re.search(r' width="([\d.]+)pt" height="([\d.]+)pt"', text)
    text = text.replace(size[0], "", 1) if size else text
    return text.replace("<svg ", '<svg stroke-linejoin="round" stroke-linecap="butt" ', 1).strip()


def _attributes(style: str) -> str:
    found = ""
    for part in style.split(";"):
        key, _, value = (piece.strip() for piece in part.partition(":"))
        if key == "font":
            size = re.search(r"([\d.]+)px", value)
            found += f' font-size="{size[1]}"' if size else ""
        elif key and not key.startswith("font-family"):
            found += f' {key}="{value.replace("px", "")}"'
    return found
