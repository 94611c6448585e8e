"""``trajectory.csv``: every vehicle at every simulation step, one row each."""

import csv
from collections import defaultdict
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from codriving.datatypes import EpisodeRecord, Kind, Track, Trajectory
from codriving.runs.intact import TRAJECTORY
from codriving.runs.json_files import damaged, read_episode_text

COLUMNS = ("time", "id", "kind", "x", "y", "heading", "speed", "acceleration", "action")


def trajectory_text(trajectory: Trajectory) -> str:
    """Return CSV with a header, rows by time and then in the order of the tracks; metres, radians, seconds."""
    rows: dict[int, list[str]] = defaultdict(list)
    for track in trajectory.tracks:
        for step, row in enumerate(_track_rows(track, trajectory.step), start=track.first_step):
            rows[step].append(row)
    return "\n".join([",".join(COLUMNS), *(row for step in sorted(rows) for row in rows[step])]) + "\n"


def _track_rows(track: Track, step: float) -> list[str]:
    """The rows of one vehicle, in order of time."""
    time = (track.first_step + np.arange(len(track.x))) * step
    numbers = np.column_stack([time, track.x, track.y, track.heading, track.speed, track.acceleration])
    if not np.isfinite(numbers).all():
        raise ValueError(f"the trajectory of {track.id} holds a value that is not finite")
    # Adding zero turns -0.0 into 0.0, which would print differently.
    values = (np.round(numbers, 4) + 0.0).tolist()
    who = f"{track.id},{track.kind.value}"
    return [
        f"{t:.4f},{who},{x:.4f},{y:.4f},{h:.4f},{v:.4f},{a:.4f},{action}"
        for (t, x, y, h, v, a), action in zip(values, track.action, strict=True)
    ]


def read_trajectory(folder: Path, record: EpisodeRecord) -> Trajectory | None:
    """Read what was driven in one episode.

    Returns:
        The trajectory, with the sizes of a car; None if nothing was driven.

    Raises:
        RunFolderError: If it is damaged or cannot be read.
    """
    path = folder / TRAJECTORY
    if not path.exists():
        return None
    try:
        head, *rows = csv.reader(read_episode_text(path).splitlines())
        if tuple(head) != COLUMNS:
            raise ValueError(f"its columns are not {', '.join(COLUMNS)}")
        return _trajectory([dict(zip(COLUMNS, row, strict=True)) for row in rows], record)
    except ValueError as error:
        raise damaged(path, str(error)) from error


def _trajectory(rows: Sequence[Mapping[str, str]], record: EpisodeRecord) -> Trajectory | None:
    times = sorted({float(row["time"]) for row in rows})
    if (flow := record.outcome.flow) is not None:
        step = flow.step  # Its road may be empty for a while, or all the time
    elif not times:
        return None
    else:
        # Over the whole episode, since a single time is rounded.
        step = (times[-1] - times[0]) / (len(times) - 1) if len(times) > 1 else 1.0
    driven: dict[str, list[Mapping[str, str]]] = defaultdict(list)
    for row in rows:
        driven[row["id"]].append(row)
    members = {member.id: member for member in record.participants}
    tracks = []
    for name, own in sorted(driven.items()):
        if name not in members:
            raise ValueError(f"{name} is not in the record")
        numbers = np.array([[float(row[column]) for column in COLUMNS[3:8]] for row in own])
        first, last = (round(float(row["time"]) / step) for row in (own[0], own[-1]))
        if last - first != len(own) - 1 or not np.isfinite(numbers).all():
            raise ValueError(f"the rows of {name} are not complete")
        x, y, heading, speed, acceleration = numbers.T
        kind, member, actions = Kind(own[0]["kind"]), members[name], tuple(row["action"] for row in own)
        motion = (x, y, heading, speed, acceleration, actions, member.arrived)
        tracks.append(Track(name, kind, member.route, first, *motion, style=member.style))
    return Trajectory(step, tuple(tracks))
