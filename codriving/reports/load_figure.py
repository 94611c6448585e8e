"""``figures/load.*``: success and velocity against the number of CAVs, a column of panels for each scenario."""

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

from codriving.reports.comparison import DRIVEN, METHOD_CHOICE
from codriving.reports.figure_style import plain_settings, saved
from codriving.reports.load import Loaded
from codriving.reports.load_display import load_title, method_text

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

STYLES = {
    "fcfs": ("#0072b2", "o", "-"),
    "idfst": ("#e69f00", "s", "--"),
    "mcts": ("#009e73", "^", "-."),
    "coop_game": ("#d55e00", "D", ":"),
    "madqn": ("#56b4e9", "v", "--"),
    "dilu": ("#cc79a7", "P", "-."),
    "codriving": ("#000000", "*", "-"),
}
"""Colour, marker and stroke of each method, in the palette of Okabe and Ito (2008); colour is never the only cue."""

OTHERS = (("#7a7a7a", "X", "-"), ("#7a1f5c", "<", "--"), ("#5c4a00", ">", "-."), ("#3b5b92", "h", ":"))
"""For methods of the user's, in turn."""

_SPREAD = 0.06
"""Shift of one line against the next, as a share of the smallest step between loads or of 2, to part the intervals."""


def load_figure(rows: Sequence[Loaded], loads: Sequence[int], metrics: str) -> Mapping[str, bytes]:
    """Draw the loads.

    Returns:
        The content of ``load.png`` and ``load.svg``; the same rows give the same bytes.
    """
    driven = [row for row in rows if row.labels["status"] == DRIVEN]
    with plain_settings():
        figure = _draw(driven, sorted(loads), load_title(rows, metrics))
        return saved(figure, "load")


def _draw(rows: Sequence[Loaded], loads: Sequence[int], title: str) -> "Figure":
    from matplotlib.figure import Figure

    panels: dict[str, list[Loaded]] = {}
    for row in rows:
        panels.setdefault(_panel(row), []).append(row)
    names = list(dict.fromkeys(method_text(row.labels) for row in rows))
    styles = _styles(rows)
    figure = Figure(figsize=(max(6.4, 4.4 * len(panels)), 6.6), layout="constrained")
    axes = figure.subplots(2, len(panels), sharex=True, sharey="row", squeeze=False)
    for column, (panel, members) in enumerate(panels.items()):
        success, velocity = axes[0][column], axes[1][column]
        success.set_title(panel)
        for row in members:
            index = names.index(method_text(row.labels))
            _line(success, velocity, row, loads, _shifted(loads, index, len(names)), styles[method_text(row.labels)])
        success.set_ylim(-3, 103)
        success.set_xticks(list(loads))
        velocity.set_xlabel("CAVs")
    axes[0][0].set_ylabel("success [%], 95 % interval")
    axes[1][0].set_ylabel("mean velocity [m/s]")
    handles = {line.get_label(): line for axis in axes[0] for line in axis.get_lines() if line.get_label() in names}
    shown = [name for name in names if name in handles]
    figure.legend([handles[name] for name in shown], shown, loc="outside lower center", ncols=min(4, len(shown) or 1))
    figure.suptitle(title, fontsize=11)
    return figure


def _line(
    success: "Axes",
    velocity: "Axes",
    row: Loaded,
    loads: Sequence[int],
    places: Sequence[float],
    style: tuple[str, str, str],
) -> None:
    colour, marker, stroke = style
    name = method_text(row.labels)
    look = {"color": colour, "marker": marker, "linestyle": stroke, "linewidth": 1.6, "markersize": 6.5, "label": name}
    rates: list[tuple[float, float, float, float]] = []
    speeds: list[tuple[float, float]] = []
    for cavs, place in zip(loads, places, strict=True):
        at = row.at.get(cavs, {})
        rate, low, high = (at.get(key) for key in ("success_rate", "success_low", "success_high"))
        if isinstance(rate, float) and isinstance(low, float) and isinstance(high, float):
            rates.append((place, 100 * rate, 100 * max(rate - low, 0.0), 100 * max(high - rate, 0.0)))
        speed = at.get("velocity_mean")
        if isinstance(speed, float):
            speeds.append((place, speed))
    success.plot([x for x, *_ in rates], [y for _, y, _, _ in rates], **look)  # type: ignore[arg-type]
    for x, y, below, above in rates:
        success.plot([x, x], [y - below, y + above], color=colour, linewidth=1.1, alpha=0.75)
    velocity.plot([x for x, _ in speeds], [y for _, y in speeds], **look)  # type: ignore[arg-type]


def _panel(row: Loaded) -> str:
    """Name the panel of a row: its scenario, and what else was swept."""
    labels = ("scenario", "method", "variant", "reasoner", "status", METHOD_CHOICE)
    return ", ".join([str(row.labels["scenario"]), *(f"{k}={v}" for k, v in row.labels.items() if k not in labels)])


def _styles(rows: Sequence[Loaded]) -> dict[str, tuple[str, str, str]]:
    styles: dict[str, tuple[str, str, str]] = {}
    further = 0
    for row in rows:
        name, usual = method_text(row.labels), STYLES.get(str(row.labels["method"]))
        if name in styles:
            continue
        if usual is None or usual in styles.values():
            styles[name] = OTHERS[further % len(OTHERS)]
            further += 1
        else:
            styles[name] = usual
    return styles


def _shifted(loads: Sequence[int], index: int, lines: int) -> list[float]:
    step = min((b - a for a, b in pairwise(loads)), default=1)
    return [cavs + min(step, 2) * _SPREAD * (index - (lines - 1) / 2) for cavs in loads]
