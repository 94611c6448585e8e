"""Post-encroachment time: how long the conflict area stayed empty between two vehicles."""

from itertools import combinations
from typing import NamedTuple

import numpy as np

from codriving.datatypes import Kind, Pet, Relation, Track, Trajectory
from codriving.geometry import TRUE, ConflictZone, FloatArray, Path, RoadMap, progress

BESIDE = 2.0  # Farther than this from the centre line of its route a vehicle is on another lane [m]


class Passage(NamedTuple):
    """When a vehicle was in a conflict area."""

    entry: float  # Time of entering [s]
    exit: float  # Time of leaving [s]
    id: str


def post_encroachment_times(trajectory: Trajectory, road: RoadMap) -> tuple[Pet, ...]:
    """Return the time between the first leaving and the second entering of every conflict area that two passed.

    Counted are pairs with at least one CAV whose routes cross or merge; each conflict area of a pair, first pass only.
    A pair of which one did not pass the area is absent. The value is negative if both were in the area at once.
    """
    places = {t.id: progress(road.paths[t.route], t.x, t.y, t.heading) for t in trajectory.tracks}
    pets = []
    for one, other in combinations(trajectory.tracks, 2):
        if Kind.CAV not in (one.kind, other.kind):
            continue
        for zone in road.zones(one.route, other.route, TRUE):
            areas = _areas(zone, one.length, other.length)
            if areas is None:
                continue
            passages = [
                _passage(track, places[track.id], area, road.paths[track.route], trajectory.step)
                for track, area in zip((one, other), areas, strict=True)
            ]
            complete = sorted(passage for passage in passages if passage is not None)
            if len(complete) == 2:
                first, second = complete
                pets.append(Pet(first.id, second.id, str(zone.relation), second.entry - first.exit))
    return tuple(pets)


def _areas(
    zone: ConflictZone, length_i: float, length_j: float
) -> tuple[tuple[float, float], tuple[float, float]] | None:
    """Return the stretch of each route [m] on which a centre is while the vehicle is in the conflict area."""
    if zone.relation is Relation.CROSSING:
        return (zone.entry_i, zone.exit_i), (zone.entry_j, zone.exit_j)
    # Only routes that converge or weave have a merge point.
    if zone.merge_i is not None and zone.merge_j is not None:
        return (
            (zone.merge_i - length_i / 2, zone.merge_i + length_i / 2),
            (zone.merge_j - length_j / 2, zone.merge_j + length_j / 2),
        )
    return None


def _passage(track: Track, s: FloatArray, area: tuple[float, float], path: Path, step: float) -> Passage | None:
    """Return when a track passed through a stretch of its route, or None if it did not come from before to beyond."""
    start, end = area
    if not (s[0] <= start and s[-1] >= end):
        return None
    inside = slice(int(np.searchsorted(s, start)), int(np.searchsorted(s, end)) + 1)
    px, py = path.position(s[inside])
    if np.any(np.hypot(track.x[inside] - px, track.y[inside] - py) > BESIDE):
        return None
    return Passage(_time_at(track, s, start, step), _time_at(track, s, end, step), track.id)


def _time_at(track: Track, s: FloatArray, place: float, step: float) -> float:
    """Return when a track first reached a place on its route [s], interpolated between two rows."""
    row = int(np.searchsorted(s, place))
    if row == 0:
        return track.first_step * step
    share = (place - s[row - 1]) / (s[row] - s[row - 1])
    return float((track.first_step + row - 1 + share) * step)
