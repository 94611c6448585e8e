"""What the others cost each vehicle: its time against that of driving the same route alone."""

from bisect import bisect_left
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from codriving.datatypes import Kind, Track, Trajectory
from codriving.geometry import Path, RoadMap, progress


class TimedDrive(NamedTuple):
    """How long one vehicle took as far as it got, and how long it would have taken alone."""

    kind: Kind
    time: float  # [s]
    alone: float  # Alone, as far as it got [s]
    route: float  # Alone, to the goal of its route [s]

    @property
    def delay(self) -> float:
        """What it took longer [s]."""
        return self.time - self.alone

    @property
    def whole(self) -> float:
        """Its travel time, if it drives what is left of its route alone [s]."""
        return self.route + self.delay


def drives(trajectory: Trajectory, road: RoadMap) -> tuple[TimedDrive, ...]:
    """Return the drive of each vehicle to the goal of its route, or as far as it got."""
    found = []
    for track in trajectory.tracks:
        alone = trajectory.alone.get(track.id)
        goal = road.routes[track.route].goal
        if alone is None or alone[-1] < goal or len(track.x) < 2:
            continue
        steps, place = _reached(track, road.paths[track.route], goal)
        there, arrives = (trajectory.step * np.interp([place, goal], alone, np.arange(len(alone)))).tolist()
        if steps > 0:
            found.append(TimedDrive(track.kind, steps * trajectory.step, there, arrives))
    return tuple(found)


def _reached(track: Track, path: Path, goal: float) -> tuple[float, float]:
    """After how many steps a vehicle is at the goal, and the goal [m]; or as far as it got."""

    def place(row: int) -> float:
        rows = slice(row, row + 1)
        return float(progress(path, track.x[rows], track.y[rows], track.heading[rows])[0])

    last = len(track.x) - 1
    if (end := place(last)) < goal:
        return last, end
    # No vehicle drives backwards.
    row = bisect_left(range(last), goal, lo=1, key=place)
    before, after = place(row - 1), place(row)
    return row - 1 + (goal - before) / (after - before) if before < goal < after else row, goal


def jain(shares: Sequence[float]) -> float | None:
    """Return Jain's index of fairness, (sum x)^2 / (n sum x^2), from 1/n to 1 (Jain, Chiu and Hawe, 1984).

    If none gets anything, all get the same: 1. None without any.
    """
    if not shares:
        return None
    squares = len(shares) * sum(share * share for share in shares)
    return sum(shares) ** 2 / squares if squares else 1.0
