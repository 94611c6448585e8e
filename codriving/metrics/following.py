"""How close one vehicle comes behind another: time to collision, and the braking that avoids it."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from codriving.datatypes import Kind, Track, Trajectory
from codriving.geometry import FloatArray

_ALIKE = np.cos(np.pi / 4)  # Vehicles whose headings differ by more than 45 degrees do not follow one another


class Closest(NamedTuple):
    """The worst moment of an episode; None if no vehicle came closer to the one ahead."""

    ttc: float | None  # Least time to collision [s]
    drac: float | None  # Largest deceleration rate to avoid a crash [m/s2]


def closest(trajectory: Trajectory) -> Closest:
    """Return least TTC (Hayward, 1972) and largest DRAC (Cooper and Ferguson, 1976) of pairs with a CAV.

    With the gap d between two footprints along the heading of the one behind, and its speed u > 0 towards the other,
    TTC = d / u and DRAC = u^2 / 2d. Both are of vehicles of which one would run into the other if it went straight on.
    """
    tracks = trajectory.tracks
    pairs = [
        (i, j)
        for i, one in enumerate(tracks)
        for j, other in enumerate(tracks)
        if i != j and Kind.CAV in (one.kind, other.kind)
    ]
    if not pairs:
        return Closest(None, None)
    x, y, heading, speed = _side_by_side(tracks)
    length, width = (np.array([[getattr(track, name)] for track in tracks]) for name in ("length", "width"))
    behind, ahead = np.array(pairs).T
    cos, sin = np.cos(heading), np.sin(heading)
    dx, dy = x[ahead] - x[behind], y[ahead] - y[behind]
    along, across = cos[behind] * dx + sin[behind] * dy, np.abs(cos[behind] * dy - sin[behind] * dx)
    # Not a number where one of the two is not on the road: no comparison holds.
    pair, row = np.nonzero((along > 0) & (across < length.max() + width.max()))
    behind, ahead, along, across = behind[pair], ahead[pair], along[pair, row], across[pair, row]
    turn = heading[ahead, row] - heading[behind, row]
    c, s = np.cos(turn), np.abs(np.sin(turn))
    half = (np.abs(c) * length[ahead, 0] + s * width[ahead, 0]) / 2
    side = (s * length[ahead, 0] + np.abs(c) * width[ahead, 0]) / 2
    gap, towards = along - length[behind, 0] / 2 - half, speed[behind, row] - c * speed[ahead, row]
    follows = (across < width[behind, 0] / 2 + side) & (c > _ALIKE) & (gap > 0) & (towards > 0)
    if not follows.any():
        return Closest(None, None)
    gap, towards = gap[follows], towards[follows]
    return Closest(float((gap / towards).min()), float((towards**2 / (2 * gap)).max()))


def _side_by_side(tracks: Sequence[Track]) -> tuple[FloatArray, ...]:
    """Put the tracks below one another (vehicles, steps), NaN where a vehicle is not on the road."""
    names = ("x", "y", "heading", "speed")
    steps = max(track.first_step + len(track.x) for track in tracks)
    made = np.full((len(names), len(tracks), steps), np.nan)
    for k, track in enumerate(tracks):
        for values, name in zip(made, names, strict=True):
            values[k, track.first_step : track.first_step + len(track.x)] = getattr(track, name)
    return tuple(made)
