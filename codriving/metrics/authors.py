"""The paper authors' own definitions, so that their published rows can be compared with.

An encounter is two logged vehicles that were at nearly the same place, at whatever times.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from codriving.datatypes import Ending, Metric, Outcome, Pet, Score, Track, Trajectory, TravelScore
from codriving.errors import ConfigError
from codriving.geometry import FloatArray, RoadMap


@dataclass(frozen=True, slots=True, eq=False)
class Log:
    """The logged rows of one vehicle, as in the authors' recordings."""

    id: str
    x: FloatArray  # Position relative to the middle of the intersection (n,) [m]
    y: FloatArray  # Position relative to the middle of the intersection (n,) [m]
    speed: FloatArray  # Speed (n,) [m/s]
    first_row: int = 0


@dataclass(frozen=True, slots=True)
class LoggedEncounter:
    """Two vehicles at nearly the same place."""

    one: str
    other: str
    row: int
    other_row: int


def encounters(logs: Sequence[Log], box: float, distance: float) -> tuple[LoggedEncounter, ...]:
    """Return the first encounter of every pair of vehicles that entered from different arms.

    The first is that of the earliest row of the one vehicle, and among these of the earliest row of the other.
    """
    found = []
    for one, other in combinations(logs, 2):
        if entry_arm(one) == entry_arm(other):
            continue
        rows, other_rows = _rows_inside(one, box), _rows_inside(other, box)
        apart = np.hypot(one.x[rows][:, None] - other.x[other_rows], one.y[rows][:, None] - other.y[other_rows])
        meetings = np.argwhere(apart < distance)
        if len(meetings):
            k, m = meetings[0].tolist()
            row, other_row = one.first_row + int(rows[k]), other.first_row + int(other_rows[m])
            found.append(LoggedEncounter(one.id, other.id, row, other_row))
    return tuple(found)


def entry_arm(log: Log) -> str:
    """Return the arm of the intersection that the first logged position lies on: ``+x``, ``-x``, ``+y`` or ``-y``."""
    x, y = float(log.x[0]), float(log.y[0])
    axis, value = ("x", x) if abs(x) > abs(y) else ("y", y)
    return ("+" if value > 0 else "-") + axis


def _rows_inside(log: Log, box: float) -> np.ndarray[tuple[int], np.dtype[np.intp]]:
    return np.flatnonzero((np.abs(log.x) < box) & (np.abs(log.y) < box))


class AuthorsMetrics(Metric):
    """Success, PET and velocity as recovered from the authors' recordings of the intersection.

    Every vehicle counts, human drivers too, and all of the log, second laps too. Positions are taken relative to the
    origin, which is the middle of the intersection; on roads without one there, PETs mean little.
    """

    name = "authors"

    def __init__(
        self, row_interval: float = 0.2, box: float = 10.0, distance: float = 1.0, rows: int | None = 60
    ) -> None:
        for key, value in {"row_interval": row_interval, "box": box, "distance": distance, "rows": rows}.items():
            if value is not None and not value > 0:
                raise ConfigError(f"metrics.{key} must be > 0, got {value:g}")
        self.row_interval, self.box, self.distance, self.rows = row_interval, box, distance, rows

    def score(self, trajectory: Trajectory, outcome: Outcome, road: RoadMap) -> Score:
        """Return the score of an episode."""
        return self.score_recording(trajectory, outcome)

    def score_recording(self, trajectory: Trajectory, outcome: Outcome) -> Score:
        """Return the score of trajectories; the road takes no part."""
        stride = max(1, round(self.row_interval / trajectory.step))
        logs = [log for log in (_log(track, stride) for track in trajectory.tracks) if len(log.x)]
        return self.score_logs(logs, outcome.ending is Ending.SUCCESS, stride * trajectory.step)

    def score_logs(self, logs: list[Log], success: bool, row_interval: float) -> Score:
        """Return the score of logged vehicles."""
        pets = []
        for met in encounters(logs, self.box, self.distance):
            order = (met.one, met.other) if met.row <= met.other_row else (met.other, met.one)
            pets.append(Pet(*order, "encounter", abs(met.row - met.other_row) * row_interval))
        travels = tuple(
            TravelScore(log.id, float(log.speed[: self.rows].mean()), (len(log.x) - 1) * row_interval, None)
            for log in logs
        )
        return Score(success, tuple(pets), travels)


def _log(track: Track, stride: int) -> Log:
    """Keep the rows of a track that fall on the rows of the authors' log."""
    skip = -track.first_step % stride
    rows = slice(skip, None, stride)
    return Log(track.id, track.x[rows], track.y[rows], track.speed[rows], (track.first_step + skip) // stride)
