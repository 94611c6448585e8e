"""How figures look, and how they become files whose bytes repeat."""

import io
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_SETTINGS = {
    "font.family": "DejaVu Sans",
    "font.size": 10.0,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "#d9dbdf",
    "grid.linewidth": 0.6,
    "axes.axisbelow": True,
    # Without it the names inside an SVG are drawn by lot.
    "svg.hashsalt": "codriving",
}


@contextmanager
def plain_settings() -> Iterator[None]:
    """Matplotlib as it is shipped but for the look of our figures, whatever its user has set."""
    import matplotlib

    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(_SETTINGS)  # type: ignore[arg-type]
        yield


def saved(figure: "Figure", name: str) -> Mapping[str, bytes]:
    """Write a figure as PNG and SVG.

    Returns:
        The content of both, by file name; the same figure gives the same bytes.
    """
    kinds: dict[str, dict[str, str | None]] = {"png": {"Software": None}, "svg": {"Date": None, "Creator": None}}
    found = {}
    for kind, metadata in kinds.items():
        stream = io.BytesIO()
        figure.savefig(stream, format=kind, dpi=160, metadata=metadata)
        found[f"{name}.{kind}"] = stream.getvalue()
    return found
