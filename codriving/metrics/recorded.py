"""What is measured of trajectories alone, where nothing is known of the road: PET, contacts, TTC and DRAC."""

from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from codriving.datatypes import BLOCKER, Collision, Ending, Kind, Outcome, Pet, Track, Trajectory, TravelScore
from codriving.geometry import Footprint
from codriving.metrics.following import Closest, closest
from codriving.metrics.merging import box_separation, gap, way

# How far two footprints overlap when it counts as contact [m]; files round places to a centimetre.
DEEP = 0.02

_STANDS = 0.01  # Shorter moves from row to row are none [m]

_WINDOW = 256  # Steps that are compared at once: vehicles that never meet in long recordings cost nothing


def driven_pets(trajectory: Trajectory) -> tuple[Pet, ...]:
    """Return the PET of each pair of vehicles, at the place where the second enters the ground that the first drove on.

    Counted are pairs with a CAV that were recorded at the same time. One that starts or ends on the ground of the
    other, as those that follow one another or part do, has none.
    """
    pets = []
    tracks = [track for track in trajectory.tracks if len(track.x) > 1]
    boxes = [_box(track) for track in tracks]
    ways = [way(track, _moving(track), trajectory.step) for track in tracks]
    for (one, a, box), (other, b, box2) in combinations(zip(tracks, ways, boxes, strict=True), 2):
        if Kind.CAV not in (one.kind, other.kind) or not _together(one, other):
            continue
        if (box[0] > box2[1]).any() or (box2[0] > box[1]).any():
            continue
        if (found := gap(a, b, laps=True)) is not None:
            pets.append(Pet(found[0], found[1], "driven", found[2]))
    return tuple(pets)


def _box(track: Track) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Lower and upper corner of all that it drove on [m]."""
    places, half = np.array((track.x, track.y)), np.hypot(track.length, track.width) / 2
    return places.min(axis=1) - half, places.max(axis=1) + half


def _moving(track: Track) -> NDArray[np.intp]:
    """The rows at which it moves, and the first and last of each stop: the others say nothing of when it was where."""
    moves = np.hypot(np.diff(track.x), np.diff(track.y)) > _STANDS
    kept = np.concatenate(([True], moves)) | np.concatenate((moves, [True]))
    return np.flatnonzero(kept)


def _together(one: Track, other: Track) -> bool:
    return one.first_step < other.first_step + len(other.x) and other.first_step < one.first_step + len(one.x)


def closest_recorded(trajectory: Trajectory) -> Closest:
    """Return least TTC and largest DRAC of a recording of any length."""
    found = [
        closest(Trajectory(trajectory.step, tuple(map(_from_its_window, tracks)))) for tracks in _windows(trajectory)
    ]
    ttcs, dracs = ([value for one in found if (value := one[k]) is not None] for k in (0, 1))
    return Closest(min(ttcs, default=None), max(dracs, default=None))


def _from_its_window(track: Track) -> Track:
    """Count its steps from the beginning of the window: what is before takes no memory."""
    return replace(track, first_step=track.first_step % _WINDOW)


def outcome_of(trajectory: Trajectory) -> Outcome:
    """Judge a recording: it ends in a collision if the footprint of a CAV overlaps that of another vehicle.

    Whether all arrive it does not say.
    """
    last = max(track.first_step + len(track.x) - 1 for track in trajectory.tracks)
    contacts = [contact for tracks in _windows(trajectory) if (contact := _contact(tracks)) is not None]
    if not contacts:
        return Outcome(Ending.SUCCESS, last * trajectory.step, {})
    step, one, other = min(contacts, key=lambda contact: contact[0])
    time = step * trajectory.step
    # Who ran into whom is not judged: the faster one is named first.
    striker, struck = sorted((one, other), key=lambda track: -float(track.speed[step - track.first_step]))
    pair = "-".join(sorted((one.kind, other.kind)))
    return Outcome(Ending.COLLISION, last * trajectory.step, {}, Collision(time, striker.id, struck.id, pair))


def recorded_time(trajectory: Trajectory) -> float:
    """Return for how long vehicles were recorded [s]; the time between the cases of one file is none of theirs."""
    steps = np.unique(np.concatenate([track.first_step + np.arange(len(track.x)) for track in trajectory.tracks]))
    return float(np.count_nonzero(np.diff(steps) == 1) * trajectory.step)


def _contact(tracks: Sequence[Track]) -> tuple[int, Track, Track] | None:
    """The first contact of tracks, and its step."""
    found: tuple[int, Track, Track] | None = None
    for one, other in combinations(tracks, 2):
        if Kind.CAV not in (one.kind, other.kind):
            continue
        first = max(one.first_step, other.first_step)
        count = min(one.first_step + len(one.x), other.first_step + len(other.x)) - first
        if count <= 0:
            continue
        a, b = (slice(first - track.first_step, first - track.first_step + count) for track in (one, other))
        sizes = (Footprint(one.length, one.width), Footprint(other.length, other.width))
        offsets = other.x[b] - one.x[a], other.y[b] - one.y[a]
        apart = box_separation(*offsets, one.heading[a], other.heading[b], sizes)
        touching = np.flatnonzero(apart < -DEEP)
        if len(touching) and (found is None or first + touching[0] < found[0]):
            found = first + int(touching[0]), one, other
    return found


def _windows(trajectory: Trajectory) -> Iterator[list[Track]]:
    """Cut the tracks into stretches of time."""
    inside: dict[int, list[Track]] = defaultdict(list)
    for track in trajectory.tracks:
        end = track.first_step + len(track.x)
        for window in range(track.first_step // _WINDOW, (end - 1) // _WINDOW + 1):
            begin = max(window * _WINDOW, track.first_step)
            rows = slice(begin - track.first_step, (window + 1) * _WINDOW - track.first_step)
            columns = {name: getattr(track, name)[rows] for name in ("x", "y", "heading", "speed", "acceleration")}
            inside[window].append(replace(track, first_step=begin, action=(), **columns))
    yield from inside.values()


def driven_travels(tracks: Sequence[Track], step: float) -> tuple[TravelScore, ...]:
    """Return how each CAV travelled, until it arrived or as long as it was recorded."""
    found = []
    for track in tracks:
        times = step * np.arange(len(track.x))
        until = times[-1] if track.arrived is None else min(track.arrived - track.first_step * step, times[-1])
        if track.kind is not Kind.CAV or not until > 0:
            continue
        driven = np.concatenate(([0.0], np.cumsum(np.hypot(np.diff(track.x), np.diff(track.y)))))
        found.append(TravelScore(track.id, float(np.interp(until, times, driven)) / until, float(until), None))
    return tuple(found)


def who_count(trajectory: Trajectory) -> list[Track]:
    """Return the CAVs; who stands in the way of others because a scene has it so is none."""
    return [track for track in trajectory.tracks if track.kind is Kind.CAV and track.style != BLOCKER]
