"""What was driven as a tidy CSV, which carries the sizes and routes that a stored trajectory leaves to its record."""

import csv
import io

from codriving.datatypes import Trajectory

COLUMNS = ("time", "id", "kind", "route", "x", "y", "heading", "speed", "acceleration", "length", "width", "action")


def tidy_text(trajectory: Trajectory) -> str:
    """Write one row a vehicle and time, by time; metres, seconds and radians, y to the south."""
    rows = [
        (
            step,
            (track.id, track.kind.value, track.route),
            (
                track.x[k],
                track.y[k],
                track.heading[k],
                track.speed[k],
                track.acceleration[k],
                track.length,
                track.width,
            ),
            track.action[k],
        )
        for track in trajectory.tracks
        for k, step in enumerate(range(track.first_step, track.first_step + len(track.x)))
    ]
    rows.sort(key=lambda row: row[0])
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(COLUMNS)
    for step, who, numbers, action in rows:
        writer.writerow((_text(step * trajectory.step), *who, *map(_text, numbers), action))
    return out.getvalue()


def _text(value: float) -> str:
    # Adding zero turns -0.0 into 0.0.
    return f"{round(float(value), 4) + 0.0:.4f}"
