"""SUMO's floating car data, ``fcd-export``: read and written.

There a place is that of the middle of the front bumper, y grows to the north, and angles are those of a compass.
"""

import gzip
import zlib
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from typing import IO
from xml.sax.saxutils import quoteattr

import numpy as np

from codriving.datatypes import Track, Trajectory
from codriving.errors import RecordingError
from codriving.recordings.recording import SIZE, Numbers, Recording, Rows, recording

_NUMBERS = ("x", "y", "angle", "speed")


def read_fcd(path: Path) -> Recording:
    """Read a file, packed or not; vehicles whose type has ``cav`` in its name are the CAVs, if any has.

    Raises:
        RecordingError: If it is no such file.
    """
    ids, types, numbers = list[str](), list[str](), list[tuple[float, ...]]()
    persons = 0
    try:
        with _opened(path) as file:
            for time, tag, attributes in _elements(path, file):
                if tag != "vehicle":
                    persons += 1
                    continue
                where = f"{path}: vehicle {attributes.get('id', '?')} at {time:g} s"
                for name in ("id", *_NUMBERS):
                    if name not in attributes:
                        raise RecordingError(f"{where} has no {name}; let SUMO write it (--fcd-output.attributes)")
                ids.append(attributes["id"])
                types.append(attributes.get("type", ""))
                numbers.append((time, *(_number(where, name, attributes[name]) for name in _NUMBERS)))
    except (OSError, EOFError, zlib.error) as error:
        raise RecordingError(
            f"cannot read {path}: {getattr(error, 'strerror', '') or error}; give another file"
        ) from error
    times, x, y, angle, speed = np.array(numbers, dtype=np.float64).reshape(-1, 5).T
    heading = np.radians(angle) - np.pi / 2
    # To the centre, and to our axes, in which y grows to the south.
    x, y = x - SIZE[0] / 2 * np.cos(heading), -y - SIZE[0] / 2 * np.sin(heading)
    marks = np.array(["cav" in kind.lower() for kind in types], dtype=np.bool_)
    notes: tuple[str, ...] = ("the file has no sizes: vehicles of 5 m x 2 m are taken",)
    notes += (f"{persons} rows of persons are left out",) if persons else ()
    rows = Rows(times, np.array(ids, dtype=object), x, y, heading, speed, cav=marks if marks.any() else None)
    return recording(path, rows, notes)


def _opened(path: Path) -> IO[bytes] | gzip.GzipFile:
    return gzip.open(path) if path.suffix.lower() == ".gz" else path.open("rb")


def _elements(path: Path, file: IO[bytes] | gzip.GzipFile) -> Iterator[tuple[float, str, dict[str, str]]]:
    # Python's own parser would expand entities, which a file of a few lines can use to fill the memory.
    from defusedxml.common import DefusedXmlException
    from defusedxml.ElementTree import ParseError, iterparse

    try:
        root = None
        for event, element in iterparse(file, events=("start", "end"), forbid_dtd=True):
            if root is None:
                root = element
                if element.tag != "fcd-export":
                    raise RecordingError(f"{path} is no fcd-export of SUMO: its root is {element.tag[:40]}")
            if event == "end" and element.tag == "timestep":
                if "time" not in element.attrib:
                    raise RecordingError(f"{path}: a timestep has no time")
                time = _number(str(path), "time", element.attrib["time"])
                yield from ((time, child.tag, dict(child.attrib)) for child in element)
                root.clear()
    except ParseError as error:
        raise RecordingError(f"{path} is no XML that can be read ({error}); write it anew") from error
    except DefusedXmlException as error:
        raise RecordingError(f"{path} defines a document type or entities, which no file of SUMO does") from error


def _number(where: str, name: str, text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = np.nan
    if not np.isfinite(value):
        raise RecordingError(f"{where}, {name}: {text[:40]!r} is no number; times are written in seconds")
    return value


def fcd_text(trajectory: Trajectory) -> str:
    """Write what was driven as SUMO's ``--fcd-output`` does; the type of a vehicle is ``CAV`` or ``HDV``."""
    steps: dict[int, list[str]] = defaultdict(list)
    for track in trajectory.tracks:
        for step, row in enumerate(_rows(track), start=track.first_step):
            steps[step].append(row)
    lines = ['<?xml version="1.0" encoding="UTF-8"?>', "<fcd-export>"]
    for step in sorted(steps):
        lines += [f'    <timestep time="{step * trajectory.step:.4f}">', *steps[step], "    </timestep>"]
    return "\n".join([*lines, "</fcd-export>"]) + "\n"


def _rows(track: Track) -> Iterator[str]:
    front = track.length / 2
    x, y = track.x + front * np.cos(track.heading), -(track.y + front * np.sin(track.heading))
    angle = np.remainder(np.degrees(track.heading) + 90.0, 360.0)
    columns: tuple[Numbers, ...] = (x, y, angle, np.maximum(track.speed, 0.0), track.acceleration)
    values = (np.round(np.column_stack(columns), 4) + 0.0).tolist()
    who = f"id={quoteattr(track.id)}"
    for px, py, a, v, acceleration in values:
        yield (
            f'        <vehicle {who} x="{px:.4f}" y="{py:.4f}" angle="{a:.4f}" type="{track.kind.value}" '
            f'speed="{v:.4f}" pos="0.00" lane="" slope="0.00" acceleration="{acceleration:.4f}"/>'
        )
