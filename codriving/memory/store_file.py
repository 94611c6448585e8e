"""The SQLite file of a memory: made whole, checked on opening, an experience a row, one transaction a change."""

import json
import sqlite3
from collections.abc import Mapping
from contextlib import closing
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from codriving.datatypes import Action, Description, Effect, Experience, Verdict
from codriving.errors import MemoryFileError
from codriving.llm import connect_sqlite, create_sqlite
from codriving.memory.embedders import Embedder, Vectors

LAYOUT = 1  # Changes when an older version could not read the file any more

APPLICATION = 0x43444D31  # What tells such a file from any other SQLite file ("CDM1")

# ``interactions`` are episodes, ``experiences`` what was kept of them, ``sightings`` where each of those was made.
_TABLES = """
CREATE TABLE about (key TEXT PRIMARY KEY, value TEXT NOT NULL);
CREATE TABLE interactions (
    id INTEGER PRIMARY KEY, scenario TEXT NOT NULL, seed INTEGER NOT NULL,
    method TEXT NOT NULL, variant TEXT NOT NULL, reasoner TEXT NOT NULL
);
CREATE TABLE experiences (
    id INTEGER PRIMARY KEY, vector BLOB NOT NULL, action TEXT NOT NULL, verdict TEXT NOT NULL,
    scene TEXT NOT NULL, conflict TEXT NOT NULL, passing TEXT NOT NULL, numbers TEXT NOT NULL, kinds TEXT NOT NULL,
    effect TEXT NOT NULL, lesson TEXT NOT NULL
);
CREATE TABLE sightings (
    experience INTEGER NOT NULL REFERENCES experiences (id), interaction INTEGER NOT NULL REFERENCES interactions (id),
    step INTEGER NOT NULL, ego TEXT NOT NULL, PRIMARY KEY (interaction, step, ego)
) WITHOUT ROWID;
CREATE INDEX sightings_of ON sightings (experience);
"""


def create(path: Path, embedder: str, dimension: int) -> None:
    """Make an empty file; if several processes do, the first wins, and half of it is never seen."""

    def fill(connection: sqlite3.Connection) -> None:
        connection.executescript(_TABLES)
        about = {"embedder": embedder, "dimension": str(dimension)}
        connection.executemany("INSERT INTO about VALUES (?, ?)", about.items())
        connection.execute(f"PRAGMA application_id = {APPLICATION}")
        connection.execute(f"PRAGMA user_version = {LAYOUT}")

    try:
        create_sqlite(path, fill)
    except (OSError, sqlite3.Error) as error:
        raise unwritable(path, error) from error


def open_file(path: Path, write: bool) -> sqlite3.Connection:
    """Open a file that is there.

    A writer that was killed may have left a journal beside it; opening it for writing puts it back as it was.
    """
    if not path.is_file():
        raise MemoryFileError(f"there is no file of memories {path}; make one with codriving memory build")
    try:
        mode = "rw" if write or path.with_name(f"{path.name}-journal").exists() else "ro"
        connection = connect_sqlite(f"{path.resolve().as_uri()}?mode={mode}")
        try:
            (kind,) = connection.execute("PRAGMA application_id").fetchone()
            (layout,) = connection.execute("PRAGMA user_version").fetchone()
            if kind != APPLICATION:
                raise MemoryFileError(f"{path} is no file of memories; name another one")
            if layout != LAYOUT:
                raise MemoryFileError(
                    f"{path} was written by another version (layout {layout}, not {LAYOUT}); build it again with this "
                    "one"
                )
            _check_columns(path, connection)
        except BaseException:
            connection.close()
            raise
    except sqlite3.Error as error:
        if _is_locked(error):
            raise _locked(path) from error
        raise MemoryFileError(
            f"{path} cannot be read as a file of memories ({error}); name another one, or make one with codriving "
            "memory build"
        ) from error
    return connection


def _check_columns(path: Path, connection: sqlite3.Connection) -> None:
    """Refuse a file whose tables are not those that are written."""
    with closing(sqlite3.connect(":memory:")) as ours:
        ours.executescript(_TABLES)
        for (table,) in ours.execute("SELECT name FROM sqlite_master WHERE type = 'table' ORDER BY name").fetchall():
            query = f"SELECT name FROM pragma_table_info('{table}')"
            wanted, found = ([name for (name,) in each.execute(query)] for each in (ours, connection))
            if wanted != found:
                columns = f"has the columns {', '.join(found)}" if found else "is missing"
                raise damaged(path, ValueError(f"the table {table} {columns}, and not {', '.join(wanted)}"))


