"""Trajectories from anywhere as those of an episode: tracks on one clock, and what had to be left out or guessed."""

from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from codriving.datatypes import Kind, Track, Trajectory
from codriving.errors import RecordingError

Numbers = NDArray[np.float64]

SIZE = (5.0, 2.0)  # Length and width where a file has none [m]

# A share of a step by which a time may be off its place on the clock: files round their times.
_OFF = 0.25

# Distance by positions over distance by speeds; outside, one of the two is in another unit.
_LEAST, _MOST = 0.4, 2.5

_FAR = 20.0  # Distance from which on the two are compared [m]


@dataclass(frozen=True, slots=True)
class Recording:
    """The motion of all vehicles of one file."""

    name: str
    trajectory: Trajectory
    marked: bool  # Whether it says which vehicles are CAVs; else all of its tracks count, and are called CAVs
    notes: tuple[str, ...] = ()


class Rows(NamedTuple):
    """One row a vehicle and time, in any order; None for a column that the file does not have."""

    time: Numbers  # (n,) [s]
    id: NDArray[np.object_]
    x: Numbers  # Centre (n,) [m]
    y: Numbers  # Centre (n,) [m]
    heading: Numbers | None = None  # (n,) [rad]
    speed: Numbers | None = None  # (n,) [m/s]
    acceleration: Numbers | None = None  # (n,) [m/s2]
    cav: NDArray[np.bool_] | None = None  # Whether it is a CAV (n,)
    length: Numbers | None = None  # (n,) [m]
    width: Numbers | None = None  # (n,) [m]


def recording(path: Path, rows: Rows, notes: tuple[str, ...] = (), step: float | None = None) -> Recording:
    """Put rows on one clock, a track for each vehicle.

    What is not given is worked out: headings and speeds from positions, accelerations from speeds.

    Args:
        step: Time between two rows [s]; None finds it.

    Raises:
        RecordingError: If it is empty, a vehicle is twice at one time, or times or units cannot be.
    """
    if not len(rows.time):
        raise RecordingError(f"{path} has no row of a vehicle; give a file with trajectories")
    names = list(dict.fromkeys(rows.id.tolist()))
    number = {name: k for k, name in enumerate(names)}
    whose = np.array([number[name] for name in rows.id.tolist()], dtype=np.intp)
    order = np.lexsort((rows.time, whose))
    rows = _chosen(rows, order)
    whose = whose[order]
    bounds = [0, *(np.flatnonzero(np.diff(whose)) + 1).tolist(), len(whose)]
    step, places = _clock(path, rows, whose, step)
    tracks, broken = [], []
    for name, first, last in zip(names, bounds, bounds[1:], strict=False):
        gaps = np.flatnonzero(np.diff(places[first:last]) > 1) + 1 + first
        if len(gaps):
            broken.append(name)
        ends = [first, *gaps.tolist(), last]
        for part, (begin, end) in enumerate(pairwise(ends), start=1):
            own = _chosen(rows, slice(begin, end))
            tracks.append(_track(name if part == 1 else f"{name}#{part}", own, int(places[begin]), step))
    _check_units(path, tracks, step, rows.speed is not None)
    if broken:
        notes = (*notes, f"missing times: {shown(broken)} is gone for a while, and is another vehicle after that")
    return Recording(str(path), Trajectory(step, tuple(tracks)), rows.cav is not None, notes)


def shown(names: list[str]) -> str:
    """Name the first few."""
    return ", ".join(names[:6]) + (f" and {len(names) - 6} more" if len(names) > 6 else "")


def _chosen(rows: Rows, which: NDArray[np.intp] | slice) -> Rows:
    columns: list[Any] = list(rows)
    chosen: list[Any] = [None if column is None else column[which] for column in columns]
    return Rows(*chosen)


def _clock(path: Path, rows: Rows, whose: NDArray[np.intp], step: float | None) -> tuple[float, NDArray[np.intp]]:
    """Return the time between two rows [s], and the number of the step of each row."""
    apart = np.diff(rows.time)[np.diff(whose) == 0]
    if len(apart) and not apart.min() > 1e-6:
        row = int(np.flatnonzero((np.diff(whose) == 0) & (np.diff(rows.time) <= 1e-6))[0])
        raise RecordingError(
            f"{path}: vehicle {rows.id[row]} has two rows at {rows.time[row]:g} s; keep one row a vehicle and time"
        )
    start, end = float(rows.time.min()), float(rows.time.max())
    if step is None:
        step = float(np.median(apart)) if len(apart) else 1.0
        # Over the whole file, since a single time is rounded.
        step = (end - start) / max(1, round((end - start) / step)) if end > start else step
    places = np.asarray(np.rint((rows.time - start) / step), dtype=np.intp)
    off = np.abs(rows.time - start - places * step)
    if off.max() > _OFF * step:
        row = int(off.argmax())
        raise RecordingError(
            f"{path}: times are not {step:g} s apart, as that of vehicle {rows.id[row]} at {rows.time[row]:g} s; "
            "resample the file to even steps"
        )
    return step, places


def _track(name: str, rows: Rows, first_step: int, step: float) -> Track:
    x, y = rows.x, rows.y
    dx, dy = (np.gradient(values) if len(values) > 1 else np.zeros(1) for values in (x, y))
    speed = np.hypot(dx, dy) / step if rows.speed is None else rows.speed
    if rows.acceleration is not None:
        acceleration = rows.acceleration
    else:
        acceleration = np.gradient(speed) / step if len(speed) > 1 else np.zeros(1)
    length, width = (
        default if size is None else float(size[0])
        for size, default in zip((rows.length, rows.width), SIZE, strict=True)
    )
    kind = Kind.CAV if rows.cav is None or rows.cav[0] else Kind.HDV
    heading = _headings(dx, dy) if rows.heading is None else rows.heading
    motion = (x, y, heading, speed, acceleration)
    return Track(name, kind, "", first_step, *motion, ("",) * len(x), None, length, width)


def _headings(dx: Numbers, dy: Numbers) -> Numbers:
    """Headings by motion (n,) [rad]; one that stands looks where it last drove, or will drive first."""
    moved = np.flatnonzero(np.hypot(dx, dy) > 0.01)
    if not len(moved):
        return np.zeros(len(dx))
    latest = np.searchsorted(moved, np.arange(len(dx)), side="right") - 1
    rows = moved[np.maximum(latest, 0)]
    return np.asarray(np.arctan2(dy[rows], dx[rows]))


def _check_units(path: Path, tracks: list[Track], step: float, given: bool) -> None:
    """Refuse speeds in km/h and positions in degrees."""
    by_place = sum(float(np.hypot(np.diff(track.x), np.diff(track.y)).sum()) for track in tracks)
    by_speed = sum(float((track.speed[1:] + track.speed[:-1]).sum()) * step / 2 for track in tracks)
    if given and max(by_place, by_speed) > _FAR and not _LEAST < by_place / max(by_speed, 1e-9) < _MOST:
        raise RecordingError(
            f"{path}: positions and speeds do not agree (all vehicles drive {by_place:.4g} m by the one, "
            f"{by_speed:.4g} m by the other); positions must be in metres, not degrees, speeds in m/s and times in s"
        )
