"""``figures/learn.*``: success against the number of past interactions, a panel a scenario (paper, learning figure)."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from codriving.reports.figure_style import plain_settings, saved
from codriving.reports.paper_learning import LearningStatement
from codriving.reports.rows import Row
from codriving.reports.wording import metrics_text, reasoner_text

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

STYLES = (
    ("#000000", "*", "-"),
    ("#0072b2", "o", "--"),
    ("#d55e00", "s", "-."),
    ("#009e73", "^", ":"),
    ("#cc79a7", "D", "-"),
    ("#e69f00", "v", "--"),
)
"""Colour, marker and stroke of each level, in the palette of Okabe and Ito (2008); colour is never the only cue."""


def learning_figure(rows: Sequence[Row], paper: Sequence[LearningStatement], metrics: str) -> Mapping[str, bytes]:
    """Draw the figure.

    Args:
        rows: Rows of ``learn.csv``, at least one.

    Returns:
        The content of ``learn.png`` and ``learn.svg``; the same rows give the same bytes.
    """
    with plain_settings():
        figure = _draw(rows, paper, metrics)
        return saved(figure, "learn")


def _draw(rows: Sequence[Row], paper: Sequence[LearningStatement], metrics: str) -> "Figure":
    from matplotlib.figure import Figure

    scenarios = list(dict.fromkeys(str(row["scenario"]) for row in rows))
    levels = list(dict.fromkeys(_level(row) for row in rows))
    figure = Figure(figsize=(max(5.0, 3.4 * len(scenarios)), 4.4), layout="constrained")
    axes = figure.subplots(1, len(scenarios), sharey=True, squeeze=False)[0]
    for axis, scenario in zip(axes, scenarios, strict=True):
        sizes = sorted({int(str(row["interactions"])) for row in rows})
        for index, level in enumerate(levels):
            line = [row for row in rows if row["scenario"] == scenario and _level(row) == level]
            _line(axis, line, sizes, level, index, len(levels))
        _paper(axis, [s for s in paper if s.scenario == scenario], sizes)
        axis.set_title(scenario)
        axis.set_xticks(range(len(sizes)), [str(size) for size in sizes])
        axis.set_xlabel("past interactions")
        axis.set_ylim(-3, 105)
    axes[0].set_ylabel("success [%], 95 % interval")
    handles = {str(h.get_label()): h for axis in axes for h in axis.get_legend_handles_labels()[0]}
    figure.legend(list(handles.values()), list(handles), loc="outside lower center", ncols=min(4, len(handles)))
    reasoners = ", ".join(dict.fromkeys(reasoner_text(str(row["reasoner"])) for row in rows))
    figure.suptitle(f"learning - reasoner: {reasoners}{metrics_text(metrics)}", fontsize=11)
    return figure


def _line(axis: "Axes", rows: Sequence[Row], sizes: Sequence[int], level: str, index: int, levels: int) -> None:
    colour, marker, stroke = STYLES[index % len(STYLES)]
    points = []
    for row in rows:
        rate, low, high = (row[key] for key in ("success_rate", "success_low", "success_high"))
        if isinstance(rate, float) and isinstance(low, float) and isinstance(high, float):
            place = sizes.index(int(str(row["interactions"]))) + 0.08 * (index - (levels - 1) / 2)
            points.append((place, 100 * rate, 100 * low, 100 * high))
    look = {"color": colour, "marker": marker, "linestyle": stroke, "linewidth": 1.6, "markersize": 6.5, "label": level}
    axis.plot([x for x, *_ in points], [y for _, y, *_ in points], **look)  # type: ignore[arg-type]
    for x, _, low_, high_ in points:
        axis.plot([x, x], [low_, high_], color=colour, linewidth=1.1, alpha=0.75)


def _paper(axis: "Axes", statements: Sequence[LearningStatement], sizes: Sequence[int]) -> None:
    """Mark what the paper gives a number for."""
    for s in statements:
        if s.success is not None and s.interactions in sizes:
            place = sizes.index(s.interactions)
            axis.plot([place], [100 * s.success], "x", color="#7a7a7a", markersize=9, label="the paper (GPT-4o mini)")


def _level(row: Row) -> str:
    known = {"scenario", "method", "variant", "reasoner", "interactions", "shots"}
    further = [f"{k}={v}" for k, v in row.items() if "." in k and k not in known]
    return " ".join([f"{row['method']} {row['variant']}".strip(), *further])
