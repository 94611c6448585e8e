"""``figures/*`` of any run: how episodes ended, rates, PETs, speed against severe PETs, performance profiles."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from textwrap import wrap
from typing import TYPE_CHECKING, TypeAlias

from codriving.reports.episode_drawings import (
    INK,
    Named,
    draw_endings,
    draw_performance,
    draw_pets,
    draw_rate_bars,
    draw_trade_off,
    legend_names,
    pets_of,
    seconds_of,
    trade_of,
)
from codriving.reports.figures import entry_width, plain_settings, saved
from codriving.reports.results import CellResults
from codriving.reports.wording import title

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

PANELS, ROWS = 8, 24  # Most in one figure: more cannot be told apart

# Takes axes, rows, the place of each among those of all panels, and the colour of words.
Draw: TypeAlias = "Callable[[Axes, Sequence[Named], Sequence[int], str], None]"


@dataclass(frozen=True, slots=True)
class DrawnRow:
    """A row of a table, as figures show it."""

    name: str
    block: str  # What it shares with the rows of its panel
    cell: CellResults


@plain_settings()
def run_figures(rows: Sequence[DrawnRow], metrics: str, only: Sequence[str] = ()) -> dict[str, bytes]:
    """Draw what there is to draw of some rows, a panel for each block of them.

    Args:
        only: Names of the figures that are wanted; empty takes all.

    Returns:
        The content of each file, by name: ``endings.png``, ``endings.svg`` and so on.
    """
    panels = panels_of(rows)
    heading = title("", (), [row.cell.first.reasoner for row in rows], metrics).removeprefix(" - ")
    found: dict[str, bytes] = {}
    for name, kind in FIGURES.items():
        drawn = {block: members for block, members in panels.items() if kind.there(members)}
        if drawn and (not only or name in only):
            figure = _curves(kind, drawn) if kind.up else _bars(kind, drawn)
            found |= _written(figure, [kind.what, heading], name)
    return found


def panels_of(rows: Sequence[DrawnRow]) -> dict[str, list[Named]]:
    """Sort rows into panels, with names that a figure has room for."""
    names = list(dict.fromkeys(row.name for row in rows))
    shown = dict(zip(names, legend_names(names), strict=True))
    panels: dict[str, list[Named]] = {}
    for row in rows:
        panels.setdefault(row.block, []).append((shown[row.name], row.cell))
    return {block: members[:ROWS] for block, members in list(panels.items())[:PANELS]}


def panel_count(rows: Sequence[DrawnRow]) -> int:
    """How many panels all rows would take."""
    return len({row.block for row in rows})


def rate_figure(rows: Sequence[DrawnRow], what: str, metrics: str) -> Mapping[str, bytes]:
    """Draw success and clean success of some rows as bars with intervals, under a name of its own."""
    found = run_figures(rows, metrics, ["rates"])
    return {name.replace("rates", what): content for name, content in found.items()}


def _bars(kind: "KindOfFigure", panels: Mapping[str, Sequence[Named]]) -> "Figure":
    """A panel beside the other, a row a name."""
    from matplotlib.figure import Figure

    names = list(dict.fromkeys(row for members in panels.values() for row, _ in members))
    width = max(6.0, 0.6 + 0.075 * max(map(len, names)) + 2.1 * len(panels))
    figure = Figure(figsize=(width, 1.5 + kind.height * len(names)), layout="constrained")
    axes = figure.subplots(1, len(panels), sharey=True, squeeze=False)[0]
    for axis, (block, members) in zip(axes, panels.items(), strict=True):
        kind.draw(axis, members, [names.index(row) for row, _ in members], INK)
        axis.set(title=block, xlabel=kind.along)
        axis.title.set_fontsize(9)
        axis.grid(visible=False, axis="y")
    axes[0].set_yticks(range(len(names)), names)
    axes[0].set_ylim(len(names) - 0.4, -0.6)
    return figure


def _curves(kind: "KindOfFigure", panels: Mapping[str, Sequence[Named]]) -> "Figure":
    """Panels in rows of three, a line or a mark a name."""
    from matplotlib.figure import Figure

    names = list(dict.fromkeys(row for members in panels.values() for row, _ in members))
    columns = min(3, len(panels))
    rows = -(-len(panels) // columns)
    longest = max(map(len, names))
    below = 0.2 * -(-len(names) // max(1, int(max(6.4, 4.2 * columns) // entry_width(longest))))
    figure = Figure(figsize=(max(6.4, 4.2 * columns), 3.3 * rows + 0.6 + below), layout="constrained")
    axes = figure.subplots(rows, columns, squeeze=False)
    flat = list(axes.flatten())
    for place, (axis, (block, members)) in enumerate(zip(flat, panels.items(), strict=False)):
        kind.draw(axis, members, [names.index(row) for row, _ in members], INK)
        axis.set(title=block, xlabel=kind.along, ylabel=kind.up if place % columns == 0 else "")
        axis.title.set_fontsize(9)
    for axis in flat[len(panels) :]:
        axis.set_axis_off()
    return figure


def _written(figure: "Figure", heading: Sequence[str], name: str) -> Mapping[str, bytes]:
    handles = {str(h.get_label()): h for axis in figure.axes for h in reversed(axis.get_legend_handles_labels()[0])}
    order = [label for axis in figure.axes for label in axis.get_legend_handles_labels()[1]]
    most = max(40, int(11 * figure.get_figwidth()))
    words = "\n".join(line for text in heading for line in wrap(text, most))
    if engine := figure.get_layout_engine():
        engine.set(wspace=0.06)  # type: ignore[call-arg]  # Numbers below two panels are no one number
    return saved(figure, {label: handles[label] for label in dict.fromkeys(order)}, words, name)


def _several(rows: Sequence[Named]) -> bool:
    return len(rows) > 1 and bool(set.intersection(*(set(seconds_of(cell)) for _, cell in rows)))


@dataclass(frozen=True, slots=True)
class KindOfFigure:
    """What a figure shows, and how."""

    what: str
    draw: Draw
    there: Callable[[Sequence[Named]], bool]  # Whether there is anything to draw of some rows
    missing: str  # Why there is not, where there is nothing
    along: str  # What stands below the horizontal axis
    up: str = ""  # What stands beside the vertical axis; empty for rows of bars
    height: float = 0.3  # Of a row of bars [inches]


FIGURES: Mapping[str, KindOfFigure] = {
    "endings": KindOfFigure("how episodes ended", draw_endings, bool, "there is no episode", "episodes [%]"),
    "rates": KindOfFigure(
        "success and clean success, 95 % intervals",
        draw_rate_bars,
        lambda rows: any(cell.completed for _, cell in rows),
        "no episode came to its end",
        "episodes [%]",
        height=0.46,
    ),
    "pets": KindOfFigure(
        "PETs of all pairs",
        draw_pets,
        lambda rows: any(pets_of(cell) for _, cell in rows),
        "no two vehicles have a PET",
        "PET [s]",
        "PETs below [%]",
    ),
    "trade-off": KindOfFigure(
        "velocity against severe PETs; lines of equal velocity times the share of other PETs",
        draw_trade_off,
        lambda rows: sum(trade_of(cell) is not None for _, cell in rows) > 1,
        "it takes two rows with PETs and successes in one panel",
        "mean velocity of successful episodes [m/s]",
        "PETs below 1.5 s [%]",
    ),
    "performance": KindOfFigure(
        "seeds driven within a factor of the fastest row, by travel time",
        draw_performance,
        _several,
        "it takes two rows on the same seeds in one panel",
        "travel time / that of the fastest row",
        "seeds [%]",
    ),
}
