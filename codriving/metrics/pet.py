"""Post-encroachment time: how long the conflict area stayed empty between two vehicles."""

import math
from collections.abc import Sequence
from functools import cache
from itertools import combinations
from typing import NamedTuple

import numpy as np

from codriving.datatypes import Kind, Pet, Relation, Track, Trajectory
from codriving.geometry import TRUE, ConflictZone, FloatArray, Path, RoadMap, progress
from codriving.metrics.merging import merging_gap

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

    @cache
    def places(track_id: str) -> FloatArray:
        track = tracks[track_id]
        return progress(road.paths[track.route], track.x, track.y, track.heading)

    tracks = {track.id: track for track in trajectory.tracks}
    pets = []
    for one, other in combinations(trajectory.tracks, 2):
        if Kind.CAV not in (one.kind, other.kind):
            continue
        zones = road.zones(one.route, other.route, TRUE)
        for zone in filter(has_area, zones):
            measure = _merging if zone.merge_i is not None else _crossing
            found = measure(zone, zones, (one, other), (places(one.id), places(other.id)), road, trajectory.step)
            if found is not None:
                pets.append(Pet(*found[:2], str(zone.relation), found[2]))
    return tuple(pets)


def has_area(zone: ConflictZone) -> bool:
    """Tell whether two routes cross or merge in a zone, and do not only follow one another or part."""
    return zone.relation is Relation.CROSSING or zone.merge_i is not None


def _merging(
    zone: ConflictZone,
    zones: Sequence[ConflictZone],
    tracks: tuple[Track, Track],
    places: tuple[FloatArray, FloatArray],
    road: RoadMap,
    step: float,
) -> tuple[str, str, float] | None:
    """Who merged first, who second, and the time between; between the zone before and the end of this one."""
    start_i = max((z.exit_i for z in zones if z.exit_i <= zone.entry_i), default=-math.inf)
    start_j = max((z.exit_j for z in zones if z.exit_j <= zone.entry_j), default=-math.inf)
    end_i, end_j = (math.inf if split is None else split for split in (zone.split_i, zone.split_j))
    rows, other_rows = (
        slice(int(np.searchsorted(s, start)), int(np.searchsorted(s, end)))
        for s, start, end in zip(places, (start_i, start_j), (end_i, end_j), strict=True)
    )
    return merging_gap(*tracks, rows, other_rows, step)


def _crossing(
    zone: ConflictZone,
    zones: Sequence[ConflictZone],
    tracks: tuple[Track, Track],
    places: tuple[FloatArray, FloatArray],
    road: RoadMap,
    step: float,
) -> tuple[str, str, float] | None:
    """Who crossed first, who second, and the time from the one's leaving the area to the other's entering it."""
    passages = [
        _passage(track, s, area, road.paths[track.route], step)
        for track, s, area in zip(
            tracks, places, ((zone.entry_i, zone.exit_i), (zone.entry_j, zone.exit_j)), strict=True
        )
    ]
    complete = sorted(passage for passage in passages if passage is not None)
    if len(complete) < 2:
        return None
    first, second = complete
    return first.id, second.id, second.entry - first.exit


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
