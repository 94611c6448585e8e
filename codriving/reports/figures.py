"""``figures/*``: success against the number of CAVs or of past interactions; the same rows give the same bytes."""

import io
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from itertools import cycle, pairwise, product
from typing import TYPE_CHECKING, TypeAlias

from codriving.reports.columns import mean
from codriving.reports.comparison import METHOD_CHOICE, setting_of
from codriving.reports.learning import LearningRow
from codriving.reports.load import LoadRow, load_title
from codriving.reports.paper import LearningStatement
from codriving.reports.results import CellResults
from codriving.reports.wording import short_names, title

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
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
    # A label of a model may hold dollar signs, and is no formula.
    "text.parse_math": False,
    # Without it the names inside an SVG are drawn by lot.
    "svg.hashsalt": "codriving",
}

# Colour, marker and stroke, in the palette of Okabe and Ito (2008); colour is never the only cue.
Style: TypeAlias = tuple[str, str, str]

# For methods that have none of their own, in turn.
OTHERS: Sequence[Style] = (("#7a7a7a", "X", "-"), ("#7a1f5c", "<", "--"), ("#5c4a00", ">", "-."), ("#3b5b92", "h", ":"))

SUITE_KEY = "suite"  # Of what was swept, what has panels of its own

ENTRY, LETTER = 2.2, 0.085  # Width of an entry of a legend, and of a letter of a long one [inches]

# For the controls of learning, beside the most interactions.
CONTROL_MARKS = {"verdicts": "x", "situations": "+", "rule": "d", "elsewhere": "v"}

# For the settings that are learnt in.
LEVELS: Sequence[Style] = (
    ("#000000", "*", "-"),
    ("#0072b2", "o", "--"),
    ("#d55e00", "s", "-."),
    ("#009e73", "^", ":"),
    ("#cc79a7", "D", "-"),
    ("#e69f00", "v", "--"),
)

# Shift of one line against the next, as a share of the smallest step between loads or of 2, to part the intervals.
SPREAD = 0.06


@contextmanager
def plain_settings() -> Iterator[None]:
    """Matplotlib as it is shipped but for the look of our figures, whatever its user has set."""
    import matplotlib

    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(_SETTINGS)  # type: ignore[arg-type]
        yield


@plain_settings()
def load_figure(
    rows: Sequence[LoadRow], loads: Sequence[int], metrics: str, methods: Mapping[str, Style]
) -> Mapping[str, bytes]:
    """Draw success and velocity against the number of CAVs, a column of panels for each scenario.

    Args:
        methods: Styles of methods by name.

    Returns:
        The content of ``load.png`` and ``load.svg``.
    """
    from matplotlib.figure import Figure

    heading, rows, loads = load_title(rows, metrics), [row for row in rows if row.at], sorted(loads)
    panels: dict[str, list[LoadRow]] = {}
    for row in rows:
        setting = [f"{key}={value}" for key, value in setting_of(row.swept).items()]
        panels.setdefault(", ".join([row.scenario, *setting]), []).append(row)
    labels = line_labels([(row.name, row.cell, row.swept.get(METHOD_CHOICE, "")) for row in rows if row.cell])
    label_of = dict(zip(map(id, rows), labels, strict=True))
    names, styles = list(dict.fromkeys(labels)), styles_of([row.method for row in rows], labels, methods)
    step = min((b - a for a, b in pairwise(loads)), default=1)
    figure = Figure(figsize=(max(6.4, 4.4 * len(panels)), 6.6), layout="constrained")
    axes = figure.subplots(2, len(panels), sharex=True, sharey="row", squeeze=False)
    for column, (panel, members) in enumerate(panels.items()):
        success, velocity = axes[0][column], axes[1][column]
        success.set_title(panel)
        for row in members:
            name = label_of[id(row)]
            shift = min(step, 2) * SPREAD * (names.index(name) - (len(names) - 1) / 2)
            cells = [(cavs + shift, row.at[cavs]) for cavs in loads if cavs in row.at]
            speeds = [(place, speed) for place, cell in cells if (speed := mean(cell.velocities)) is not None]
            draw_rates(success, [(place, cell.success) for place, cell in cells], styles[name], name)
            velocity.plot(*_unzipped(speeds), **_look(styles[name], name))
        success.set_ylim(-3, 103)
        success.set_xticks(loads)
        velocity.set_xlabel("CAVs")
    axes[0][0].set_ylabel("success [%], 95 % interval")
    axes[1][0].set_ylabel("mean velocity [m/s]")
    handles = {line.get_label(): line for axis in axes[0] for line in axis.get_lines() if line.get_label() in names}
    return saved(figure, {name: handles[name] for name in names if name in handles}, heading, "load")


