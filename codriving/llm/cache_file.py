"""The SQLite file of the answer cache: made by one process, opened by many, readable where nothing can be written."""

import os
import sqlite3
import uuid
from contextlib import suppress
from pathlib import Path

LAYOUT = 1
"""Changes when an older version could not read the file any more."""

BUSY = 60.0
"""How long to wait for another process that is writing [s]."""

_LOG_PAGES = 64
"""Pages of the log beside the file at which it is worked in: a copy of the file alone then lacks little."""


def open_to_write(path: Path) -> sqlite3.Connection:
    """Open the file; it and its folder are made where they are missing.

    Raises:
        sqlite3.Error: If it is no such file.
        OSError: If it cannot be made.
        ValueError: If another version wrote it.
    """
    if not path.exists():
        _create(path)
    connection = _connect(path.resolve().as_uri())
    try:
        connection.execute("PRAGMA synchronous = NORMAL")
        connection.execute(f"PRAGMA wal_autocheckpoint = {_LOG_PAGES}")
        return _checked(connection)
    except BaseException:
        connection.close()
        raise


def open_to_read(path: Path) -> sqlite3.Connection:
    """Open the file without ever changing it; it may lie where not even the lock beside it can be written.

    Raises:
        sqlite3.Error: If it is no such file.
        ValueError: If another version wrote it.
    """
    try:
        return _open(f"{path.resolve().as_uri()}?mode=ro")
    except sqlite3.OperationalError:
        return _open(f"{path.resolve().as_uri()}?mode=ro&immutable=1")


def _open(uri: str) -> sqlite3.Connection:
    connection = _connect(uri)
    try:
        return _checked(connection)
    except BaseException:
        connection.close()
        raise


def _checked(connection: sqlite3.Connection) -> sqlite3.Connection:
    connection.execute("SELECT key FROM answers LIMIT 1").fetchone()
    if connection.execute("PRAGMA user_version").fetchone() != (LAYOUT,):
        raise ValueError("another version wrote it")
    return connection


def _create(path: Path) -> None:
    """Make an empty file; if several processes do, the first wins and nobody ever sees half of it."""
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.parent / f".partial-{path.name}-{uuid.uuid4().hex[:12]}"
    try:
        connection = _connect(partial.resolve().as_uri())
        try:
            connection.execute("PRAGMA journal_mode = WAL")
            connection.execute("CREATE TABLE answers (key TEXT PRIMARY KEY, reply TEXT NOT NULL)")
            connection.execute(f"PRAGMA user_version = {LAYOUT}")
        finally:
            connection.close()
        with suppress(FileExistsError):
            os.link(partial, path)
    finally:
        partial.unlink(missing_ok=True)


def _connect(uri: str) -> sqlite3.Connection:
    # Every statement is a transaction of its own, so that a killed process leaves none open.
    return sqlite3.connect(uri, uri=True, timeout=BUSY, isolation_level=None, check_same_thread=False)
