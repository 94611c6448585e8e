"""Answers of a language model in one SQLite file: none is paid for twice, a run is repeated without the model."""

import hashlib
import json
import os
import sqlite3
import threading
import weakref
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from codriving.errors import ModelError
from codriving.llm.sqlite_file import connect_sqlite, create_sqlite


class AnswerCache:
    """Replies by question; any number of threads and processes may share the file, and may be killed at any time."""

    def __init__(self, path: Path | str, mode: str) -> None:
        # A connection must not cross a fork, and must not even be closed there; hence it is kept by process.
        self._connections: dict[int, sqlite3.Connection] = {}
        self._lock = threading.Lock()
        self.path, self.mode = Path(path), mode
        # At the end of the program at the latest, so that the file is complete by itself.
        weakref.finalize(self, _close, self._connections)

    def find(self, request: Mapping[str, Any]) -> dict[str, Any] | None:
        """Look a reply up."""
        fact = f"there is no answer cache {self.path}"
        if self.path.exists():
            key = key_of(request)
            found: dict[str, Any] | None = self._do(lambda connection: _reply_of(connection, key))
            if found is not None:
                return found
            fact = f"the answer cache {self.path} does not hold what is asked now"
        if self.mode == "replay":
            raise ModelError(
                f"llm.cache=replay: {fact} (model {request.get('model', 'unknown')}); set llm.cache=use to ask the "
                "model and fill it, or llm.cache_file to the file of the run that is to be repeated"
            )
        return None

    def keep(self, request: Mapping[str, Any], reply: Mapping[str, Any]) -> dict[str, Any]:
        """Keep a reply, unless another process has kept one to the same request meanwhile."""
        if self.mode == "replay":
            return dict(reply)
        key, text = key_of(request), json.dumps(reply, allow_nan=False)

        def write(connection: sqlite3.Connection) -> dict[str, Any]:
            connection.execute("INSERT OR IGNORE INTO answers (key, reply) VALUES (?, ?)", (key, text))
            return _reply_of(connection, key) or dict(json.loads(text))

        return dict(self._do(write))

    def close(self) -> None:
        """Close the file; if no other process has it open, it is complete by itself then. It may be used again."""
        with self._lock:
            _close(self._connections)

    def _do(self, action: Any) -> Any:  # noqa: ANN401 - whatever the action gives
        """Do something with the file, one thread at a time."""
        try:
            with self._lock:
                return action(self._connection())
        except (sqlite3.Error, OSError, ValueError, RecursionError) as error:
            raise ModelError(
                f"the answer cache {self.path} cannot be used ({error}); move it away, set llm.cache_file to another "
                "file, or set llm.cache=off"
            ) from error

    def _connection(self) -> sqlite3.Connection:
        connection = self._connections.get(os.getpid())
        if connection is None:
            connection = open_to_read(self.path) if self.mode == "replay" else open_to_write(self.path)
            self._connections[os.getpid()] = connection
        return connection


def key_of(request: Mapping[str, Any]) -> str:
    """Give what a request is found by: the SHA-256 of its canonical JSON."""
    text = json.dumps(request, sort_keys=True, separators=(",", ":"), ensure_ascii=True, allow_nan=False)
    return hashlib.sha256(text.encode("ascii")).hexdigest()


def _close(connections: dict[int, sqlite3.Connection]) -> None:
    """Close the connection of this process."""
    if os.getpid() in connections:
        connections.pop(os.getpid()).close()


def _reply_of(connection: sqlite3.Connection, key: str) -> dict[str, Any] | None:
    row = connection.execute("SELECT reply FROM answers WHERE key = ?", (key,)).fetchone()
    if row is None:
        return None
    reply = json.loads(str(row[0]))
    if not isinstance(reply, dict):
        raise ValueError("a reply is no object")
    return reply


LAYOUT = 1  # Changes when an older version could not read the file any more

_LOG_PAGES = 64  # Pages of the log beside the file at which it is worked in: a copy of the file alone then lacks little


def open_to_write(path: Path) -> sqlite3.Connection:
    """Open the file; it and its folder are made where they are missing."""
    if not path.exists():
        create_sqlite(path, _fill)
    return _open(path.resolve().as_uri(), "PRAGMA synchronous = NORMAL", f"PRAGMA wal_autocheckpoint = {_LOG_PAGES}")


def open_to_read(path: Path) -> sqlite3.Connection:
    """Open the file without ever changing it; it may lie where not even the lock beside it can be written."""
    try:
        return _open(f"{path.resolve().as_uri()}?mode=ro")
    except sqlite3.OperationalError:
        return _open(f"{path.resolve().as_uri()}?mode=ro&immutable=1")


def _open(uri: str, *settings: str) -> sqlite3.Connection:
    connection = connect_sqlite(uri)
    try:
        for setting in settings:
            connection.execute(setting)
        connection.execute("SELECT key FROM answers LIMIT 1").fetchone()
        if connection.execute("PRAGMA user_version").fetchone() != (LAYOUT,):
            raise ValueError("another version wrote it")
    except BaseException:
        connection.close()
        raise
    return connection


def _fill(connection: sqlite3.Connection) -> None:
    connection.execute("PRAGMA journal_mode = WAL")
    connection.execute("CREATE TABLE answers (key TEXT PRIMARY KEY, reply TEXT NOT NULL)")
    connection.execute(f"PRAGMA user_version = {LAYOUT}")