@plain_settings()
def learning_figure(
    rows: Sequence[LearningRow], paper: Sequence[LearningStatement], metrics: str
) -> Mapping[str, bytes]:
    """Draw success, and clean success, against the number of past interactions, a panel a scenario and suite.

    Controls stand beside the most interactions, each with its own mark and in the colour of its setting.

    Returns:
        The content of ``learn.png`` and ``learn.svg``.
    """
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

    firsts = [row.cell.first for row in rows]
    panels = list(dict.fromkeys(map(_panel, rows)))
    labels = line_labels([(_level(row), row.cell, "") for row in rows])
    levels = list(dict.fromkeys(labels))
    sizes = sorted({row.interactions for row in rows})
    # Clean success has panels of its own, where it is known.
    kinds = [("success", "success")] + [("clean", "clean success")] * any(row.cell.judged for row in rows)
    height = 4.4 if len(kinds) == 1 else 7.2
    figure = Figure(figsize=(max(5.0, 3.4 * len(panels)), height), layout="constrained")
    grid = figure.subplots(len(kinds), len(panels), sharex=True, sharey=True, squeeze=False)
    axes = list(grid.flat)
    for axis, ((kind, _), panel) in zip(axes, product(kinds, panels), strict=True):
        for index, level in enumerate(levels):
            shift = 0.08 * (index - (len(levels) - 1) / 2)
            members = [row for row, label in zip(rows, labels, strict=True) if label == level]
            cells = [
                (sizes.index(row.interactions) + shift, getattr(row.cell, kind))
                for row in members
                if _panel(row) == panel and not row.is_control
            ]
            draw_rates(axis, cells, LEVELS[index % len(LEVELS)], level)
            controls = [row for row in members if _panel(row) == panel and row.is_control]
            for k, row in enumerate(controls, 1):
                style = (LEVELS[index % len(LEVELS)][0], CONTROL_MARKS[row.control], "none")
                place = sizes.index(row.interactions) + shift + 0.25 * k
                draw_rates(axis, [(place, getattr(row.cell, kind))], style, f"control, {row.words}")
        claims = {row.claim for row in rows if _panel(row) == panel}
        for s in paper if kind == "success" else ():
            # Not in a panel of another setting than the paper's.
            if s.scenario == panel[0] and s.success is not None and s.interactions in sizes and s.statement in claims:
                place, label = sizes.index(s.interactions), "the paper (GPT-4o mini)"
                axis.plot([place], [100 * s.success], "x", color="#7a7a7a", markersize=9, label=label)
        axis.set_xticks(range(len(sizes)), [str(size) for size in sizes])
        axis.set(ylim=(-3, 105))
    for row, (_, words) in zip(grid, kinds, strict=True):
        row[0].set_ylabel(f"{words} [%], 95 % interval")
    for axis, below, panel in zip(grid[0], grid[-1], panels, strict=True):
        axis.set_title("\n".join(filter(None, panel)))
        below.set_xlabel("past interactions")
    handles = {str(h.get_label()): h for axis in axes for h in axis.get_legend_handles_labels()[0]}
    if len(levels) > 1:
        # A mark in the colour of one setting stands for those of all.
        for row in rows:
            if (label := f"control, {row.words}") in handles:
                handles[label] = Line2D([], [], **_look(("#7a7a7a", CONTROL_MARKS[row.control], "none"), label))  # type: ignore[arg-type]
    return saved(figure, handles, title("learning", (), [first.reasoner for first in firsts], metrics), "learn")


