"""``figures/stress-*``: success and clean success over the levels of one axis, a line a method."""

from collections.abc import Mapping, Sequence

from codriving.reports.comparison import METHOD_CHOICE, setting_of
from codriving.reports.figures import SPREAD, Style, draw_rates, line_labels, plain_settings, saved, styles_of
from codriving.reports.stress import StressCurve
from codriving.reports.wording import title

HEADS = {"success": "success [%], 95 % interval", "clean": "clean success [%], 95 % interval"}


@plain_settings()
def stress_figure(curves: Sequence[StressCurve], metrics: str, methods: Mapping[str, Style]) -> Mapping[str, bytes]:
    """Draw the curves of one axis, a column of panels for each setting; a ring marks where a curve breaks.

    Levels stand at equal distances, in the order of the axis.

    Args:
        methods: Styles of methods by name.

    Returns:
        The content of ``stress-<axis>.png`` and ``.svg``.
    """
    from matplotlib.figure import Figure

    axis = curves[0].axis
    panels: dict[str, list[StressCurve]] = {}
    for curve in curves:
        setting = [f"{key}={value}" for key, value in setting_of(curve.swept).items()]
        panels.setdefault("\n".join([curve.scenario, *setting]), []).append(curve)
    labels = line_labels([(c.name, c.cell, c.swept.get(METHOD_CHOICE, "")) for c in curves])
    label_of = dict(zip(map(id, curves), labels, strict=True))
    names, styles = list(dict.fromkeys(labels)), styles_of([curve.method for curve in curves], labels, methods)
    figure = Figure(figsize=(max(8.0, 4.4 * len(panels)), 8.0), layout="constrained")
    axes = figure.subplots(2, len(panels), sharex=True, sharey=True, squeeze=False)
    for column, (panel, members) in enumerate(panels.items()):
        axes[0][column].set_title(panel)
        for row, measure in enumerate(HEADS):
            for curve in members:
                name = label_of[id(curve)]
                shift = SPREAD * (names.index(name) - (len(names) - 1) / 2)
                rates = [(level + shift, getattr(cell, measure)) for level, cell in sorted(curve.at.items())]
                draw_rates(axes[row][column], rates, styles[name], name)
                if isinstance(level := curve.breaks(measure), int):
                    rate = 100 * getattr(curve.at[level], measure)[0]
                    colour = styles[name][0]
                    axes[row][column].plot([level + shift], [rate], "o", color=colour, mfc="none", markersize=13)
        axes[1][column].set_xlabel(axis.title)
        axes[1][column].set_xticks(range(len(axis.labels)), axis.labels)
        axes[1][column].set_ylim(-3, 103)
    for row, head in enumerate(HEADS.values()):
        axes[row][0].set_ylabel(head)
    handles = {line.get_label(): line for ax in axes[0] for line in ax.get_lines() if line.get_label() in names}
    # On one line it might be wider than the figure; the panels name the scenarios.
    heading = f"{title('stress', (), [c.cell.first.reasoner for c in curves], metrics)}\n{axis.title}"
    return saved(figure, {name: handles[name] for name in names if name in handles}, heading, f"stress-{axis.key}")
