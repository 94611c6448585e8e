"""The figure of a table: success and clean success of each row with 95 % intervals, a panel a world."""

from collections.abc import Mapping, Sequence
from types import SimpleNamespace
from typing import Any

from matplotlib.figure import Figure

from codriving.reports.figures import plain_settings, saved

# Column, name, colour and marker; colour is never the only cue.
RATES = (("success", "success", "#0072b2", "o"), ("clean", "clean success", "#d55e00", "s"))


@plain_settings()
def drawn(rows: Sequence[Mapping[str, Any]], worlds: Sequence[str]) -> bytes:
    """Draw rows of a table as SVG.

    Args:
        rows: As `joined` in `__main__` gives them: ``method``, ``variant``, and below each world its columns.
    """
    names = [" ".join(filter(None, (row["method"], row.get("variant", "")))) for row in rows]
    figure = Figure(figsize=(1.9 + 1.5 * len(worlds), 1.4 + 0.28 * len(rows)), layout="constrained")
    axes = figure.subplots(1, len(worlds), sharey=True, squeeze=False)[0]
    for axis, world in zip(axes, worlds, strict=True):
        for key, label, colour, marker in RATES:
            known = [(place, row[world]) for place, row in enumerate(rows) if world in row]
            shift = 0.15 if key == "clean" else -0.15
            for place, found in known:
                low, high = _percent(found, f"{key}_low"), _percent(found, f"{key}_high")
                axis.plot([low, high], [place + shift] * 2, color=colour, linewidth=1.2)
            rates = [_percent(found, f"{key}_rate") for _, found in known]
            places = [place + shift for place, _ in known]
            axis.plot(rates, places, marker, color=colour, markersize=4.5, label=label)
        axis.set(title=world, xlim=(-4, 104), xticks=(0, 50, 100), xlabel="%")
        axis.title.set_fontsize(9)
    axes[0].set_yticks(range(len(names)), names)
    axes[0].set_ylim(len(names) - 0.4, -0.6)
    handles = dict(zip(*reversed(axes[0].get_legend_handles_labels()), strict=True))
    return saved(figure, handles, "Success and clean success, with 95 % intervals (Wilson)", "table")["table.svg"]


def _percent(found: SimpleNamespace, column: str) -> float:
    return 100 * float(getattr(found, column))
