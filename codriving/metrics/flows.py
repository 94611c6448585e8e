"""What a flow is measured by: how many vehicles come through in its window, how late, and how safely."""

from collections.abc import Iterable, Mapping
from typing import NamedTuple

import numpy as np

from codriving.datatypes import FlowArrival, FlowLog, Kind, NamedNumber, Outcome, Track, Trajectory
from codriving.geometry import FloatArray, RoadMap, progress

HOUR, KILOMETRE = 3600.0, 1000.0


class _Window(NamedTuple):
    begins: float  # [s]
    ends: float  # [s]
    step: float  # [s]

    def holds(self, time: float) -> bool:
        """Whether a moment lies in the window, whose first moment belongs to the warm-up."""
        return self.begins + 1e-9 < time <= self.ends + 1e-9

    def rows(self, track: Track) -> slice:
        """The rows of a track from the beginning of the window to its end, both of them included."""
        first, last = (round(time / self.step) - track.first_step for time in (self.begins, self.ends))
        return slice(max(first, 0), max(last + 1, 0))


def flow_numbers(
    trajectory: Trajectory, outcome: Outcome, log: FlowLog, road: RoadMap, hard_braking: float
) -> tuple[NamedNumber, ...]:
    """Return the numbers of a flow, all of its window alone.

    Args:
        hard_braking: Braking above this is hard [m/s2].
    """
    window = _Window(log.begins, outcome.time, log.step)
    tracks = {track.id: track for track in trajectory.tracks}
    hours = (window.ends - window.begins) / HOUR
    wanted = [arrival for arrival in log.wanted if window.holds(arrival.time)]
    left = sum(map(window.holds, outcome.arrivals.values()))
    collisions = [collision for collision in log.collisions if window.holds(collision.time)]
    with_cav = sum(Kind.CAV in collision.pair for collision in collisions)
    ended = {*outcome.arrivals, *outcome.off_road}.union(*((c.striker, c.struck) for c in log.collisions)) & {*tracks}
    vehicles = sum(window.holds(_last(tracks[name], window)) for name in ended)
    off_road = sum(window.holds(_last(tracks[name], window)) for name in outcome.off_road)
    delays = [_delay(kind, log.wanted, tracks, trajectory.alone, road, window) for kind in (None, Kind.CAV, Kind.HDV)]
    driven, time, braking = _driven(trajectory.tracks, window, hard_braking)
    return (
        NamedNumber("demand", len(wanted) / hours, "1/h"),
        NamedNumber("throughput", left / hours, "1/h", "higher"),
        NamedNumber("delay", delays[0], "s", "lower"),
        NamedNumber("delay_cavs", delays[1], "s", "lower"),
        NamedNumber("delay_hdvs", delays[2], "s", "lower"),
        NamedNumber("collisions", float(len(collisions)), "", "lower"),
        NamedNumber("collisions_cavs", float(with_cav), "", "lower"),
        NamedNumber("off_road", float(off_road), "", "lower"),
        NamedNumber("vehicles", float(vehicles)),
        NamedNumber("collisions_per_1000", 1000 * len(collisions) / vehicles if vehicles else None, "", "lower"),
        NamedNumber("velocity", driven / time if time > 0 else None, "m/s", "higher"),
        NamedNumber("hard_braking", braking / (driven / KILOMETRE) if driven > 0 else None, "1/km", "lower"),
        NamedNumber("waiting", float(len(log.wanted) - len(tracks)), "", "lower"),
    )


def _last(track: Track, window: _Window) -> float:
    """When a vehicle was last on the road [s]."""
    return (track.first_step + len(track.x) - 1) * window.step


def _delay(
    kind: Kind | None,
    arrivals: Iterable[FlowArrival],
    tracks: Mapping[str, Track],
    alone: Mapping[str, FloatArray],
    road: RoadMap,
    window: _Window,
) -> float | None:
    """Return the time that vehicles lose in the window, outside and on the road, for each that wants to come in [s].

    Those who are still there at its end count as far as they got: a jam in which none arrives has no small delay.
    """
    chosen = [a for a in arrivals if kind in (None, a.kind)]
    wanted = sum(window.holds(arrival.time) for arrival in chosen)
    if not wanted or not alone:
        return None
    return sum(_lost(a, tracks.get(a.id), alone.get(a.id), road, window) for a in chosen) / wanted


def _lost(arrival: FlowArrival, track: Track | None, alone: FloatArray | None, road: RoadMap, window: _Window) -> float:
    """Return the time that a vehicle loses in the window, against driving the same way alone [s]."""
    if alone is None or (track is not None and alone[-1] < road.routes[track.route].goal):
        return 0.0
    begins = max(arrival.time, window.begins)
    ends = window.ends if track is None else min(_last(track, window), window.ends)
    if ends <= begins:
        return 0.0
    if track is None:
        return ends - begins
    steps = np.interp([_place(track, road, time, window) for time in (begins, ends)], alone, np.arange(len(alone)))
    return ends - begins - float(steps[1] - steps[0]) * window.step


def _place(track: Track, road: RoadMap, time: float, window: _Window) -> float:
    """Return the arc length at which a vehicle is; while it waits outside, that of its start [m]."""
    row = min(max(round(time / window.step) - track.first_step, 0), len(track.x) - 1)
    rows = slice(row, row + 1)
    return float(progress(road.paths[track.route], track.x[rows], track.y[rows], track.heading[rows])[0])


def _driven(tracks: Iterable[Track], window: _Window, limit: float) -> tuple[float, float, int]:
    """Return how far and how long all drive [m, s], and how often one begins to brake harder than a limit [m/s2]."""
    driven, steps, events = 0.0, 0, 0
    for track in tracks:
        rows = window.rows(track)
        x, y, speed = track.x[rows], track.y[rows], track.speed[rows]
        driven += float(np.hypot(np.diff(x), np.diff(y)).sum())
        steps += max(len(x) - 1, 0)
        hard = np.concatenate(([False], -np.diff(speed) / window.step > limit))
        events += int(np.count_nonzero(hard[1:] & ~hard[:-1]))
    return driven, steps * window.step, events