def saved(figure: "Figure", handles: Mapping[str, "Artist"], heading: str, name: str) -> Mapping[str, bytes]:
    """Give a figure with its legend and heading as PNG and SVG, by file name."""
    # A narrow figure has no room for four names in a row.
    entry = entry_width(max(map(len, handles), default=0))
    columns = min(4, max(int(figure.get_figwidth() // entry), 1), len(handles) or 1)
    figure.legend(list(handles.values()), list(handles), loc="outside lower center", ncols=columns)
    figure.suptitle(heading, fontsize=11)
    kinds: dict[str, dict[str, str | None]] = {"png": {"Software": None}, "svg": {"Date": None, "Creator": None}}
    found = {}
    for kind, metadata in kinds.items():
        stream = io.BytesIO()
        figure.savefig(stream, format=kind, dpi=160, metadata=metadata)
        found[f"{name}.{kind}"] = stream.getvalue()
    return found


def entry_width(longest: int) -> float:
    """Return the width of an entry of a legend [inches] whose longest name has so many characters."""
    return max(ENTRY, 0.6 + LETTER * longest)


def draw_rates(axis: "Axes", rates: Sequence[tuple[float, tuple[float | None, ...]]], style: Style, label: str) -> None:
    """Draw a line of rates [%] with an interval at each; each is a place, and rate with lower and upper limit."""
    known = [(place, [100 * (number or 0.0) for number in rate]) for place, rate in rates if None not in rate]
    axis.plot(*_unzipped([(place, rate[0]) for place, rate in known]), **_look(style, label))  # type: ignore[arg-type]
    for place, (_, low, high) in known:
        axis.plot([place, place], [low, high], color=style[0], linewidth=1.1, alpha=0.75)


def _unzipped(points: Sequence[tuple[float, float]]) -> tuple[list[float], list[float]]:
    return [x for x, _ in points], [y for _, y in points]


def _look(style: Style, label: str) -> dict[str, str | float]:
    colour, marker, stroke = style
    return {"color": colour, "marker": marker, "linestyle": stroke, "linewidth": 1.6, "markersize": 6.5, "label": label}


def _panel(row: LearningRow) -> tuple[str, str]:
    return row.cell.first.scenario, row.cell.swept.get(SUITE_KEY, "")


def _level(row: LearningRow) -> str:
    swept = [f"{key}={value}" for key, value in row.cell.swept.items() if key != SUITE_KEY]
    return " ".join([row.cell.name, *swept])


def line_labels(lines: Sequence[tuple[str, CellResults, str]]) -> list[str]:
    """Name each line; where one name is of several reasoners or choices of a method, these are added.

    Args:
        lines: Name, a cell and choice of the method of each.
    """
    reasoners = short_names(cell.first.reasoner for _, cell, _ in lines)
    parts = [(name, reasoners[cell.first.reasoner], choice) for name, cell, choice in lines]
    labels = []
    for name, *others in parts:
        alike = [part for part in parts if part[0] == name]
        told = [text for index, text in enumerate(others, 1) if len({part[index] for part in alike}) > 1]
        labels.append(", ".join([name, *told]))
    return labels


def styles_of(drawn: Sequence[str], labels: Sequence[str], methods: Mapping[str, Style]) -> dict[str, Style]:
    """Give each label a style: that of its method, unless that is taken or there is none.

    Args:
        drawn: The method of each label.
    """
    styles: dict[str, Style] = {}
    others = cycle(OTHERS)
    for method, label in zip(drawn, labels, strict=True):
        usual = methods.get(method)
        if label not in styles:
            styles[label] = next(others) if usual is None or usual in styles.values() else usual
    return styles