def about(connection: sqlite3.Connection) -> dict[str, str]:
    """Read what a file says of itself: ``embedder`` and ``dimension``."""
    return {str(key): str(value) for key, value in connection.execute("SELECT key, value FROM about")}


def check_embedder(path: Path, said: Mapping[str, str], embedder: Embedder) -> int:
    """Refuse a file whose vectors are another embedder's."""
    name, dimension = said.get("embedder", "none"), said.get("dimension", "")
    if name != embedder.name:
        raise MemoryFileError(
            f"{path} was made with the embedder {name}, and {embedder.name} is asked for; set memory.embedder to "
            "match, or build it again"
        )
    if not dimension.isdecimal() or (embedder.dimension is not None and int(dimension) != embedder.dimension):
        raise MemoryFileError(
            f"{path} holds vectors of {dimension or 'unknown'} numbers, and {embedder.name} makes "
            f"{embedder.dimension}; build it again"
        )
    return int(dimension)


def _is_locked(error: Exception) -> bool:
    return isinstance(error, sqlite3.Error) and "locked" in str(error)


def _locked(path: Path) -> MemoryFileError:
    return MemoryFileError(
        f"{path} is locked by another program that writes it; wait until that has ended or close it, then run again"
    )


def damaged(path: Path, error: Exception) -> MemoryFileError:
    """The error for a file whose contents cannot be used."""
    if _is_locked(error):
        return _locked(path)
    return MemoryFileError(f"{path} is damaged ({error}); build it again, or name another one")


def unwritable(path: Path, error: Exception) -> MemoryFileError:
    """The error for a file that cannot be written."""
    if _is_locked(error):
        return _locked(path)
    return MemoryFileError(
        f"cannot write the memory {path}: {error}; permit writing it and its folder, make room, or name another file"
    )


# The columns of ``experiences`` after the number, in their order.
COLUMNS = ("vector", "action", "verdict", "scene", "conflict", "passing", "numbers", "kinds", "effect", "lesson")


def to_row(experience: Experience, vector: Vectors) -> tuple[Any, ...]:
    """Write an experience as the values of ``COLUMNS``."""
    d = experience.description
    labels = (str(experience.action), str(experience.verdict), d.scene, d.conflict, d.order)
    values = (_json(d.numbers), _json(d.kinds), _json(asdict(experience.effect)))
    return (vector.astype("<f4").tobytes(), *labels, *values, experience.lesson)


def from_row(row: tuple[Any, ...], step: int = 0, ego: str = "") -> Experience:
    """Read an experience from the values of ``COLUMNS``."""
    _, action, verdict, scene, conflict, passing, numbers, kinds, effect, lesson = row
    try:
        description = Description(scene, conflict, passing, json.loads(numbers), json.loads(kinds))
        return Experience(
            description, Action(action), Verdict(verdict), Effect(**json.loads(effect)), lesson, step, ego
        )
    except (TypeError, KeyError, RecursionError) as error:
        raise ValueError(str(error)) from error


def vectors_of(blobs: list[bytes], dimension: int) -> Vectors:
    """Join vectors as they are stored into one array."""
    if any(len(blob) != 4 * dimension for blob in blobs):
        raise ValueError(f"a vector does not have {dimension} numbers")
    vectors = np.frombuffer(b"".join(blobs), dtype="<f4").reshape(len(blobs), dimension).astype(np.float32)
    if not np.isfinite(vectors).all():
        raise ValueError("a vector holds a number that is not finite")
    # A text without a known word gives zeros.
    lengths = np.einsum("ij,ij->i", vectors, vectors)
    if not ((np.abs(lengths - 1) < 1e-3) | (lengths == 0)).all():
        raise ValueError("a vector does not have the length 1")
    return vectors


def _json(values: Mapping[str, Any]) -> str:
    return json.dumps(dict(values), sort_keys=True, separators=(",", ":"), allow_nan=False, ensure_ascii=False)
