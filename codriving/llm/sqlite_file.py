"""SQLite files that several processes share: made whole or not at all, and no transaction left open."""

import os
import sqlite3
import uuid
from collections.abc import Callable
from contextlib import closing, suppress
from pathlib import Path

BUSY = 60.0  # How long to wait for another process that is writing [s]


def connect_sqlite(uri: str) -> sqlite3.Connection:
    """Open a connection in which nothing begins a transaction by itself, so that a killed process leaves none open."""
    return sqlite3.connect(uri, uri=True, timeout=BUSY, isolation_level=None, check_same_thread=False)


def create_sqlite(path: Path, fill: Callable[[sqlite3.Connection], object]) -> None:
    """Make a file; if several processes do, the first wins, and half of it is never seen.

    Raises:
        sqlite3.Error: If it cannot be filled.
        OSError: If it cannot be made.
    """
    partial = path.parent / f".partial-{path.name}-{uuid.uuid4().hex[:12]}"
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with closing(connect_sqlite(partial.resolve().as_uri())) as connection:
            fill(connection)
        with suppress(FileExistsError):
            os.link(partial, path)
    finally:
        with suppress(OSError):
            partial.unlink(missing_ok=True)
