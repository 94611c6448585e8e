"""How calmly vehicles drive: hard braking, jerk, stops, and decisions that take back the one before."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from codriving.datatypes import Action, Track
from codriving.geometry import FloatArray

STANDS, DRIVES = 0.5, 2.0  # A stop begins below the one speed and ends above the other [m/s]

SPAN = 1.0  # Jerk is the change of acceleration in this time, as in ISO 15622 [s]


def hard_braking(tracks: Sequence[Track], step: float, limit: float) -> float | None:
    """Return the share of the driving time in which vehicles brake harder than a limit [m/s2]; None without any."""
    braking = np.concatenate([-_accelerations(track, step) for track in tracks] or [np.empty(0)])
    return float((braking > limit).mean()) if len(braking) else None


def hardest_braking(tracks: Sequence[Track], step: float) -> float | None:
    """Return how hard one of them brakes at most [m/s2], 0 if none does; None without driving."""
    braking = np.concatenate([-_accelerations(track, step) for track in tracks] or [np.empty(0)])
    return max(0.0, float(braking.max())) if len(braking) else None


def jerk(tracks: Sequence[Track], step: float) -> float | None:
    """Return the mean size of the change of acceleration within a second [m/s3]; None of shorter drives."""
    apart = max(1, round(SPAN / step))
    changes = [a[apart:] - a[:-apart] for a in (_accelerations(track, step) for track in tracks)]
    found = np.abs(np.concatenate(changes or [np.empty(0)]))
    return float(found.mean() / (apart * step)) if len(found) else None


def stops(tracks: Sequence[Track]) -> float | None:
    """Return how often a vehicle stops, on average; standing at the start is no stop. None without vehicles."""
    return sum(map(_stops, tracks)) / len(tracks) if tracks else None


def _stops(track: Track) -> int:
    # -1 once it stands, 1 once it drives again; what is between changes nothing.
    states = np.where(track.speed < STANDS, -1, np.where(track.speed > DRIVES, 1, 0))
    known = states[states != 0]
    return int(np.count_nonzero((known[:-1] == 1) & (known[1:] == -1)))


def reversals(tracks: Sequence[Track], step: float) -> float | None:
    """Return how often a minute of driving FASTER follows at once on SLOWER, or SLOWER on FASTER [1/min].

    None if no vehicle took actions.
    """
    if not any(any(track.action) for track in tracks):
        return None
    flips = sum(
        {before, after} == {Action.FASTER, Action.SLOWER}
        for track in tracks
        for before, after in pairwise(track.action)
    )
    minutes = sum(len(track.x) - 1 for track in tracks) * step / 60
    return flips / minutes if minutes > 0 else None


def _accelerations(track: Track, step: float) -> FloatArray:
    # Not what was commanded: a vehicle that stands and brakes does not brake.
    return np.asarray(np.diff(track.speed) / step)
