"""The space-time diagram of an episode: for each CAV its way over time, and the ground that others block for it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import cycle
from typing import TYPE_CHECKING

import numpy as np

from codriving.datatypes import EpisodeRecord, Kind, Relation, Road, Track, Trajectory
from codriving.geometry import TRUE, FloatArray, RoadMap, progress, road_map
from codriving.reports import plain_settings, saved

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

MOST = 12  # CAVs that have a panel

BESIDE = 2.0  # Farther than this from the centre line of its route a vehicle is on another lane [m]

# Okabe and Ito (2008), each with a hatch: colour is never the only cue.
LOOKS = (
    *(("#0072b2", "////"), ("#d55e00", "\\\\\\\\"), ("#009e73", "...."), ("#cc79a7", "xxxx"), ("#e69f00", "----")),
    *(("#56b4e9", "||||"), ("#7a7a7a", "oooo"), ("#0072b2", "++++"), ("#d55e00", "...."), ("#009e73", "////")),
)


@dataclass(frozen=True, slots=True)
class BlockedGround:
    """The stretch of one's route on which one would touch another vehicle, over time."""

    other: str
    time: FloatArray  # (n,) [s]
    low: FloatArray  # Where the stretch begins (n,) [m], of the centre; NaN where nothing is blocked
    high: FloatArray  # Where it ends (n,) [m]


@dataclass(frozen=True, slots=True)
class WayOfCav:
    """One CAV along its route."""

    track: Track
    time: FloatArray  # (n,) [s]
    place: FloatArray  # Arc length of its centre (n,) [m]
    zones: tuple[tuple[float, float], ...]  # Where conflict zones with the others begin and end [m], apart
    blocked: tuple[BlockedGround, ...]


def ways_of(trajectory: Trajectory, road: RoadMap) -> list[WayOfCav]:
    """Work out what the diagram shows of each CAV."""
    places = {t.id: progress(road.paths[t.route], t.x, t.y, t.heading) for t in trajectory.tracks}
    found = []
    for ego in (track for track in trajectory.tracks if track.kind is Kind.CAV):
        spans, blocked = list[tuple[float, float]](), list[BlockedGround]()
        for other in (track for track in trajectory.tracks if track is not ego):
            s = places[other.id]
            px, py = road.paths[other.route].position(s)
            there = np.hypot(other.x - px, other.y - py) <= BESIDE
            for zone in road.zones(ego.route, other.route, TRUE):
                low, high = zone.blocked(s)
                free = ~there | ~np.isfinite(low) | ~np.isfinite(high) | (low >= high)
                if not free.all():
                    ends = (np.where(free, np.nan, side) for side in (low, high))
                    blocked.append(BlockedGround(other.id, _times(other, trajectory), *ends))
                if zone.relation is Relation.CROSSING or zone.merge_i is not None:
                    spans.append((zone.entry_i, zone.exit_i))
        place = places[ego.id]
        found.append(WayOfCav(ego, _times(ego, trajectory), place, _apart(spans), tuple(blocked)))
    return found


def _times(track: Track, trajectory: Trajectory) -> FloatArray:
    return np.asarray((track.first_step + np.arange(len(track.x))) * trajectory.step, dtype=np.float64)


def _apart(spans: Sequence[tuple[float, float]]) -> tuple[tuple[float, float], ...]:
    """Join what overlaps."""
    found = list[tuple[float, float]]()
    for start, end in sorted(spans):
        if found and start <= found[-1][1]:
            found[-1] = found[-1][0], max(end, found[-1][1])
        else:
            found.append((start, end))
    return tuple(found)


@plain_settings()
def space_time_figure(trajectory: Trajectory, record: EpisodeRecord, road: Road, name: str) -> Mapping[str, bytes]:
    """Draw a panel a CAV, of the first twelve.

    Returns:
        The content of ``<name>.png`` and ``<name>.svg``.
    """
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    ways = ways_of(trajectory, road_map(road))[:MOST]
    looks = dict(zip((track.id for track in trajectory.tracks), cycle(LOOKS), strict=False))
    columns = min(2, len(ways))
    rows = -(-len(ways) // columns)
    figure = Figure(figsize=(max(6.0, 4.8 * columns), 2.9 * rows + 0.9), layout="constrained")
    axes = figure.subplots(rows, columns, squeeze=False).flatten()
    last = max(float(way.time[-1]) for way in ways)
    handles: dict[str, Artist] = {
        "the CAV": Line2D([], [], color="#000000", linewidth=2.0),
        "conflict zone": Patch(facecolor="#e3e5e8", edgecolor="none"),
    }
    for axis, way in zip(axes, ways, strict=False):
        for other in _draw(axis, way, record, looks):
            colour, hatch = looks[other]
            handles[f"blocked by {other}"] = Patch(facecolor="none", edgecolor=colour, hatch=hatch)
        axis.set(title=f"{way.track.id}, {way.track.route}", xlim=(0, last))
        axis.title.set_fontsize(10)
    for axis in axes[len(ways) :]:
        axis.set_axis_off()
    for axis in axes[max(0, len(ways) - columns) : len(ways)]:
        axis.set_xlabel("time [s]")  # Below all panels it would lie under the legend
    figure.supylabel("place of its centre along its route [m]", fontsize=10)
    ordered = dict(sorted(handles.items(), key=lambda item: (item[0].startswith("blocked"), item[0])))
    heading = f"space-time - {record.scenario}, {record.method} {record.variant}".rstrip()
    return saved(figure, ordered, f"{heading}, seed {record.seed}: {record.outcome.ending.value}", name)


def _draw(axis: "Axes", way: WayOfCav, record: EpisodeRecord, looks: Mapping[str, tuple[str, str]]) -> list[str]:
    """Draw one panel; gives who blocks ground in it."""
    from matplotlib.patheffects import withStroke

    lowest, highest = float(way.place[0]) - 4.0, float(way.place[-1]) + 6.0
    halo = [withStroke(linewidth=2.5, foreground="#ffffff")]
    for start, end in way.zones:
        axis.axhspan(start, end, color="#e3e5e8", linewidth=0, zorder=0)
    named = dict[str, None]()
    for ground in way.blocked:
        seen = (ground.high >= lowest) & (ground.low <= highest) & np.isfinite(ground.low)
        if not seen.any():
            continue
        colour, hatch = looks[ground.other]
        axis.fill_between(
            ground.time, ground.low, ground.high, where=seen, facecolor=f"{colour}26", edgecolor=colour, hatch=hatch,
            linewidth=0.8, zorder=2,
        )  # fmt: skip
        if ground.other not in named:
            middle = int(np.flatnonzero(seen)[np.count_nonzero(seen) // 2])
            y = float(np.clip((ground.low[middle] + ground.high[middle]) / 2, lowest, highest))
            axis.text(
                ground.time[middle], y, ground.other, fontsize=7.5, ha="center", va="center", clip_on=True,
                path_effects=halo, zorder=4,
            )  # fmt: skip
        named[ground.other] = None
    axis.plot(way.time, way.place, color="#000000", linewidth=2.0, zorder=3)
    collision = record.outcome.collision
    if collision is not None and way.track.id in (collision.striker, collision.struck):
        at = float(np.interp(collision.time, way.time, way.place))
        axis.plot([collision.time], [at], "X", color="#d55e00", markeredgecolor="#ffffff", markersize=11, zorder=5)
        axis.annotate(
            "collision", (collision.time, at), (-8, 8), textcoords="offset points", ha="right", path_effects=halo
        )
    axis.set_ylim(lowest, highest)
    return list(named)
