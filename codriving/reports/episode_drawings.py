"""Drawings of episodes on axes: endings, rates, PETs, speed against severe PETs, performance; in files and on pages."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, TypeAlias
from unicodedata import east_asian_width

import numpy as np

from codriving.datatypes import Ending
from codriving.reports.columns import mean
from codriving.reports.results import CellResults

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Named: TypeAlias = tuple[str, CellResults]  # A row, and what it is called

SEVERE = 1.5  # Below this a PET counts as severe [s]

# Okabe and Ito (2008), with a hatch or a dash as a second cue.
ENDINGS = {
    Ending.SUCCESS: ("success", "#009e73", ""),
    Ending.COLLISION: ("collision", "#d55e00", "///"),
    Ending.TIMEOUT: ("timeout", "#e69f00", "..."),
    Ending.OFF_ROAD: ("off the road", "#cc79a7", "xxx"),
    Ending.COUNTED: ("counted", "#0072b2", ""),
    Ending.ERROR: ("error", "#7a7a7a", "---"),
}

COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9")

DASHES = ("-", "--", "-.", ":")

# Twenty-four that differ; neighbours differ in both.
LINES = [(COLOURS[k % 6], DASHES[(k + k // 6) % 4]) for k in range(24)]

MARKS = "osD^vPX*<>hp"

INK = "#000000"

RATES = (("success", "#0072b2", ""), ("clean success", "#e69f00", "////"))

LONGEST = 46  # Widest name beside bars and in a legend [Latin letters]

SLOWEST = 3.0  # Largest factor of a performance profile


def legend_names(names: Sequence[str]) -> list[str]:
    """Write names so that they leave room for a figure, are told apart, and no legend leaves one out.

    Long ones lose their middle, and two that are then alike are numbered. Matplotlib leaves out what begins with an
    underscore.
    """
    short = [name if _width(name) <= LONGEST else _without_middle(name) for name in names]
    numbered = [
        name if short.count(name) == 1 else f"{name} ({short[:place].count(name) + 1})"
        for place, name in enumerate(short)
    ]
    return [f" {name}" if name.startswith("_") else name for name in numbered]


def _width(name: str) -> int:
    return sum(1 + (east_asian_width(letter) in "WF") for letter in name)


def _without_middle(name: str) -> str:
    """Keep the begin and the end, fewer letters of them where letters are wide."""
    return f"{name[:27]}...{name[-16:]}" if _width(name) <= 1.2 * len(name) else f"{name[:13]}...{name[-8:]}"


def pets_of(cell: CellResults) -> list[float]:
    """All PETs of completed episodes [s]."""
    return [pet for episode in cell.completed for pet in episode.pets]


def trade_of(cell: CellResults) -> tuple[float, float] | None:
    """Mean velocity of successful episodes [m/s], and the share of severe PETs of all [%]."""
    pets = pets_of(cell)
    if not cell.velocities or not pets:
        return None
    return float(np.mean(cell.velocities)), 100 * sum(pet < SEVERE for pet in pets) / len(pets)


def seconds_of(cell: CellResults) -> dict[int, float]:
    """Mean travel time [s] of each completed episode, by seed; inf where it is no success."""
    found = {}
    for episode in cell.completed:
        time = mean(episode.times) if episode.success else None
        found[episode.record.seed] = np.inf if time is None else time
    return found


def draw_endings(axis: "Axes", rows: Sequence[Named], places: Sequence[int], ink: str) -> None:
    """Draw a bar a row, parted by how its episodes ended [%]."""
    there = [e for e in ENDINGS if any(r.outcome.ending is e for _, cell in rows for r in cell.records)]
    left = np.zeros(len(rows))
    for ending in there:
        word, colour, hatch = ENDINGS[ending]
        shares = np.array(
            [100 * sum(r.outcome.ending is ending for r in cell.records) / len(cell.records) for _, cell in rows]
        )
        axis.barh(places, shares, left=left, color=colour, hatch=hatch, edgecolor="#ffffff", label=word)
        left += shares
    axis.set_xlim(0, 100)


def draw_rate_bars(axis: "Axes", rows: Sequence[Named], places: Sequence[int], ink: str) -> None:
    """Draw two bars a row, success and clean success [%], each with its interval."""
    for side, (label, colour, hatch) in enumerate(RATES):
        for (_, cell), place in zip(rows, places, strict=True):
            rate = (cell.success, cell.clean)[side]
            if rate[0] is None or rate[1] is None or rate[2] is None:
                continue
            share, low, high = (100 * number for number in rate if number is not None)
            y = place + (side - 0.5) * 0.36
            axis.barh([y], [share], height=0.34, color=colour, hatch=hatch, edgecolor="#ffffff", label=label)
            axis.plot([low, high], [y, y], color=ink, linewidth=1.2, marker="|", markersize=5)
    axis.set_xlim(0, 103)


def draw_pets(axis: "Axes", rows: Sequence[Named], places: Sequence[int], ink: str) -> None:
    """For each time, the share of PETs below it [%]; with the line below which one is severe."""
    known = [(name, np.sort(pets_of(cell)), place) for (name, cell), place in zip(rows, places, strict=True)]
    known = [one for one in known if len(one[1])]
    for name, values, place in known:
        colour, dash = LINES[place % len(LINES)]
        shares = 100 * np.arange(len(values) + 1) / len(values)
        axis.step(
            [min(0.0, values[0]), *values],
            shares,
            where="post",
            color=colour,
            linestyle=dash,
            label=name,
            linewidth=1.5,
        )
    axis.axvline(SEVERE, color=ink, linewidth=0.8, linestyle=(0, (4, 3)))
    axis.annotate("severe below 1.5 s", (SEVERE, 97), (4, 0), textcoords="offset points", fontsize=8, va="top")
    most = max(float(values[-1]) for _, values, _ in known)
    least = min(0.0, *(float(values[0]) for _, values, _ in known))
    axis.set(xlim=(least, min(max(most * 1.02, 2.0), 20.0)), ylim=(0, 100))


def draw_trade_off(axis: "Axes", rows: Sequence[Named], places: Sequence[int], ink: str) -> None:
    """Draw velocity against severe PETs; what is equal in velocity times the share of other PETs is joined."""
    known = [(name, place, trade_of(cell)) for (name, cell), place in zip(rows, places, strict=True)]
    placed = [(name, place, trade) for name, place, trade in known if trade is not None]
    for name, place, (velocity, severe) in placed:
        colour, mark = COLOURS[place % len(COLOURS)], MARKS[place % len(MARKS)]
        axis.plot([velocity], [severe], mark, color=colour, markersize=8, label=name, zorder=3)
    speeds, shares = (np.array([trade[k] for *_, trade in placed]) for k in (0, 1))
    beside = max(0.4, 0.12 * (speeds.max() - speeds.min()))
    axis.set(
        xlim=(speeds.min() - beside, speeds.max() + beside), ylim=(-0.05 * (top := max(5.0, 1.15 * shares.max())), top)
    )
    x, y = np.meshgrid(np.linspace(*axis.get_xlim(), 60), np.linspace(0.0, axis.get_ylim()[1], 60))
    worth = x * (1 - y / 100)
    lines = axis.contour(x, y, worth, 5, colors=ink, linewidths=0.6, alpha=0.45, zorder=1)
    axis.clabel(lines, fmt="%.2g m/s", fontsize=7)


def draw_performance(axis: "Axes", rows: Sequence[Named], places: Sequence[int], ink: str) -> None:
    """For each factor, the share of seeds that a row drives within it of the fastest row [%] (Dolan and More, 2002)."""
    times = [seconds_of(cell) for _, cell in rows]
    seeds = sorted(set.intersection(*map(set, times)))
    best = {seed: min(found[seed] for found in times) for seed in seeds}
    factors = [np.sort([found[s] / best[s] if np.isfinite(best[s]) else np.inf for s in seeds]) for found in times]
    finite = np.concatenate(factors)
    right = min(SLOWEST, max(1.1, 1.05 * finite[np.isfinite(finite)].max(initial=1.0)))
    for (name, _), place, found in zip(rows, places, factors, strict=True):
        colour, dash = LINES[place % len(LINES)]
        steps = found[found <= right]
        shares = 100 * np.arange(len(steps) + 1) / len(seeds)
        along, up = [1.0, *steps, right], [*shares, shares[-1]]
        axis.step(along, up, where="post", color=colour, linestyle=dash, label=name, linewidth=1.5)
    axis.set(xlim=(1, right), ylim=(-2, 102))
