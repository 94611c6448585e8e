"""Figures of the paper's page: bars of success with intervals, and success against interactions."""

from collections.abc import Mapping, Sequence

import numpy as np

from codriving.pages.figures import INK, new_figure, plain_matplotlib, svg_of
from codriving.reports import LINES, CellResults

Interval = tuple[float, float]

PAPER = "#7a7a7a"  # The colour of what the paper says


def success_bars(
    panels: Sequence[tuple[str, Sequence[tuple[str, CellResults]]]], bounds: Mapping[tuple[str, str], Interval]
) -> str:
    """Draw a panel a scenario: a bar a row with its Wilson interval, and the bounds that the paper gives.

    Args:
        panels: Scenario, and name and episodes of each row.
        bounds: Least and largest success of scenario and row as the paper has them.
    """
    names = list(dict.fromkeys(name for _, rows in panels for name, _ in rows))
    with plain_matplotlib():
        figure, _ = new_figure(0.7 + 0.3 * len(names))
        figure.clear()
        axes = figure.subplots(1, len(panels), sharey=True, squeeze=False)[0]
        for axis, (scenario, rows) in zip(axes, panels, strict=True):
            axis.spines[["top", "right"]].set_visible(False)
            for name, cell in rows:
                share, low, high = (100 * (part or 0.0) for part in cell.success)
                place = names.index(name)
                grey = cell.is_control
                axis.barh(
                    place, share, 0.6, color="#bbbbbb" if grey else "#56b4e9", label="control" if grey else "ours"
                )
                axis.plot([low, high], [place, place], color=INK, linewidth=1.0)
                if (scenario, name) in bounds:
                    left, right = (100 * part for part in bounds[scenario, name])
                    label = "the paper"
                    y = place + 0.4
                    axis.plot([left, right], [y, y], color="#d55e00", linewidth=2.4, label=label)
                    if left == right:
                        axis.plot([left], [y], "D", color="#d55e00", markersize=4)
            axis.set(xlim=(0, 104), xticks=(0, 50, 100), xlabel="success [%]")
            axis.set_title(scenario, fontsize=10, color=INK)
        axes[0].set_yticks(range(len(names)), names)
        axes[0].set_ylim(len(names) - 0.4, -0.6)
        return svg_of(figure, axes, "success")


def learning_lines(
    lines: Sequence[tuple[str, Mapping[int, CellResults]]], points: Mapping[str, tuple[int, float]]
) -> str:
    """Draw a line a scenario, success with Wilson intervals, and the points that the paper names.

    Args:
        points: By scenario, interactions and success in the paper.
    """
    sizes = sorted({size for _, cells in lines for size in cells})
    with plain_matplotlib():
        figure, axis = new_figure(3.0)
        for index, (scenario, cells) in enumerate(lines):
            colour, dash = LINES[index % len(LINES)]
            places = np.array([sizes.index(size) for size in sorted(cells)]) + 0.07 * (index - (len(lines) - 1) / 2)
            rates = [cells[size].success for size in sorted(cells)]
            shares = [100 * (rate[0] or 0.0) for rate in rates]
            axis.plot(places, shares, "os^D"[index % 4], color=colour, linestyle=dash, label=scenario)
            for place, (_, low, high) in zip(places, rates, strict=True):
                axis.plot([place, place], [100 * (low or 0.0), 100 * (high or 0.0)], color=colour, linewidth=0.9)
            if scenario in points and points[scenario][0] in sizes:
                at, success = points[scenario]
                label = f"{scenario}, the paper"
                axis.plot([sizes.index(at)], [100 * success], "x", color=colour, markersize=9, label=label)
        axis.set_xticks(range(len(sizes)), [str(size) for size in sizes])
        axis.set(xlabel="past interactions", ylabel="success [%]", ylim=(-3, 105))
        return svg_of(figure, [axis], "learning")
