"""``trajectory.csv``: every vehicle at every simulation step, one row each."""

from collections import defaultdict

import numpy as np

from codriving.datatypes.trajectory import Track, Trajectory

TRAJECTORY = "trajectory.csv"
COLUMNS = ("time", "id", "kind", "x", "y", "heading", "speed", "acceleration", "action")


def trajectory_text(trajectory: Trajectory) -> str:
    """Give the content of ``trajectory.csv``.

    Args:
        trajectory: What was driven.

    Returns:
        CSV with a header, rows by time and then in the order of the tracks; metres, radians, seconds to 4 decimals.

    Raises:
        ValueError: If a value is not finite.
    """
    rows: dict[int, list[str]] = defaultdict(list)
    for track in trajectory.tracks:
        for step, row in enumerate(_track_rows(track, trajectory.step), start=track.first_step):
            rows[step].append(row)
    lines = [",".join(COLUMNS)]
    for step in sorted(rows):
        lines.extend(rows[step])
    return "\n".join(lines) + "\n"


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
