"""``figures/profile.*``: success and clean success of every method in every suite of a comparison."""

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from codriving.reports.comparison import Compared, setting_of
from codriving.reports.figures import SUITE_KEY, plain_settings, saved
from codriving.reports.results import CellResults
from codriving.reports.wording import title

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_APART = 0.16  # By how much the marks of success and clean success stand apart, as a share of a row

# What is drawn: its name, colour and marker, whether the marker is filled, and on which side of the row it stands.
_MARKS = (("success", "#000000", "o", True, -1), ("clean success", "#d55e00", "D", False, 1))


@plain_settings()
def profile_figure(suites: Sequence[tuple[str, Sequence[Compared]]], metrics: str) -> Mapping[str, bytes]:
    """Draw a panel a suite and setting, in it a row a method: success and clean success, Wilson 95 % intervals.

    Args:
        suites: Name of each suite, and the rows of its comparison.

    Returns:
        The content of ``profile.png`` and ``profile.svg``.
    """
    from matplotlib.figure import Figure

    driven = list(_panels(suites))
    methods = list(dict.fromkeys(row.name for _, rows in driven for row in rows))
    figure = Figure(figsize=(1.9 + 1.5 * len(driven), 1.5 + 0.3 * len(methods)), layout="constrained")
    axes = figure.subplots(1, len(driven), sharey=True, squeeze=False)[0]
    for axis, (name, rows) in zip(axes, driven, strict=True):
        for row in rows:
            if row.cell:
                _draw(axis, methods.index(row.name), row.cell)
        axis.set(title=name, xlim=(-4, 104), xticks=(0, 50, 100))
        axis.title.set_fontsize(9)
    axes[0].set_yticks(range(len(methods)), methods)
    axes[0].set_ylim(len(methods) - 0.5, -0.5)
    handles = {str(h.get_label()): h for axis in axes for h in axis.get_legend_handles_labels()[0]}
    reasoners = [row.cell.first.reasoner for _, rows in driven for row in rows if row.cell]
    # Below the panels it would lie under the legend.
    heading = f"{title('profile', (), reasoners, metrics)}\nshare of episodes [%], 95 % interval"
    return saved(figure, handles, heading, "profile")


def _panels(suites: Sequence[tuple[str, Sequence[Compared]]]) -> Iterator[tuple[str, list[Compared]]]:
    """Give the name and the driven rows of each panel: a block of a suite, of which there may be several."""
    for name, rows in suites:
        blocks: dict[tuple[object, ...], list[Compared]] = {}
        for row in rows:
            if row.cell:
                blocks.setdefault(row.block, []).append(row)
        scenarios = {row.scenario for row in rows}
        for members in blocks.values():
            first = members[0]
            told = [first.scenario] if len(scenarios) > 1 else []
            told += [f"{key}={value}" for key, value in setting_of(first.swept).items() if key != SUITE_KEY]
            yield "\n".join([name, *(told if len(blocks) > 1 else [])]), members


def _draw(axis: "Axes", place: int, cell: CellResults) -> None:
    for (label, colour, marker, filled, side), rate in zip(_MARKS, (cell.success, cell.clean), strict=True):
        if None in rate:
            continue
        share, low, high = (100 * (number or 0.0) for number in rate)
        y = place + side * _APART
        axis.plot([low, high], [y, y], color=colour, linewidth=1.1, alpha=0.75)
        inside = colour if filled else "white"
        axis.plot([share], [y], marker, color=colour, markerfacecolor=inside, markersize=4.5, label=label)
