"""The authors' encounters: two logged vehicles that were at nearly the same place, at whatever times."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from codriving.geometry.curve import FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class Log:
    """The logged rows of one vehicle, as in the authors' recordings.

    Attributes:
        x: Position relative to the middle of the intersection (n,) [m].
        y: Position relative to the middle of the intersection (n,) [m].
        speed: Speed (n,) [m/s].
    """

    id: str
    x: FloatArray
    y: FloatArray
    speed: FloatArray
    first_row: int = 0


@dataclass(frozen=True, slots=True)
class Encounter:
    """Two vehicles at nearly the same place."""

    one: str
    other: str
    row: int
    other_row: int


def encounters(logs: Sequence[Log], box: float, distance: float) -> tuple[Encounter, ...]:
    """Return the first encounter of every pair of vehicles that entered from different arms.

    The first is that of the earliest row of the one vehicle, and among these of the earliest row of the other.

    Args:
        box: Half the side of the square around the middle in which encounters count [m].
        distance: Distance between the two centres below which they meet [m].
    """
    found = []
    for one, other in combinations(logs, 2):
        if entry_arm(one) == entry_arm(other):
            continue
        rows, other_rows = _rows_inside(one, box), _rows_inside(other, box)
        apart = np.hypot(
            one.x[rows][:, None] - other.x[other_rows],
            one.y[rows][:, None] - other.y[other_rows],
        )
        meetings = np.argwhere(apart < distance)
        if len(meetings):
            k, m = meetings[0].tolist()
            found.append(
                Encounter(one.id, other.id, one.first_row + int(rows[k]), other.first_row + int(other_rows[m]))
            )
    return tuple(found)


def entry_arm(log: Log) -> str:
    """Return the arm of the intersection that the first logged position lies on: ``+x``, ``-x``, ``+y`` or ``-y``."""
    x, y = float(log.x[0]), float(log.y[0])
    axis, value = ("x", x) if abs(x) > abs(y) else ("y", y)
    return ("+" if value > 0 else "-") + axis


def _rows_inside(log: Log, box: float) -> np.ndarray[tuple[int], np.dtype[np.intp]]:
    return np.flatnonzero((np.abs(log.x) < box) & (np.abs(log.y) < box))
