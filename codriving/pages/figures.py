"""Figures of a page, as SVG that stands in it: words take the colour of the page, in light and in dark."""

import io
import re
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from itertools import cycle
from typing import TYPE_CHECKING

import numpy as np

from codriving.datatypes import Ending
from codriving.reports import CellResults

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SEVERE = 1.5  # Below this a PET counts as severe [s]

MOST = 12  # Rows in one figure

INK = "#010203"  # Stands for the colour of the page's words

# Okabe and Ito (2008), with a hatch or a dash as a second cue.
ENDINGS = {
    Ending.SUCCESS: ("success", "#009e73", ""),
    Ending.COLLISION: ("collision", "#d55e00", "///"),
    Ending.TIMEOUT: ("timeout", "#e69f00", "..."),
    Ending.OFF_ROAD: ("off the road", "#cc79a7", "xxx"),
    Ending.COUNTED: ("counted", "#0072b2", ""),
    Ending.ERROR: ("error", "#7a7a7a", "---"),
}

LINES = [
    (colour, dash)
    for dash in ("-", "--", ":")
    for colour in ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9")
]


def figures(rows: Sequence[tuple[str, CellResults]]) -> list[tuple[str, str]]:
    """Draw what there is to draw of some rows.

    Returns:
        Title and SVG of each figure.
    """
    with plain_matplotlib():
        return _figures([(_listed(name), cell) for name, cell in rows[:MOST]])


@contextmanager
def plain_matplotlib() -> Iterator[None]:
    """Draw as Matplotlib is shipped, whatever its user has set; and a name with dollar signs is no formula."""
    import matplotlib

    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        matplotlib.rcParams["text.parse_math"] = False
        yield


def _figures(rows: Sequence[tuple[str, CellResults]]) -> list[tuple[str, str]]:
    found = [("How episodes ended", _endings(rows))]
    with_pets = [(name, [pet for e in cell.completed for pet in e.pets]) for name, cell in rows]
    if any(pets for _, pets in with_pets):
        found.append(("Post-encroachment times (PET) of all episodes", _pets(with_pets)))
    placed = [(name, *place) for name, cell in rows if (place := _trade(cell)) is not None]
    if len(placed) > 1:
        found.append(("Velocity against severe PETs", _trade_off(placed)))
    return found


def _listed(name: str) -> str:
    """Write a name so that no legend leaves it out, as one that begins with an underscore."""
    return f" {name}" if name.startswith("_") else name


def _endings(rows: Sequence[tuple[str, CellResults]]) -> str:
    figure, axis = new_figure(0.9 + 0.36 * len(rows))
    there = [e for e in ENDINGS if any(r.outcome.ending is e for _, cell in rows for r in cell.records)]
    left = np.zeros(len(rows))
    for ending in there:
        word, colour, hatch = ENDINGS[ending]
        shares = np.array(
            [100 * sum(r.outcome.ending is ending for r in cell.records) / len(cell.records) for _, cell in rows]
        )
        axis.barh(range(len(rows)), shares, left=left, color=colour, hatch=hatch, edgecolor="#ffffff", label=word)
        left += shares
    axis.set(xlim=(0, 100), xlabel="episodes [%]")
    axis.set_yticks(range(len(rows)), [name for name, _ in rows])
    axis.invert_yaxis()
    return _svg(figure, axis, "endings", len(there))


def _pets(rows: Sequence[tuple[str, Sequence[float]]]) -> str:
    """For each time, the share of PETs below it."""
    figure, axis = new_figure(3.0)
    for (name, pets), (colour, dash) in zip(rows, cycle(LINES), strict=False):
        if pets:
            values = np.sort(pets)
            shares = 100 * np.arange(len(values) + 1) / len(values)
            axis.step([0, *values], shares, where="post", color=colour, linestyle=dash, label=name)
    axis.axvline(SEVERE, color=INK, linewidth=0.8, linestyle=(0, (4, 3)))
    axis.annotate("severe below 1.5 s", (SEVERE, 97), (4, 0), textcoords="offset points", fontsize=8, va="top")
    most = max(max(pets) for _, pets in rows if pets)
    axis.set(xlim=(0, min(most * 1.02, 20.0)), ylim=(0, 100), xlabel="PET [s]", ylabel="PETs below [%]")
    return _svg(figure, axis, "pets", len(rows))


def _trade(cell: CellResults) -> tuple[float, float] | None:
    """Mean velocity of successful episodes [m/s], and the share of severe PETs of all [%]."""
    pets = [pet for e in cell.completed for pet in e.pets]
    if not cell.velocities or not pets:
        return None
    return float(np.mean(cell.velocities)), 100 * sum(pet < SEVERE for pet in pets) / len(pets)


def _trade_off(rows: Sequence[tuple[str, float, float]]) -> str:
    figure, axis = new_figure(3.0)
    marks = cycle("osD^vPX*<>hp")
    for (name, velocity, severe), (colour, _), mark in zip(rows, cycle(LINES), marks, strict=False):
        axis.plot([velocity], [severe], mark, color=colour, markersize=8, label=name)
    axis.set(xlabel="mean velocity of successful episodes [m/s]", ylabel="PETs below 1.5 s [%]")
    axis.set_ylim(-1.0, max(5.0, 1.1 * max(severe for _, _, severe in rows)))
    return _svg(figure, axis, "trade-off", len(rows))


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
