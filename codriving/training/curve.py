"""The curve of a training: one row a validation, as CSV and as a picture."""

import csv
import io
from collections.abc import Mapping, Sequence
from math import nan

Row = Mapping[str, float | int | None]  # One validation: how far the training was, and what each exam said

SUCCESS, COLLISION, DURATION = "success", "collision", "duration"


def curve_csv(rows: Sequence[Row]) -> str:
    """Write the curve; the columns are those of the first row."""
    text = io.StringIO()
    writer = csv.DictWriter(text, list(rows[0]), lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return text.getvalue()


def curve_png(rows: Sequence[Row], title: str) -> bytes:
    """Draw the share of successful episodes against the decisions that were driven."""
    import matplotlib
    from matplotlib.figure import Figure

    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        figure = Figure(figsize=(8.0, 4.5), dpi=100, layout="constrained")
        axes = figure.subplots()
        decisions = _column(rows, "decisions")
        names = [name for name in rows[0] if name.endswith(f".{SUCCESS}")]
        for name, mark in zip(names, "osD^vP*X" * len(names), strict=False):
            axes.plot(decisions, _column(rows, name), marker=mark, markersize=4, label=name.partition(".")[0])
        if "train_success" in rows[0]:
            explored = _column(rows, "train_success")
            axes.plot(decisions, explored, color="#888888", linestyle=":", label="training, exploring")
        axes.set(xlabel="decisions of single CAVs", ylabel="successful episodes", ylim=(-0.02, 1.02), title=title)
        axes.grid(color="#dddddd", linewidth=0.6)
        axes.legend(loc="lower right", frameon=False)
        content = io.BytesIO()
        figure.savefig(content, format="png", metadata={"Software": None})
        return content.getvalue()


def _column(rows: Sequence[Row], name: str) -> list[float]:
    return [nan if value is None else float(value) for value in (row[name] for row in rows)]
