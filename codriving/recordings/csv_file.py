"""Trajectories in CSV: ours, tidy tables from anywhere, and the tracks of INTERACTION, inD and its sisters."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from codriving.errors import RecordingError
from codriving.recordings.recording import Numbers, Recording, Rows, recording, shown

if TYPE_CHECKING:
    from pandas import DataFrame, Series

# Columns by which a layout is known; all of them are needed.
TIDY = ("time", "id", "x", "y")
INTERACTION = ("track_id", "frame_id", "timestamp_ms", "agent_type", "x", "y", "vx", "vy", "psi_rad", "length", "width")
IND = ("trackId", "frame", "xCenter", "yCenter", "heading", "width", "length", "xVelocity", "yVelocity")

FRAME_RATE = 25.0  # Of inD, rounD, uniD and exiD, where no file says another one [1/s]

_MOTOR = {"car", "truck", "bus", "van", "truck_bus", "trailer", "motorcycle"}

_APART = 3600.0  # Time between the cases of one file, which have nothing to do with one another [s]


def read_csv(path: Path) -> Recording:
    """Read a file, by whichever of the layouts its columns are of.

    Raises:
        RecordingError: If it is of none, or a value cannot be read; with file and column.
    """
    frame = _frame(path)
    for needed, read in ((TIDY, _tidy), (INTERACTION, _interaction), (IND, _ind)):
        if set(needed) <= set(frame.columns):
            return read(path, frame)
    missing = {name: [c for c in needed if c not in frame.columns] for name, needed in _LAYOUTS.items()}
    nearest = min(missing, key=lambda name: len(missing[name]) / len(_LAYOUTS[name]))
    raise RecordingError(
        f"{path}: column {', '.join(missing[nearest])} is missing for {nearest}; columns: {shown(list(frame.columns))}"
    )


_LAYOUTS = {"a tidy CSV": TIDY, "the tracks of INTERACTION": INTERACTION, "the tracks of inD": IND}


def _tidy(path: Path, frame: "DataFrame") -> Recording:
    def given(column: str) -> Numbers | None:
        return _numbers(path, frame, column) if column in frame.columns else None

    cav = None
    if "kind" in frame.columns:
        kinds = frame["kind"].fillna("").str.upper()
        if not kinds.isin(["CAV", "HDV"]).all():
            row = int(np.flatnonzero(~kinds.isin(["CAV", "HDV"]))[0])
            raise RecordingError(
                f"{path}, column kind, row {row + 2}: {frame['kind'].iloc[row]!r} is neither CAV nor HDV"
            )
        cav = (kinds == "CAV").to_numpy(dtype=np.bool_)
    time, x, y = (_numbers(path, frame, column) for column in ("time", "x", "y"))
    motion = given("heading"), given("speed"), given("acceleration")
    return recording(path, Rows(time, _ids(path, frame, "id"), x, y, *motion, cav, given("length"), given("width")))


def _interaction(path: Path, frame: "DataFrame") -> Recording:
    frame, notes = _motor_vehicles(frame, frame["agent_type"].fillna(""))
    time, x, y, vx, vy, heading, length, width = (_numbers(path, frame, c) for c in INTERACTION[2:3] + INTERACTION[4:])
    time, ids = time / 1000, _ids(path, frame, "track_id")
    if "case_id" in frame.columns:
        case = _numbers(path, frame, "case_id")
        time, ids = time + _APART * case, np.array([f"{c:g}/{i}" for c, i in zip(case, ids, strict=True)], dtype=object)
    speed = np.hypot(vx, vy)
    return recording(path, Rows(time, ids, x, y, heading, speed, None, None, length, width), notes, 0.1)


def _ind(path: Path, frame: "DataFrame") -> Recording:
    notes: tuple[str, ...] = ()
    rate = FRAME_RATE
    if (meta := _beside(path, "recordingMeta")) is None:
        notes += (
            f"no file {path.name.replace('tracks', 'recordingMeta')} beside it: {FRAME_RATE:g} frames a second taken",
        )
    else:
        found = _frame(meta)
        if "frameRate" not in found.columns or not len(found):
            raise RecordingError(f"{meta}: column frameRate is missing; give the file that belongs to the tracks")
        rate = float(_numbers(meta, found, "frameRate")[0])
        if not rate > 0:
            raise RecordingError(f"{meta}, column frameRate: {rate:g} is no frame rate")
    if (meta := _beside(path, "tracksMeta")) is not None:
        classes = _frame(meta)
        for column in ("trackId", "class"):
            if column not in classes.columns:
                raise RecordingError(f"{meta}: column {column} is missing; give the file that belongs to the tracks")
        known = dict(zip(classes["trackId"], classes["class"], strict=True))
        frame, left_out = _motor_vehicles(frame, frame["trackId"].map(known).fillna(""))
        notes += left_out
    else:
        size = _numbers(path, frame, "length")
        frame, count = frame[size > 0], int(frame["trackId"][size <= 0].nunique())
        notes += (f"{count} pedestrians and cyclists, who have no length, are left out",) if count else ()
    columns = (_numbers(path, frame, column) for column in IND[1:])
    number, x, y, heading, width, length, vx, vy = columns
    rows = Rows(number / rate, _ids(path, frame, "trackId"), x, y, np.radians(heading), np.hypot(vx, vy))
    return recording(path, rows._replace(length=length, width=width), notes, 1 / rate)


def _motor_vehicles(frame: "DataFrame", kinds: "Series[Any]") -> tuple["DataFrame", tuple[str, ...]]:
    """Leave out all others, and say which kinds these are."""
    own = kinds.isin(_MOTOR)
    others = sorted({str(kind) or "unknown" for kind in kinds[~own]})
    notes = (f"left out, as no motor vehicle: {', '.join(others)}",) if others else ()
    return frame[own], notes


def _beside(path: Path, what: str) -> Path | None:
    """The file of the same recording that says more of it."""
    other = path.with_name(path.name.replace("tracks", what))
    return other if other != path and other.is_file() else None


def _frame(path: Path) -> "DataFrame":
    import pandas as pd

    try:
        frame = pd.read_csv(path, dtype=str, keep_default_na=False, na_values=[""], encoding="utf-8-sig")
    except OSError as error:
        raise RecordingError(f"cannot read {path}: {error.strerror or error}; give a file that can be read") from error
    except (ValueError, pd.errors.ParserError) as error:
        # Not UTF-8, no table, nothing at all.
        raise RecordingError(f"{path} is no CSV that can be read ({' '.join(str(error).split())})") from error
    frame = frame.rename(columns=lambda name: str(name).strip())
    if len(twice := frame.columns[frame.columns.duplicated()]):
        raise RecordingError(f"{path} has two columns {twice[0]}; keep one of them")
    return frame


def _numbers(path: Path, frame: "DataFrame", column: str) -> Numbers:
    import pandas as pd

    values = pd.to_numeric(frame[column], errors="coerce").to_numpy(dtype=np.float64)
    wrong = np.flatnonzero(~np.isfinite(values))
    if len(wrong):
        row = int(wrong[0])
        text = frame[column].iloc[row]
        said = repr(text)[:40] if isinstance(text, str) else "an empty cell"
        raise RecordingError(f"{path}, column {column}, row {frame.index[row] + 2}: {said} is no number")
    return np.asarray(values)


def _ids(path: Path, frame: "DataFrame", column: str) -> np.ndarray[tuple[int], np.dtype[np.object_]]:
    if frame[column].isna().any():
        row = int(np.flatnonzero(frame[column].isna())[0])
        line = frame.index[row] + 2
        raise RecordingError(f"{path}, column {column}, row {line}: the cell is empty; each row needs its vehicle")
    return frame[column].to_numpy(dtype=object)
