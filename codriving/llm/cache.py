"""Answers of a language model in one SQLite file: none is paid for twice, a run is repeated without the model."""

import hashlib
import json
import os
import sqlite3
import threading
import uuid
import weakref
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from codriving.errors import ModelError


class AnswerCache:
    """Replies by what was asked; any number of threads and processes may share the file, and may be killed at any time.

    Args:
        mode: ``use`` (answers from it where it has one, and into it where not) or ``replay`` (answers from it alone).
    """

    def __init__(self, path: Path | str, mode: str) -> None:
        # A connection must not cross a fork, and must not even be closed there; hence it is kept by process.
        self._connections: dict[int, sqlite3.Connection] = {}
        self._lock = threading.Lock()
        self.path, self.mode = Path(path), mode
        # At the end of the program at the latest, so that the file is complete by itself.
        weakref.finalize(self, _close, self._connections)

    def find(self, request: Mapping[str, Any]) -> dict[str, Any] | None:
        """Look a reply up.

        Returns:
            The reply; None if there is none and the model may be asked.

        Raises:
            ModelError: If there is none in replay, or the file cannot be used.
        """
        if not self.path.exists():
            self._absent(request, f"there is no answer cache {self.path}")
            return None
        key = key_of(request)
        text = self._do(lambda connection: _text_of(connection, key))
        if text is None:
            self._absent(request, f"the answer cache {self.path} does not hold what is asked now")
            return None
        try:
            reply = json.loads(text)
        except ValueError as error:
            raise self._unusable(str(error)) from error
        if not isinstance(reply, dict):
            raise self._unusable("a reply is no object")
        return reply

    def keep(self, request: Mapping[str, Any], reply: Mapping[str, Any]) -> dict[str, Any]:
        """Keep a reply, unless somebody else has kept one to the same request meanwhile.

        Args:
            request: What was asked, as for ``find``.

        Raises:
            ModelError: If the file cannot be used.
        """
        if self.mode == "replay":
            return dict(reply)
        key, text = key_of(request), json.dumps(reply, allow_nan=False)

        def write(connection: sqlite3.Connection) -> str | None:
            connection.execute("INSERT OR IGNORE INTO answers (key, reply) VALUES (?, ?)", (key, text))
            return _text_of(connection, key)

        return dict(json.loads(self._do(write) or text))

    def close(self) -> None:
        """Close the file; if no other process has it open, it is complete by itself then. It may be used again."""
        with self._lock:
            _close(self._connections)

    def _absent(self, request: Mapping[str, Any], fact: str) -> None:
        """Nothing is found: no matter, unless there is nobody else to ask."""
        if self.mode == "replay":
            raise ModelError(
                f"llm.cache=replay: {fact} (model {request.get('model', 'unknown')}); set llm.cache=use to ask the "
                "model and fill it, or llm.cache_file to the file of the run that is to be repeated"
            )

    def _do(self, action: Any) -> Any:  # noqa: ANN401 - whatever the action gives
        """Do something with the file, one thread at a time."""
        try:
            with self._lock:
                return action(self._connection())
        except (sqlite3.Error, OSError, ValueError) as error:
            raise self._unusable(str(error)) from error

    def _connection(self) -> sqlite3.Connection:
        connection = self._connections.get(os.getpid())
        if connection is None:
            connection = open_to_read(self.path) if self.mode == "replay" else open_to_write(self.path)
            self._connections[os.getpid()] = connection
        return connection

    def _unusable(self, reason: str) -> ModelError:
        return ModelError(
            f"the answer cache {self.path} cannot be used ({reason}); move it away, set llm.cache_file to another "
            "file, or set llm.cache=off"
        )


def key_of(request: Mapping[str, Any]) -> str:
    """Give what a request is found by: the SHA-256 of its canonical JSON.

    Returns:
        64 hexadecimal digits; the same whatever the order of the keys.
    """
    text = json.dumps(request, sort_keys=True, separators=(",", ":"), ensure_ascii=True, allow_nan=False)
    return hashlib.sha256(text.encode("ascii")).hexdigest()


def _close(connections: dict[int, sqlite3.Connection]) -> None:
    """Close the connection of this process."""
    connection = connections.pop(os.getpid(), None)
    if connection is not None:
        connection.close()


def _text_of(connection: sqlite3.Connection, key: str) -> str | None:
    row = connection.execute("SELECT reply FROM answers WHERE key = ?", (key,)).fetchone()
    return None if row is None else str(row[0])


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
