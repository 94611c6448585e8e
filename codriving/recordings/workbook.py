"""The .xlsx recordings of the paper's authors: one sheet a vehicle, one row each 0.2 s."""

import zipfile
import zlib
from collections import Counter
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from codriving.errors import RecordingError
from codriving.recordings.recording import Numbers, Recording, Rows, recording, shown

ROW = 0.2  # Time between two rows [s]

# The header of the last column misleads: what is marked is a CAV.
NUMBERS, CAV = ("t", "x", "y", "v", "theta"), "background_veh?"

_LARGEST = 1 << 30  # Bytes that a file may unpack to

# What a spoilt file makes zip and XML parser raise (SyntaxError), a part with a password (RuntimeError), and openpyxl.
_SPOILT = (
    *(zipfile.BadZipFile, zlib.error, SyntaxError, RuntimeError),
    *(KeyError, ValueError, TypeError, AttributeError),
)


class _Sheet(NamedTuple):
    name: str
    numbers: Numbers  # Those of ``NUMBERS`` (n, 5)
    cav: np.ndarray[tuple[int], np.dtype[np.bool_]]  # (n,)
    fresh: int  # How many rows from the top are of one drive


def read_workbook(path: Path) -> Recording:
    """Read a recording; rows and sheets of earlier recordings in the same file are left out, and named.

    Raises:
        RecordingError: If it is no such file, with sheet and column.
    """
    named, appended = list[_Sheet](), list[str]()
    for name, rows in _sheets(path):
        # A file that holds a sheet 0 already calls the next one 01.
        if appended or (name.isdecimal() and name != str(int(name)) and name[:-1] in [sheet.name for sheet in named]):
            appended.append(name)
        elif rows:
            named.append(_sheet(path, name, rows))
    if not named:
        raise RecordingError(f"{path} has no sheet with the columns {', '.join((*NUMBERS, CAV))}; give a recording")
    (usual, _), *_ = sorted(Counter(sheet.fresh for sheet in named).items(), key=lambda pair: (-pair[1], -pair[0]))
    # One that was written over, but not as far as the others, was not by the recording that the others are of.
    other = [sheet for sheet in named if sheet.fresh != usual and sheet.fresh < len(sheet.numbers)]
    kept = [sheet for sheet in named if sheet not in other]
    notes = _notes(kept, other, appended, usual)
    lengths = [sheet.fresh for sheet in kept]
    t, x, y, v, theta = np.concatenate([sheet.numbers[: sheet.fresh] for sheet in kept]).T
    start = t.min()
    ids = np.repeat(np.array([sheet.name for sheet in kept], dtype=object), lengths)
    cav = np.concatenate([sheet.cav[: sheet.fresh] for sheet in kept])
    return recording(path, Rows((t - start) * ROW, ids, x, y, theta, v, cav=cav), notes, ROW)


def _sheets(path: Path) -> list[tuple[str, list[tuple[Any, ...]]]]:
    from openpyxl import load_workbook
    from openpyxl.utils.exceptions import InvalidFileException

    try:
        with path.open("rb") as file:
            with zipfile.ZipFile(file) as packed:
                if sum(item.file_size for item in packed.infolist()) > _LARGEST:
                    raise RecordingError(f"{path} unpacks to more than 1 GB; that is no recording")
            book = load_workbook(file, read_only=True, data_only=True)
            return [(sheet.title, list(sheet.iter_rows(values_only=True))) for sheet in book.worksheets]
    except OSError as error:
        raise RecordingError(f"cannot read {path}: {error.strerror or error}; give a file that can be read") from error
    except (InvalidFileException, *_SPOILT) as error:
        why = " ".join(str(error.__cause__ or error).split())
        raise RecordingError(f"{path} is no .xlsx file that can be read ({why}); save it anew") from error


def _sheet(path: Path, name: str, rows: list[tuple[Any, ...]]) -> _Sheet:
    where = f"{path}, sheet {name}"
    head = [str(cell).strip() if cell is not None else "" for cell in rows[0]]
    for column in (*NUMBERS, CAV):
        if column not in head:
            raise RecordingError(
                f"{where}: column {column} is missing; columns: {', '.join(filter(None, head)) or 'none'}"
            )
    body = [row for row in rows[1:] if any(cell is not None for cell in row)]
    if not body:
        return _Sheet(name, np.empty((0, 5)), np.empty(0, dtype=np.bool_), 0)
    columns = []
    for column in NUMBERS:
        place = head.index(column)
        for line, row in enumerate(body, start=2):
            value = row[place] if place < len(row) else None
            if isinstance(value, bool) or not isinstance(value, int | float) or not np.isfinite(value):
                raise RecordingError(f"{where}, column {column}, row {line}: {_said(value)} is no number")
        columns.append([float(row[place]) for row in body])
    place = head.index(CAV)
    marks = [row[place] if place < len(row) else None for row in body]
    for line, mark in enumerate(marks, start=2):
        if mark not in (True, False):
            raise RecordingError(f"{where}, column {CAV}, row {line}: {_said(mark)} is neither TRUE nor FALSE")
    numbers, cav = np.array(columns).T, np.array(marks, dtype=np.bool_)
    return _Sheet(name, numbers, cav, _fresh(numbers, cav))


def _said(value: object) -> str:
    return "an empty cell" if value is None else repr(value)[:40]


def _fresh(numbers: Numbers, cav: np.ndarray[tuple[int], np.dtype[np.bool_]]) -> int:
    """Return how many rows are of the newest recording, which stands at the top.

    Below it is what an earlier, longer one left: its row numbers do not go on, or the vehicle jumps, or is another.
    """
    t, x, y, v, _ = numbers.T
    most = 1.0 + 1.5 * ROW * np.maximum(v[1:], v[:-1])
    breaks = (np.diff(t) != 1) | (np.hypot(np.diff(x), np.diff(y)) > most) | (cav[1:] != cav[:-1])
    found = np.flatnonzero(breaks)
    return int(found[0]) + 1 if len(found) else len(t)


def _notes(kept: list[_Sheet], other: list[_Sheet], appended: list[str], usual: int) -> tuple[str, ...]:
    notes = []
    stale: dict[tuple[int, int], list[str]] = {}
    for sheet in kept:
        if sheet.fresh < len(sheet.numbers):
            stale.setdefault((sheet.fresh + 2, len(sheet.numbers) + 1), []).append(sheet.name)
    for (first, last), names in stale.items():
        notes.append(
            f"stale rows {first} to {last} of sheet {shown(names)}, left by an earlier recording, are left out"
        )
    for sheet in other:
        rows = f"{sheet.fresh} rows where the others have {usual}"
        notes.append(f"sheet {sheet.name} is of another recording ({rows}) and left out")
    if appended:
        notes.append(f"appended sheet {shown(appended)} is of another recording and left out")
    if short := [sheet.name for sheet in kept if sheet.fresh != usual]:
        notes.append(f"sheet {shown(short)} has other than {usual} rows")
    return tuple(notes)
